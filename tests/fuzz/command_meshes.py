"""Good meshes of every format that the command reads: a ball of 80 triangles in the volumes' ball."""
import base64
import struct
import zlib

CENTRE = (0.5, 0, 13.75)
RADIUS = 3


def sphere():
    g = (1 + 5 ** 0.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g),
              (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    coarse = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4),
              (11, 10, 2), (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8),
              (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    between = {}

    def middle(i, j):
        key = (min(i, j), max(i, j))
        if key not in between:
            between[key] = len(points)
            points.append(tuple((p + q) / 2 for p, q in zip(points[i], points[j])))
        return between[key]
    faces = []
    for a, b, c in coarse:
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        faces += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    placed = []
    for p in points:
        length = sum(x * x for x in p) ** 0.5
        placed.append(tuple(round(c + RADIUS * x / length, 4) for c, x in zip(CENTRE, p)))
    return placed, faces


POINTS, FACES = sphere()


def words(values):
    return ' '.join(map(str, values))


def stl_text():
    out = 'solid ball\n'
    for face in FACES:
        out += 'facet normal 0 0 1\nouter loop\n'
        out += ''.join(f'vertex {words(POINTS[v])}\n' for v in face) + 'endloop\nendfacet\n'
    return (out + 'endsolid ball\n').encode()


def stl_binary():
    out = b'ball'.ljust(80) + struct.pack('<I', len(FACES))
    for face in FACES:
        out += struct.pack('<12fH', 0, 0, 1, *(x for v in face for x in POINTS[v]), 0)
    return out


def ply(order=None):
    kind = {None: 'ascii', '<': 'binary_little_endian', '>': 'binary_big_endian'}[order]
    head = (f'ply\nformat {kind} 1.0\ncomment ball\nelement vertex {len(POINTS)}\n'
            'property float x\nproperty float y\nproperty float z\n'
            f'element face {len(FACES)}\nproperty list uchar int vertex_indices\nend_header\n')
    if order is None:
        body = [words(p) for p in POINTS] + ['3 ' + words(f) for f in FACES]
        return (head + '\n'.join(body) + '\n').encode()
    return head.encode() + b''.join(struct.pack(f'{order}3f', *p) for p in POINTS) + \
        b''.join(struct.pack(f'{order}B3i', 3, *f) for f in FACES)


def obj():
    lines = [f'v {words(p)}' for p in POINTS]
    lines += ['f ' + words(v + 1 for v in f) for f in FACES]
    return ('\n'.join(lines) + '\n').encode()


def off():
    lines = ['OFF', f'{len(POINTS)} {len(FACES)} 0'] + [words(p) for p in POINTS]
    return ('\n'.join(lines + ['3 ' + words(f) for f in FACES]) + '\n').encode()


def arrays():
    return [('Points', 'Float32', 3, 'f', [x for p in POINTS for x in p]),
            ('connectivity', 'Int64', 1, 'q', [v for f in FACES for v in f]),
            ('offsets', 'Int64', 1, 'q', [3 * (i + 1) for i in range(len(FACES))])]


def block(code, values, packed):
    data = struct.pack(f'<{len(values)}{code}', *values)
    if not packed:
        return struct.pack('<Q', len(data)), data
    size = 256
    parts = [zlib.compress(data[i:i + size]) for i in range(0, len(data), size)]
    head = struct.pack('<3Q', len(parts), size, len(data) % size)
    return head + struct.pack(f'<{len(parts)}Q', *map(len, parts)), b''.join(parts)


def vtp(form, packed=False, coded=False):
    """form: ascii, binary or appended; coded: appended data in base64."""
    appended = b''
    tags = {}
    for name, kind, components, code, values in arrays():
        text, offset = '', ''
        if form == 'ascii':
            text = words(values)
        else:
            parts = block(code, values, packed)
            if form == 'binary' or coded:
                parts = [base64.b64encode(part) for part in parts]
            if form == 'binary':
                text = b''.join(parts).decode()
            else:
                offset = f' offset="{len(appended)}"'
                appended += b''.join(parts)
        tags[name] = (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" '
                      f'format="{form}"{offset}>{text}</DataArray>\n')
    compressor = ' compressor="vtkZLibDataCompressor"' if packed else ''
    out = ('<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" '
           f'byte_order="LittleEndian" header_type="UInt64"{compressor}>\n<PolyData>\n'
           f'<Piece NumberOfPoints="{len(POINTS)}" NumberOfPolys="{len(FACES)}">\n'
           f'<Points>{tags["Points"]}</Points>\n'
           f'<Polys>{tags["connectivity"]}{tags["offsets"]}</Polys>\n</Piece>\n</PolyData>\n').encode()
    if form == 'appended':
        out += f'<AppendedData encoding="{"base64" if coded else "raw"}">\n_'.encode()
        out += appended + b'\n</AppendedData>\n'
    return out + b'</VTKFile>\n'


def vtk(binary, new=False):
    kind = 'BINARY' if binary else 'ASCII'

    def block(code, values):
        if binary:
            return struct.pack(f'>{len(values)}{code}', *values) + b'\n'
        return (words(values) + '\n').encode()
    out = (f'# vtk DataFile Version {"5.1" if new else "3.0"}\nball SPACE=LPS\n{kind}\n'
           f'DATASET POLYDATA\nPOINTS {len(POINTS)} float\n').encode()
    out += block('f', [x for p in POINTS for x in p])
    if new:
        out += (f'METADATA\nINFORMATION 0\n\nPOLYGONS {len(FACES) + 1} {3 * len(FACES)}\n'
                'OFFSETS vtktypeint64\n').encode()
        out += block('q', [3 * i for i in range(len(FACES) + 1)]) + b'CONNECTIVITY vtktypeint64\n'
        out += block('q', [v for f in FACES for v in f])
    else:
        out += f'POLYGONS {len(FACES)} {4 * len(FACES)}\n'.encode()
        out += block('i', [v for f in FACES for v in (3, *f)])
    out += f'POINT_DATA {len(POINTS)}\nSCALARS Height float 1\nLOOKUP_TABLE default\n'.encode()
    return out + block('f', [p[2] for p in POINTS])


def gifti(encoding):
    arrays = [('POINTSET', 'FLOAT32', 'f', [x * s for p in POINTS for x, s in zip(p, (-1, -1, 1))]),
              ('TRIANGLE', 'INT32', 'i', [v for f in FACES for v in f])]
    out = '<?xml version="1.0" encoding="UTF-8"?>\n<GIFTI Version="1.0" NumberOfDataArrays="2">\n'
    for intent, kind, code, values in arrays:
        data = struct.pack(f'<{len(values)}{code}', *values)
        text = {'ASCII': lambda: words(values),
                'Base64Binary': lambda: base64.b64encode(data).decode(),
                'GZipBase64Binary': lambda: base64.b64encode(zlib.compress(data)).decode()}[encoding]()
        out += (f'<DataArray Intent="NIFTI_INTENT_{intent}" DataType="NIFTI_TYPE_{kind}" '
                f'ArrayIndexingOrder="RowMajorOrder" Dimensionality="2" Dim0="{len(values) // 3}" '
                f'Dim1="3" Encoding="{encoding}" Endian="LittleEndian">\n<Data>{text}</Data>\n'
                '</DataArray>\n')
    return (out + '</GIFTI>\n').encode()


def meshes():
    """Name of a case, its files and the path that the command is given."""
    one = {'text.stl': stl_text(), 'a.stl': stl_binary(), 'text.ply': ply(), 'a.ply': ply('<'),
           'big.ply': ply('>'), 'a.obj': obj(), 'a.off': off(), 'text.vtp': vtp('ascii'),
           'binary.vtp': vtp('binary'), 'packed.vtp': vtp('binary', True),
           'a.vtp': vtp('appended'), 'coded.vtp': vtp('appended', False, True),
           'zip.vtp': vtp('appended', True), 'text.vtk': vtk(False), 'a.vtk': vtk(True),
           'new.vtk': vtk(True, True), 'text.gii': gifti('ASCII'),
           'binary.gii': gifti('Base64Binary'), 'a.gii': gifti('GZipBase64Binary')}
    return [(name, {name: data}, name) for name, data in one.items()]
