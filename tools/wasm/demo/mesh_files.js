// The surface as a file, as the command writes it: LPS, mm, floats.
const LITTLE = true;

function latin1(text) { return Uint8Array.from(text, (c) => c.charCodeAt(0)); }

function ply({ vertices, faces, normals }) {
  const head = latin1([
    'ply', 'format binary_little_endian 1.0', 'comment Pellicle', 'comment SPACE=LPS', `element vertex ${vertices.length / 3}`,
    ...['x', 'y', 'z', 'nx', 'ny', 'nz'].map((name) => `property float ${name}`),
    `element face ${faces.length / 3}`, 'property list uchar uint vertex_indices', 'end_header', '',
  ].join('\n'));
  const points = new Float32Array(2 * vertices.length);
  for (let i = 0; i < vertices.length; i += 3) {
    points.set(vertices.subarray(i, i + 3), 2 * i);
    points.set(normals.subarray(i, i + 3), 2 * i + 3);
  }
  const corners = new Uint8Array((faces.length / 3) * 13);
  const view = new DataView(corners.buffer);
  for (let i = 0, at = 0; i < faces.length; i += 3, at += 13) {
    corners[at] = 3;
    for (let k = 0; k < 3; ++k) view.setUint32(at + 1 + 4 * k, faces[i + k], LITTLE);
  }
  return [head, points, corners];
}

function stl({ vertices, faces }) {
  const out = new DataView(new ArrayBuffer(84 + (faces.length / 3) * 50));
  new Uint8Array(out.buffer).set(latin1('Binary STL by Pellicle, mm SPACE=LPS'.padEnd(80)));
  out.setUint32(80, faces.length / 3, LITTLE);
  for (let i = 0, at = 84; i < faces.length; i += 3, at += 50) {
    const [a, b, c] = [0, 1, 2].map((k) => vertices.subarray(3 * faces[i + k], 3 * faces[i + k] + 3));
    const u = [0, 1, 2].map((k) => b[k] - a[k]);
    const v = [0, 1, 2].map((k) => c[k] - a[k]);
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    const length = Math.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    [...n.map((x) => (length > 0 ? x / length : 0)), ...a, ...b, ...c].forEach((x, k) => out.setFloat32(at + 4 * k, x, LITTLE));
  }
  return [out.buffer];
}

// glTF 2.0 in one file: a node turns and scales the floats, as glTF has metres, y up and z to the front.
function glb({ vertices, faces, normals }) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  vertices.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3], x);
    high[i % 3] = Math.max(high[i % 3], x);
  });
  const arrays = [vertices, normals, faces];
  const begins = arrays.map((_, i) => arrays.slice(0, i).reduce((sum, array) => sum + array.byteLength, 0));
  const length = begins[2] + faces.byteLength;
  const [ARRAY, ELEMENTS, FLOAT, UINT] = [34962, 34963, 5126, 5125];
  const description = {
    asset: { version: '2.0', generator: 'Pellicle' },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, matrix: [0.001, 0, 0, 0, 0, 0, -0.001, 0, 0, 0.001, 0, 0, 0, 0, 0, 1], extras: { space: 'LPS', unit: 'mm' } }],
    meshes: [{ primitives: [{ attributes: { POSITION: 0, NORMAL: 1 }, indices: 2, material: 0 }] }],
    materials: [{ pbrMetallicRoughness: { baseColorFactor: [0.79, 0.75, 0.65, 1], metallicFactor: 0, roughnessFactor: 0.7 } }],
    buffers: [{ byteLength: length }],
    bufferViews: arrays.map((array, i) => ({ buffer: 0, byteOffset: begins[i], byteLength: array.byteLength, target: i < 2 ? ARRAY : ELEMENTS })),
    accessors: [
      { bufferView: 0, componentType: FLOAT, count: vertices.length / 3, type: 'VEC3', min: low, max: high },
      { bufferView: 1, componentType: FLOAT, count: vertices.length / 3, type: 'VEC3' },
      { bufferView: 2, componentType: UINT, count: faces.length, type: 'SCALAR' },
    ],
  };
  const json = latin1(JSON.stringify(description));
  const padded = Math.ceil(json.length / 4) * 4;
  const words = (...all) => new Uint32Array(all);
  const [GLTF, JSON_CHUNK, BINARY_CHUNK] = [0x46546c67, 0x4e4f534a, 0x004e4942];
  return [
    words(GLTF, 2, 28 + padded + length, padded, JSON_CHUNK), json, latin1(' '.repeat(padded - json.length)),
    words(length, BINARY_CHUNK), ...arrays,
  ];
}

export const FORMATS = { ply, stl, glb };

// surface: of extract(), with normals.
export function download(surface, format, stem) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob(FORMATS[format](surface)));
  link.download = `${stem}.${format}`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}
