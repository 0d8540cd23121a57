#!/usr/bin/env python3
"""Meshes that the command writes, read by other programs and libraries, as far as they are there:
nibabel (GIFTI), gmsh and tetgen (what they read), and Python's own zip, XML and JSON (3MF, GLB).

    tests/tools/mesh_readers.py PELLICLE FOLDER

Exit code 1 where one reads something else than what was written; 77 where none of them is there.
"""
import importlib.util
import json
import math
import pathlib
import shutil
import struct
import subprocess
import sys
import xml.etree.ElementTree
import zipfile

PELLICLE, FOLDER = sys.argv[1], pathlib.Path(sys.argv[2])
failures = 0
readers = []


def check(what, holds):
    global failures
    if not holds:
        print(f'FAILED: {what}')
        failures += 1


def run(*command):
    return subprocess.run(list(map(str, command)), cwd=FOLDER, stdin=subprocess.DEVNULL, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)


def pellicle(*arguments):
    result = run(PELLICLE, *arguments)
    check(f'{" ".join(arguments)}: {result.stdout}', result.returncode == 0)


def plain(path):
    """Points and triangles of an OFF file, the simplest there is."""
    words = (FOLDER / path).read_text().split()
    vertices, faces = int(words[1]), int(words[2])
    numbers = words[4:]
    points = [tuple(map(float, numbers[3 * i:3 * i + 3])) for i in range(vertices)]
    rest = numbers[3 * vertices:]
    return points, [tuple(map(int, rest[4 * i + 1:4 * i + 4])) for i in range(faces)]


def near(a, b, tolerance=1e-4):
    return len(a) == len(b) and all(math.dist(p, q) <= tolerance for p, q in zip(a, b))


def gifti(points, faces):
    import nibabel
    readers.append('nibabel')
    image = nibabel.load(FOLDER / 'a.surf.gii')
    xyz, abc = image.agg_data('pointset'), image.agg_data('triangle')
    # Of LPS, which was written, GIFTI is RAS.
    check('GIFTI: points', near([(-x, -y, z) for x, y, z in xyz.tolist()], points))
    check('GIFTI: triangles', list(map(tuple, abc.tolist())) == faces)
    check('GIFTI: type', str(xyz.dtype) == 'float32' and str(abc.dtype) == 'int32')
    values = nibabel.load(FOLDER / 'values.surf.gii').agg_data('shape')
    check('GIFTI: values', len(values) == 2 and len(values[0]) == len(points))


def glb(points, faces):
    readers.append('json')
    data = (FOLDER / 'values.glb').read_bytes()
    magic, version, size, length, kind = struct.unpack('<4sIII4s', data[:20])
    check('GLB: header', (magic, version, size, kind) == (b'glTF', 2, len(data), b'JSON'))
    description = json.loads(data[20:20 + length])
    length2, kind2 = struct.unpack('<I4s', data[20 + length:28 + length])
    block = data[28 + length:]
    check('GLB: block', kind2 == b'BIN\0' and length2 == len(block)
          and description['buffers'][0]['byteLength'] == len(block))

    def values(index):
        accessor = description['accessors'][index]
        view = description['bufferViews'][accessor['bufferView']]
        code = {5126: 'f', 5125: 'I', 5121: 'B'}[accessor['componentType']]
        width = {'SCALAR': 1, 'VEC3': 3, 'VEC4': 4}[accessor['type']]
        check('GLB: an array begins off its bounds', view['byteOffset'] % 4 == 0)
        flat = struct.unpack_from(f'<{accessor["count"] * width}{code}', block, view['byteOffset'])
        check('GLB: length of an array',
              struct.calcsize(f'<{len(flat)}{code}') == view['byteLength'])
        return [flat[i:i + width] for i in range(0, len(flat), width)]
    primitive = description['meshes'][0]['primitives'][0]
    attributes = primitive['attributes']
    check('GLB: points', near(values(attributes['POSITION']), points))
    corners = [v for v, in values(primitive['indices'])]
    check('GLB: triangles',
          [tuple(corners[i:i + 3]) for i in range(0, len(corners), 3)] == faces)
    check('GLB: colours', len(set(values(attributes['COLOR_0']))) > 10)
    check('GLB: values', {'_MEANCURVATURE', '_GAUSSIANCURVATURE'} <= set(attributes))


