"""Damage to a file: some of its bytes, blocks, numbers and offsets are others."""
import re
import struct

NUMBERS = ['0', '1', '-1', '2', '3', '127', '255', '256', '32768', '65535', '65536', '1000003',
           '2147483647', '2147483648', '4294967295', '4294967296', '9223372036854775807',
           '9223372036854775808', '-9223372036854775808', '18446744073709551616',
           '1' + '0' * 40, '9' * 400, '1e300', '-1e300', '1e-300', 'nan', 'inf', '-inf', '0x10', '',
           '1.5', '1e5', '%n', '%s', '-0']
VALUES = [0, 1, 2, 3, 127, 128, 255, 256, 32767, 32768, 65535, 65536, 2**31 - 1, 2**31, 2**32 - 1,
          2**32, 2**38, 2**61, 2**62, 2**63 - 1, 2**63, 2**64 - 2, 2**64 - 1]
FLOATS = [float('nan'), float('inf'), -float('inf'), 0.0, -1.0, 1e30, -1e30, 1e300, -1e300, 1e-40,
          1e-310]


def place(random, data):
    """Anywhere, but headers more often."""
    end = len(data) if random.random() < 0.5 else min(len(data), 600)
    return random.randrange(max(1, end))


def span(random, data):
    begin = place(random, data)
    return begin, min(len(data), begin + random.choice([1, 2, 4, 8, 16, 60, 200, 1000]))


def put(data, at, value):
    return data[:at] + value + data[at + len(value):]


def bits(random, data):
    at = place(random, data)
    return put(data, at, bytes([data[at] ^ (1 << random.randrange(8))]))


def noise(random, data):
    begin, end = span(random, data)
    return put(data, begin, random.randbytes(end - begin))


def zeros(random, data):
    begin, end = span(random, data)
    return put(data, begin, random.choice([b'\0', b'\xff', b' ', b'\n']) * (end - begin))


def cut(random, data):
    return data[:random.randrange(len(data) + 1)]


def longer(random, data):
    return data + random.choice([b'\0' * random.randrange(5000), random.randbytes(300), data])


def delete(random, data):
    begin, end = span(random, data)
    return data[:begin] + data[end:]


def double(random, data):
    begin, end = span(random, data)
    times = random.choice([1, 1, 2, 50])
    return data[:end] + data[begin:end] * times + data[end:]


def swap(random, data):
    (a, b), (c, d) = sorted((span(random, data), span(random, data)))
    if b > c:
        return data
    return data[:a] + data[c:d] + data[b:c] + data[a:b] + data[d:]


def integer(random, data):
    size = random.choice([1, 2, 4, 8])
    order = random.choice(['little', 'big'])
    at = place(random, data) // 2 * 2
    value = random.choice(VALUES) & (256**size - 1)
    return put(data, at, value.to_bytes(size, order))[:max(len(data), 1)]


def real(random, data):
    kind = random.choice(['<f', '<d', '>f'])
    value = random.choice(FLOATS)
    if kind[1] == 'f' and abs(value) > 1e38:
        value = float('inf') if value > 0 else -float('inf')
    return put(data, place(random, data) // 2 * 2, struct.pack(kind, value))


def nudge(random, data):
    """A number a little larger or smaller."""
    size = random.choice([1, 2, 4])
    at = place(random, data) // 2 * 2
    value = int.from_bytes(data[at:at + size], 'little') + random.choice([-2, -1, 1, 2, 100])
    return put(data, at, (value % 256**size).to_bytes(size, 'little'))


def pointer(random, data):
    """What may be an offset leads to itself, or to another place of the file."""
    size = random.choice([4, 8])
    at = place(random, data) // 2 * 2
    known = [i for i in range(0, len(data) - size, 2)
             if 8 <= int.from_bytes(data[i:i + size], 'little') < len(data)]
    if known:
        at = random.choice(known)
    target = random.choice([at, max(0, at - 2), max(0, at - 122), at + size,
                            random.randrange(len(data))])
    return put(data, at, target.to_bytes(size, random.choice(['little', 'little', 'big'])))


def number(random, data):
    """A number in text."""
    found = list(re.finditer(rb'-?\d+(\.\d+)?(e-?\d+)?', data[:3000]))
    if not found:
        return integer(random, data)
    match = random.choice(found)
    return data[:match.start()] + random.choice(NUMBERS).encode() + data[match.end():]


def line(random, data):
    """Lines of a header are swapped, doubled, or left out."""
    lines = data[:3000].split(b'\n')
    rest = data[3000:]
    i, j = random.randrange(len(lines)), random.randrange(len(lines))
    how = random.randrange(3)
    if how == 0:
        lines[i], lines[j] = lines[j], lines[i]
    elif how == 1:
        lines.insert(j, lines[i])
    else:
        del lines[i]
    return b'\n'.join(lines) + rest


DAMAGES = [bits, bits, noise, zeros, cut, longer, delete, double, swap, integer, integer, integer,
           real, nudge, nudge, pointer, pointer, number, number, number, line]


def damaged(random, data):
    for _ in range(random.choice([1, 1, 1, 2, 3])):
        if data:
            data = random.choice(DAMAGES)(random, data)
    return data
