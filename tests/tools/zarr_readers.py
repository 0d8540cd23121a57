"""OME-Zarr as Debian's zarr writes and reads it.   zarr_readers.py PELLICLE FOLDER

The command must find in arrays of every packing, type and order what numpy has, and zarr in what
the command writes.
"""
import json
import os
import subprocess
import sys

import numcodecs
import numpy
import zarr

pellicle, folder = sys.argv[1:]
z, y, x = numpy.meshgrid(numpy.arange(41.0), numpy.arange(36.0), numpy.arange(47.0), indexing='ij')
BALL = 15 - numpy.sqrt((x - 23) ** 2 + (y - 18) ** 2 + (z - 20) ** 2)  # above 0 within it


def run(*words):
    return subprocess.run([pellicle, *words], check=True, capture_output=True, text=True).stdout


def surface_of(path):
    """The hash of the surface of an image."""
    report = os.path.join(folder, 'report.json')
    run('extract', path, '-o', os.path.join(folder, 'a.ply'), '--iso', '0', '--quiet', '--report', report)
    with open(report, encoding='utf-8') as file:
        return json.load(file)['hash']


def nrrd(values):
    path = os.path.join(folder, 'same.nrrd')
    kind = {'i1': 'int8', 'i2': 'int16', 'i4': 'int32', 'f4': 'float', 'f8': 'double'}[values.dtype.str[1:]]
    head = (f'NRRD0004\ntype: {kind}\ndimension: 3\nspace: left-posterior-superior\nsizes: 47 36 41\n'
            'space directions: (1,0,0) (0,1,0) (0,0,1.5)\nendian: little\nencoding: raw\n'
            'space origin: (1,2,3)\n\n')
    with open(path, 'wb') as file:
        file.write(head.encode() + values.astype(values.dtype.newbyteorder('<')).tobytes())
    return path


def put(name, values, **how):
    path = os.path.join(folder, name)
    group = zarr.open_group(path, 'w')
    group.create_dataset('0', data=values, **how)
    axes = [{'name': n, 'type': 'space', 'unit': 'millimeter'} for n in 'zyx']
    group.attrs['multiscales'] = [{'version': '0.4', 'axes': axes, 'datasets': [{
        'path': '0', 'coordinateTransformations': [
            {'type': 'scale', 'scale': [1.5, 1, 1]}, {'type': 'translation', 'translation': [3, 2, 1]}]}]}]
    return path


WAYS = [
    ('lz4', 'i2', {'compressor': numcodecs.Blosc('lz4'), 'chunks': (16, 16, 16)}),
    ('bits', 'f4', {'compressor': numcodecs.Blosc('zstd', shuffle=numcodecs.Blosc.BITSHUFFLE)}),
    ('lz', '>i4', {'compressor': numcodecs.Blosc('blosclz'), 'chunks': (50, 7, 13)}),
    ('zlib', 'i1', {'compressor': numcodecs.Blosc('zlib'), 'chunks': (7, 50, 9), 'order': 'F'}),
    ('zstd', 'f8', {'compressor': numcodecs.Zstd(5), 'chunks': (11, 12, 13)}),
    ('gzip', '>f4', {'compressor': numcodecs.GZip(5), 'chunks': (1, 36, 47)}),
    ('deflate', 'i2', {'compressor': numcodecs.Zlib(5), 'dimension_separator': '/'}),
    ('plain', '>i2', {'compressor': None, 'chunks': (41, 1, 47)}),
]
for name, kind, how in WAYS:
    array = (BALL * 4).astype(kind)
    assert surface_of(put(name + '.ome.zarr', array, **how)) == surface_of(nrrd(array)), name

for kind in ('u8', 'i16', 'f32'):
    ours, theirs = os.path.join(folder, 'ours.ome.zarr'), os.path.join(folder, 'ours.nrrd')
    for path in (ours, theirs):
        run('phantom', 'chain', '--type', kind, '--size', '70,66,80', '-o', path)
    array = zarr.open_group(ours, 'r')['0'][:]
    with open(theirs, 'rb') as file:
        assert file.read().endswith(array.tobytes()), kind
print(f'{len(WAYS)} arrays of zarr read, 3 of ours read by zarr')
