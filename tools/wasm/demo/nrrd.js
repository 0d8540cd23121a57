// NRRD with its voxels in the same file, raw or packed by gzip.   https://teem.sourceforge.net/nrrd/format.html
import { refuse } from './failure.js';
import { checkedSize, voxelsFrom } from './voxels.js';

const MOST_HEADER = 2 ** 16;  // bytes
const TYPES = new Map(Object.entries({
  u8: 'uchar|unsigned char|uint8|uint8_t',
  i8: 'signed char|int8|int8_t',
  i16: 'short|short int|signed short|signed short int|int16|int16_t',
  u16: 'ushort|unsigned short|unsigned short int|uint16|uint16_t',
  i32: 'int|signed int|int32|int32_t',
  u32: 'uint|unsigned int|uint32|uint32_t',
  f32: 'float',
  f64: 'double',
}).flatMap(([type, names]) => names.split('|').map((name) => [name, type])));
// To LPS, by the sign of each axis; other spaces are none of a patient's, and are taken as they are.
const SIGNS = new Map([
  ['right-anterior-superior', [-1, -1, 1]], ['ras', [-1, -1, 1]],
  ['left-anterior-superior', [1, -1, 1]], ['las', [1, -1, 1]],
]);

export function isNrrd(bytes) {
  return String.fromCharCode(...bytes.subarray(0, 4)) === 'NRRD';
}

// The fields, and where the voxels begin.
async function headerOf(file) {
  const bytes = new Uint8Array(await file.slice(0, MOST_HEADER).arrayBuffer());
  const text = new TextDecoder('latin1').decode(bytes);
  const end = text.match(/\r?\n\r?\n/);
  if (!end) refuse(`${file.name}: is not a readable NRRD file (its header does not end)`);
  const fields = new Map();
  for (const line of text.slice(0, end.index).split(/\r?\n/).slice(1)) {
    const field = line.match(/^([^#:=]+): (.*)$/);  // neither a comment nor a key and its value
    if (field) fields.set(field[1].trim().toLowerCase(), field[2].trim());
  }
  return { fields, begin: end.index + end[0].length };
}

const vectorOf = (text) => text.replace(/[()\s]/g, '').split(',').map(Number);

// As ITK has it: with space directions, else by spacings alone.
function placed(name, fields) {
  const signs = SIGNS.get(fields.get('space')?.toLowerCase()) ?? [1, 1, 1];
  const directions = fields.get('space directions');
  const axes = directions ? (directions.match(/\([^)]*\)|none/g) ?? []).map(vectorOf)
    : (fields.get('spacings') ?? '1 1 1').split(/\s+/).map((x, k) => [0, 1, 2].map((row) => (row === k ? Number(x) || 1 : 0)));
  const origin = fields.has('space origin') ? vectorOf(fields.get('space origin')) : [0, 0, 0];
  const lps = axes.map((axis) => axis.map((x, row) => x * signs[row]));
  const spacing = lps.map((axis) => Math.hypot(...axis));
  const direction = [0, 1, 2].flatMap((row) => lps.map((axis, k) => axis[row] / spacing[k]));
  const place = { spacing, direction, origin: origin.map((x, row) => x * signs[row]) };
  if (axes.length !== 3 || origin.length !== 3 || ![...spacing, ...direction, ...place.origin].every(Number.isFinite)) {
    refuse(`${name}: says nothing usable of where its voxels lie`);
  }
  return place;
}

// bytesFrom(begin, packed): of the file from there on.
export async function readNrrd(file, bytesFrom) {
  const { name } = file;
  const { fields, begin } = await headerOf(file);
  const need = (key) => fields.get(key) ?? refuse(`${name}: is not a readable NRRD file (it has no "${key}")`);
  if (fields.has('data file') || fields.has('datafile')) refuse(`${name}: has its voxels in another file, which is not supported here`);
  for (const key of ['line skip', 'lineskip', 'byte skip', 'byteskip']) {
    if (Number(fields.get(key) ?? 0) !== 0) refuse(`${name}: has a "${key}", which is not supported here`);
  }
  const type = TYPES.get(need('type').toLowerCase()) ?? refuse(`${name}: has voxels of a type that is not supported (${need('type')})`);
  const encoding = need('encoding').toLowerCase();
  if (!['raw', 'gzip', 'gz'].includes(encoding)) refuse(`${name}: has the encoding ${encoding}, which is not supported here`);
  const dims = need('sizes').split(/\s+/).map(Number);
  const needed = checkedSize(name, dims, type);
  const place = placed(name, fields);
  const bytes = await bytesFrom(begin, encoding !== 'raw');
  return { name, dims, voxels: voxelsFrom(name, await bytes.voxels(needed), type, { bigEndian: fields.get('endian')?.toLowerCase() === 'big' }), ...place };
}
