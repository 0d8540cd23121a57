"""Good volumes of every format that the command reads: a ball of 200 in 0, of 12 x 11 x 10 voxels.

A case is a dictionary of files by their names in a folder; contents are bytes, or a Packed, whose
inside may be damaged before it is packed.
"""
import gzip
import io
import json
import struct
import tarfile
import zlib

NX, NY, NZ = 12, 11, 10
NOT_READ = {'two.nii', 'two.nii.gz', 'tiles.tif'}  # ITK refuses them, undamaged


class Packed:
    def __init__(self, inside, pack):
        self.inside, self.pack = inside, pack


def ball():
    def value(x, y, z):
        r = ((x - 5.5) ** 2 + (y - 5) ** 2 + (z - 4.5) ** 2) ** 0.5
        return 200 if r < 3.6 else 0
    return [value(x, y, z) for z in range(NZ) for y in range(NY) for x in range(NX)]


VOXELS = ball()


def raw(code, order='<', voxels=None):
    voxels = VOXELS if voxels is None else voxels
    return struct.pack(f'{order}{len(voxels)}{code}', *voxels)


def gzipped(data):
    return gzip.compress(data, 6, mtime=0)


# ---- NIfTI

NIFTI_CODES = {'h': (4, 16), 'f': (16, 32), 'B': (2, 8)}


def nifti1(code, order='<'):
    kind, bits = NIFTI_CODES[code]
    h = bytearray(352)
    struct.pack_into(f'{order}i', h, 0, 348)
    struct.pack_into(f'{order}8h', h, 40, 3, NX, NY, NZ, 1, 1, 1, 1)
    struct.pack_into(f'{order}2h', h, 70, kind, bits)
    struct.pack_into(f'{order}8f', h, 76, 1, 1, 1, 1.5, 1, 1, 1, 1)
    struct.pack_into(f'{order}f', h, 108, 352)
    struct.pack_into(f'{order}2h', h, 252, 0, 1)
    struct.pack_into(f'{order}12f', h, 280, 1, 0, 0, -5, 0, 1, 0, -5, 0, 0, 1.5, 7)
    h[344:348] = b'n+1\0'
    return bytes(h) + raw(code, order)


def nifti2(code):
    kind, bits = NIFTI_CODES[code]
    h = bytearray(544)
    struct.pack_into('<i', h, 0, 540)
    h[4:12] = b'n+2\0\r\n\x1a\n'
    struct.pack_into('<2h', h, 12, kind, bits)
    struct.pack_into('<8q', h, 16, 3, NX, NY, NZ, 1, 1, 1, 1)
    struct.pack_into('<8d', h, 104, 1, 1, 1, 1.5, 1, 1, 1, 1)
    struct.pack_into('<q', h, 168, 544)
    struct.pack_into('<2i', h, 344, 0, 1)
    struct.pack_into('<12d', h, 400, 1, 0, 0, -5, 0, 1, 0, -5, 0, 0, 1.5, 7)
    return bytes(h) + raw(code)


# ---- NRRD and MetaImage

def nrrd_header(kind, encoding, data_file=''):
    lines = ['NRRD0004', f'type: {kind}', 'dimension: 3', 'space: left-posterior-superior',
             f'sizes: {NX} {NY} {NZ}', 'space directions: (1,0,0) (0,1,0) (0,0,1.5)',
             'kinds: domain domain domain', 'endian: little', f'encoding: {encoding}',
             'space origin: (-5,-5,7)']
    if data_file:
        lines.append(f'data file: {data_file}')
    return '\n'.join(lines).encode() + (b'\n' if data_file else b'\n\n')


def as_text():
    return ' '.join(map(str, VOXELS)).encode() + b'\n'


def meta_header(kind, data_file, more=()):
    lines = ['ObjectType = Image', 'NDims = 3', 'BinaryData = True',
             'BinaryDataByteOrderMSB = False', *more, 'TransformMatrix = 1 0 0 0 1 0 0 0 1',
             'Offset = -5 -5 7', 'ElementSpacing = 1 1 1.5', f'DimSize = {NX} {NY} {NZ}',
             f'ElementType = {kind}', f'ElementDataFile = {data_file}']
    return '\n'.join(lines).encode() + b'\n'


def slices(code):
    page = NX * NY
    return [raw(code, '<', VOXELS[z * page:(z + 1) * page]) for z in range(NZ)]