def three_mf(points, faces):
    readers.append('zip')
    with zipfile.ZipFile(FOLDER / 'a.3mf') as package:
        check('3MF: checksums', package.testzip() is None)
        check('3MF: files', set(package.namelist())
              == {'[Content_Types].xml', '_rels/.rels', '3D/3dmodel.model'})
        relations = xml.etree.ElementTree.fromstring(package.read('_rels/.rels'))
        check('3MF: relation', relations[0].get('Target') == '/3D/3dmodel.model')
        model = xml.etree.ElementTree.fromstring(package.read('3D/3dmodel.model'))
    space = '{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}'
    check('3MF: unit', model.get('unit') == 'millimeter')
    read = [tuple(float(v.get(k)) for k in 'xyz') for v in model.iter(space + 'vertex')]
    check('3MF: points', near(read, points))
    check('3MF: triangles', [tuple(int(t.get(k)) for k in ('v1', 'v2', 'v3'))
                             for t in model.iter(space + 'triangle')] == faces)
    items = [item.get('objectid') for item in model.iter(space + 'item')]
    check('3MF: what is to be built', items == [model.find(f'.//{space}object').get('id')])


def tetgen(faces):
    readers.append('tetgen')
    for name in ('a.off', 'a.vtk'):  # of STL and PLY it reads text alone
        stem = name.replace('.', '_')
        shutil.copy(FOLDER / name, FOLDER / (stem + pathlib.Path(name).suffix))
        # -p: a solid of this boundary, which it refuses where faces meet.
        result = run('tetgen', '-pQ', stem + pathlib.Path(name).suffix)
        made = FOLDER / f'{stem}.1.ele'
        check(f'tetgen: {name}: {result.stdout}', made.exists()
              and int(made.read_text().split()[0]) > len(faces) // 4)


def gmsh(points, faces):
    readers.append('gmsh')
    for name in ('a.stl', 'a.vtk'):
        result = run('gmsh', name, '-0', '-format', 'msh2', '-o', f'{name}.msh')
        text = (FOLDER / f'{name}.msh').read_text() if (FOLDER / f'{name}.msh').exists() else ''
        nodes = int(text.split('$Nodes\n')[1].split()[0]) if '$Nodes\n' in text else 0
        elements = int(text.split('$Elements\n')[1].split()[0]) if '$Elements\n' in text else 0
        check(f'gmsh: {name}: {nodes} nodes, {elements} elements: {result.stdout[-300:]}',
              nodes == len(points) and elements >= len(faces))


def main():
    pellicle('phantom', 'blobs', '--size', '24', '--seed', '7', '-o', 'ball.nrrd')
    pellicle('extract', 'ball.nrrd', '--iso', '0.5', '--quiet', '-o', 'a.ply')
    for suffix in ('off', 'stl', 'vtk', 'surf.gii', '3mf'):
        pellicle('mesh', 'a.ply', '-o', f'a.{suffix}')
    for suffix in ('glb', 'surf.gii'):
        pellicle('measure', 'a.ply', '--curvature', '-o', f'values.{suffix}')
    points, faces = plain('a.off')
    check('OFF', len(faces) > 100)
    glb(points, faces)
    three_mf(points, faces)
    if importlib.util.find_spec('nibabel'):
        gifti(points, faces)
    if shutil.which('tetgen'):
        tetgen(faces)
    if shutil.which('gmsh'):
        gmsh(points, faces)
    print(f'Read by {", ".join(readers)}: {failures} failures')
    return 1 if failures else 0


if __name__ == '__main__':
    sys.exit(main())
