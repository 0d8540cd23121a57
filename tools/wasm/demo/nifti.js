// NIfTI, version 1 and 2: the header by nifti-reader-js; where the voxels lie as tools/volume/nifti_frame.cpp has it.
import { readHeader } from 'nifti-reader-js';
import { refuse } from './failure.js';
import { checkedSize, voxelsFrom } from './voxels.js';

const TYPES = { 2: 'u8', 4: 'i16', 8: 'i32', 16: 'f32', 64: 'f64', 256: 'i8', 512: 'u16', 768: 'u32' };
const SIZES = { 1: 348, 2: 540 };  // of a header, bytes

export function isNifti(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset);
  return bytes.length >= SIZES[1] && [true, false].some((little) => [348, 540].includes(view.getInt32(0, little)));
}

// From voxel indices to RAS: three rows of four.
function sformOf(header) {
  return header.affine.slice(0, 3).map((row) => [...row]);
}

function qformOf(header) {
  let [b, c, d] = [header.quatern_b, header.quatern_c, header.quatern_d];
  const squared = b * b + c * c + d * d;
  const a = squared < 1 ? Math.sqrt(1 - squared) : 0;
  if (squared >= 1) [b, c, d] = [b, c, d].map((x) => x / Math.sqrt(squared));
  const rotation = [
    [a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c)],
    [2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b)],
    [2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - c * c - b * b],
  ];
  const sides = [1, 2, 3].map((k) => Math.abs(header.pixDims[k]));
  if (header.pixDims[0] < 0) sides[2] = -sides[2];
  const place = [header.qoffset_x, header.qoffset_y, header.qoffset_z];
  return rotation.map((row, i) => [...row.map((x, k) => x * sides[k]), place[i]]);
}

function withoutForm(header, dims) {
  return [0, 1, 2].map((k) => {
    const row = [0, 0, 0, 0];
    row[k] = (k === 0 ? -1 : 1) * Math.abs(header.pixDims[k + 1]);
    row[3] = -0.5 * row[k] * (dims[k] - 1);
    return row;
  });
}

function placed(name, header, dims) {
  const form = header.sform_code > 0 ? sformOf(header) : header.qform_code > 0 ? qformOf(header) : withoutForm(header, dims);
  const unit = { 1: 1e3, 3: 1e-3 }[header.xyzt_units & 7] ?? 1;  // metres and microns
  // RAS to LPS.
  const lps = form.map((row, i) => row.map((x) => (i < 2 ? 0 - x : x) * unit));
  const spacing = [0, 1, 2].map((k) => Math.hypot(lps[0][k], lps[1][k], lps[2][k]));
  const direction = lps.flatMap((row) => [0, 1, 2].map((k) => row[k] / spacing[k]));
  const origin = lps.map((row) => row[3]);
  if (![...spacing, ...direction, ...origin].every(Number.isFinite)) refuse(`${name}: says nothing usable of where its voxels lie`);
  return { spacing, direction, origin };
}

// bytes: of the file, unpacked; head: the first of them.
export async function readNifti(name, head, bytes) {
  const wide = [true, false].some((little) => new DataView(head.buffer).getInt32(0, little) === SIZES[2]);
  const magic = String.fromCharCode(...head.subarray(wide ? 4 : 344, wide ? 7 : 347));
  if (magic === 'ni1' || magic === 'ni2') refuse(`${name}: has its voxels in another file, which is not supported: .nii files hold both`);
  if (magic !== (wide ? 'n+2' : 'n+1')) refuse(`${name}: is not a readable NIfTI file`);
  const size = SIZES[wide ? 2 : 1];
  // Without what may follow the header, which the reader would look at.
  const header = readHeader(head.slice(0, size).buffer);
  const axes = header.dims[0];
  const begin = Math.max(header.vox_offset, size);
  if (!(axes >= 1 && axes <= 7) || !(begin < 2 ** 31)) refuse(`${name}: is not a readable NIfTI file (its header is damaged)`);
  const dims = header.dims.slice(1, axes + 1).map((n) => Math.max(1, Number(n)));
  while (dims.length > 3 && dims.at(-1) === 1) dims.pop();
  const type = TYPES[header.datatypeCode];
  if (!type) refuse(`${name}: has voxels of a type that is not supported (NIfTI type ${header.datatypeCode})`);
  const needed = checkedSize(name, dims, type);
  const place = placed(name, header, dims);
  const scaled = Number.isFinite(header.scl_slope) && header.scl_slope !== 0;
  const scale = scaled ? { slope: header.scl_slope, intercept: Number.isFinite(header.scl_inter) ? header.scl_inter : 0 } : {};
  await bytes.skip(begin);
  const voxels = voxelsFrom(name, await bytes.voxels(needed), type, { bigEndian: !header.littleEndian, ...scale });
  const placeless = header.sform_code <= 0 && header.qform_code <= 0;
  const notes = placeless ? ['The file says nothing of its place: its centre is taken for the origin, its first axis to run to the left'] : [];
  return { name, dims, voxels, ...place, notes };
}