# ---- TIFF

def packbits(data):
    """Literal runs of a row of bytes each: none may cross the end of one."""
    return b''.join(bytes([len(data[i:i + NX]) - 1]) + data[i:i + NX]
                    for i in range(0, len(data), NX))


def lzw(data):
    """Every byte as itself, the table cleared before codes get longer."""
    bits = ''
    for i in range(0, len(data), 200):
        bits += format(256, '09b') + ''.join(format(b, '09b') for b in data[i:i + 200])
    bits += format(257, '09b')
    bits += '0' * (-len(bits) % 8)
    return bytes(int(bits[i:i + 8], 2) for i in range(0, len(bits), 8))


PACKINGS = {1: bytes, 5: lzw, 8: zlib.compress, 32773: packbits}


def tiff(pages, bits, packing=1, order='<', wide=False, tiled=False):
    """Pages of one strip or tile each."""
    mark = b'II' if order == '<' else b'MM'
    offset = 'Q' if wide else 'I'
    out = bytearray(mark + (struct.pack(f'{order}HHHQ', 43, 8, 0, 0) if wide
                            else struct.pack(f'{order}HI', 42, 0)))
    link = 8 if wide else 4
    for page in pages:
        if tiled:
            row = NX * bits // 8
            page = b''.join(page[y * row:(y + 1) * row].ljust(16 * bits // 8, b'\0')
                            for y in range(NY)).ljust(16 * 16 * bits // 8, b'\0')
        data = PACKINGS[packing](page)
        at = len(out)
        out += data + b'\0' * (-len(data) % 2)
        tags = [(256, 4, NX), (257, 4, NY), (258, 3, bits), (259, 3, packing), (262, 3, 1)]
        place = [(273, 4, at), (277, 3, 1), (278, 4, NY), (279, 4, len(data))]
        if tiled:
            place = [(277, 3, 1), (322, 3, 16), (323, 3, 16), (324, 4, at), (325, 4, len(data))]
        tags += place + [(339, 3, 1)]
        struct.pack_into(f'{order}{offset}', out, link, len(out))
        out += struct.pack(f'{order}{"Q" if wide else "H"}', len(tags))
        for tag, kind, value in tags:
            field = struct.pack(f'{order}{"H" if kind == 3 else "I"}', value)
            out += struct.pack(f'{order}HH{offset}', tag, kind, 1)
            out += field.ljust(8 if wide else 4, b'\0')
        link = len(out)
        out += struct.pack(f'{order}{offset}', 0)
    return bytes(out)


# ---- DICOM

def element(group, item, vr, value, explicit=True):
    if isinstance(value, str):
        value = value.encode()
    if len(value) % 2:
        value += b'\0' if vr == 'UI' else b' '
    if not explicit:
        return struct.pack('<HHI', group, item, len(value)) + value
    if vr in ('OB', 'OW', 'SQ'):
        return struct.pack('<HH2sHI', group, item, vr.encode(), 0, len(value)) + value
    return struct.pack('<HH2sH', group, item, vr.encode(), len(value)) + value


def rle(data):
    """One frame of 16 bit: the high bytes, then the low ones, each as literal runs."""
    segments = [packbits(data[1::2]), packbits(data[0::2])]
    segments = [s + b'\0' * (len(s) % 2) for s in segments]
    return struct.pack('<16I', 2, 64, 64 + len(segments[0]), *[0] * 13) + b''.join(segments)


def encapsulated(frames):
    out = struct.pack('<HH2sHI', 0x7fe0, 0x10, b'OB', 0, 0xffffffff)
    out += struct.pack('<HHI', 0xfffe, 0xe000, 0)
    for frame in frames:
        out += struct.pack('<HHI', 0xfffe, 0xe000, len(frame)) + frame
    return out + struct.pack('<HHI', 0xfffe, 0xe0dd, 0)


SYNTAXES = {'explicit': '1.2.840.10008.1.2.1', 'implicit': '1.2.840.10008.1.2',
            'rle': '1.2.840.10008.1.2.5', 'deflated': '1.2.840.10008.1.2.1.99'}


def dicom(frames, number=0, syntax='explicit'):
    multi = len(frames) > 1
    # CT, or multi-frame grayscale word secondary capture
    kind = '1.2.840.10008.5.1.4.1.1.7.3' if multi else '1.2.840.10008.5.1.4.1.1.2'
    instance = f'1.2.3.4.{number + 1}'
    meta = element(2, 1, 'OB', b'\0\1') + element(2, 2, 'UI', kind) + \
        element(2, 3, 'UI', instance) + element(2, 0x10, 'UI', SYNTAXES[syntax]) + \
        element(2, 0x12, 'UI', '1.2.3')
    head = b'\0' * 128 + b'DICM' + element(2, 0, 'UL', struct.pack('<I', len(meta))) + meta
    explicit = syntax != 'implicit'

    def put(*values):
        return element(*values, explicit=explicit)

    def u16(value):
        return struct.pack('<H', value)
    body = put(8, 0x16, 'UI', kind) + put(8, 0x18, 'UI', instance) + \
        put(8, 0x60, 'CS', 'OT' if multi else 'CT') + put(0x18, 0x50, 'DS', '1.5') + \
        put(0x20, 0x0d, 'UI', '1.2.5') + put(0x20, 0x0e, 'UI', '1.2.6') + \
        put(0x20, 0x13, 'IS', str(number)) + \
        put(0x20, 0x32, 'DS', f'-5\\-5\\{7 + 1.5 * number}') + \
        put(0x20, 0x37, 'DS', '1\\0\\0\\0\\1\\0') + put(0x20, 0x52, 'UI', '1.2.7') + \
        put(0x28, 2, 'US', u16(1)) + put(0x28, 4, 'CS', 'MONOCHROME2')
    if multi:
        body += put(0x28, 8, 'IS', str(len(frames)))
    body += put(0x28, 0x10, 'US', u16(NY)) + put(0x28, 0x11, 'US', u16(NX)) + \
        put(0x28, 0x30, 'DS', '1\\1') + put(0x28, 0x100, 'US', u16(16)) + \
        put(0x28, 0x101, 'US', u16(16)) + put(0x28, 0x102, 'US', u16(15)) + \
        put(0x28, 0x103, 'US', u16(1)) + put(0x28, 0x1052, 'DS', '0') + \
        put(0x28, 0x1053, 'DS', '1')
    if syntax == 'rle':
        body += encapsulated([rle(frame) for frame in frames])
    else:
        body += put(0x7fe0, 0x10, 'OW', b''.join(frames))
    if syntax == 'deflated':
        packer = zlib.compressobj(6, zlib.DEFLATED, -15)
        body = packer.compress(body) + packer.flush()
    return head + body


# ---- InVesalius

def inv3():
    plist = ('<?xml version="1.0"?>\n<plist version="1.0"><dict><key>matrix</key><dict>'
             '<key>dtype</key><string>int16</string><key>filename</key><string>matrix.dat</string>'
             f'<key>shape</key><array><integer>{NZ}</integer><integer>{NY}</integer>'
             f'<integer>{NX}</integer></array></dict><key>spacing</key><array><real>1</real>'
             '<real>1</real><real>1.5</real></array></dict></plist>\n').encode()
    out = io.BytesIO()
    with tarfile.open(fileobj=out, mode='w') as tar:
        for name, data in (('main.plist', plist), ('matrix.dat', raw('h'))):
            entry = tarfile.TarInfo(name)
            entry.size = len(data)
            tar.addfile(entry, io.BytesIO(data))
    return out.getvalue()


# ---- Zarr

def zarr_2(compressor):
    return json.dumps({'zarr_format': 2, 'shape': [NZ, NY, NX], 'chunks': [NZ, NY, NX], 'dtype': '<i2',
                       'fill_value': 0, 'order': 'C', 'filters': None, 'compressor': compressor}).encode()


def zarr_3():
    """A shard of one chunk."""
    def named(name, **configuration):
        return {'name': name, 'configuration': configuration}
    little = named('bytes', endian='little')
    shard = named('sharding_indexed', chunk_shape=[NZ, NY, NX], codecs=[little, named('gzip', level=6)],
                  index_codecs=[little])
    return json.dumps({'zarr_format': 3, 'node_type': 'array', 'shape': [NZ, NY, NX],
                       'data_type': 'int16', 'fill_value': 0, 'codecs': [shard],
                       'chunk_grid': named('regular', chunk_shape=[NZ, NY, NX]),
                       'chunk_key_encoding': named('default', separator='.')}).encode()


def volumes():
    """Name of a case, its files and the path that the command is given."""
    shorts, pages8, pages16 = raw('h'), slices('B'), slices('h')

    def packed_mha(data):
        size = f'CompressedDataSize = {len(data)}'
        return meta_header('MET_SHORT', 'LOCAL', ['CompressedData = True', size]) + data
    one = {
        'a.nii': nifti1('h'), 'float.nii': nifti1('f'), 'big.nii': nifti1('h', '>'),
        'two.nii': nifti2('h'),
        'a.nii.gz': Packed(nifti1('f'), gzipped), 'two.nii.gz': Packed(nifti2('B'), gzipped),
        'a.nrrd': nrrd_header('short', 'raw') + shorts,
        'double.nrrd': nrrd_header('double', 'raw') + raw('d'),
        'gzip.nrrd': nrrd_header('short', 'gzip') + gzipped(shorts),
        'text.nrrd': nrrd_header('short', 'ascii') + as_text(),
        'hex.nrrd': nrrd_header('uchar', 'hex') + raw('B').hex().encode(),
        'a.mha': meta_header('MET_SHORT', 'LOCAL') + shorts,
        'packed.mha': packed_mha(zlib.compress(shorts)),
        'text.mha': meta_header('MET_SHORT', 'LOCAL').replace(b'BinaryData = True', b'BinaryData = False') +
        as_text(),
        'a.tif': tiff(pages8, 8), 'short.tif': tiff(pages16, 16), 'big.tif': tiff(pages8, 8, 1, '>'),
        'zip.tif': tiff(pages16, 16, 8), 'lzw.tif': tiff(pages8, 8, 5),
        'bits.tif': tiff(pages8, 8, 32773), 'wide.tif': tiff(pages16, 16, 1, '<', True),
        'tiles.tif': tiff(pages8, 8, 1, '<', False, True),
        'frames.dcm': dicom(pages16), 'rle.dcm': dicom(pages16, 0, 'rle'),
        'implicit.dcm': dicom(pages16, 0, 'implicit'),
        'deflated.dcm': dicom(pages16, 0, 'deflated'),
        'a.inv3': inv3(), 'packed.inv3': Packed(inv3(), gzipped)}
    cases = [(name, {name: data}, name) for name, data in one.items()]
    raws = {f's{z}.raw': page for z, page in enumerate(pages16)}
    names = '\n'.join(raws).encode() + b'\n'
    many = [
        ('apart.nhdr', {'a.nhdr': nrrd_header('short', 'raw', 'a.raw'), 'a.raw': shorts}, 'a.nhdr'),
        ('gzip.nhdr', {'a.nhdr': nrrd_header('short', 'gzip', 'a.raw.gz'),
                       'a.raw.gz': gzipped(shorts)}, 'a.nhdr'),
        ('list.nhdr', {'a.nhdr': nrrd_header('short', 'raw', 'LIST') + names, **raws}, 'a.nhdr'),
        ('apart.mhd', {'a.mhd': meta_header('MET_SHORT', 'a.raw'), 'a.raw': shorts}, 'a.mhd'),
        ('packed.mhd', {'a.mhd': meta_header('MET_SHORT', 'a.zraw', ['CompressedData = True']),
                        'a.zraw': zlib.compress(shorts)}, 'a.mhd'),
        ('pattern.mhd', {'a.mhd': meta_header('MET_SHORT', f's%d.raw 0 {NZ - 1} 1'), **raws},
         'a.mhd'),
        ('list.mhd', {'a.mhd': meta_header('MET_SHORT', 'LIST') + names, **raws}, 'a.mhd'),
        ('tiffs', {f't/{z}.tif': tiff([page], 8) for z, page in enumerate(pages8)}, 't')]
    packed = gzipped(shorts)
    many += [
        ('plain.zarr', {'z/.zarray': zarr_2(None), 'z/0.0.0': shorts}, 'z'),
        ('zlib.zarr', {'z/.zarray': zarr_2({'id': 'zlib', 'level': 6}),
                       'z/0.0.0': Packed(shorts, zlib.compress)}, 'z'),
        ('shard.zarr', {'z/zarr.json': zarr_3(),
                        'z/c.0.0.0': packed + struct.pack('<2Q', 0, len(packed))}, 'z')]
    for syntax in ('explicit', 'implicit', 'rle'):
        files = {f'd/{z}.dcm': dicom([page], z, syntax) for z, page in enumerate(pages16)}
        many.append((f'dicom-{syntax}', files, 'd'))
    return cases + many
