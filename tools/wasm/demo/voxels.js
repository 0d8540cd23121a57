// The voxels of a file as one of the arrays that the engine takes, as tools/volume/volume_io.cpp makes them.
import { refuse } from './failure.js';

const STORED = {
  u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array, i32: Int32Array, f32: Float32Array, f64: Float64Array,
};
const TAKEN = { u8: 'u8', i8: 'i16', u16: 'u16', i16: 'i16', i32: 'i32', f32: 'f32', f64: 'f32' };

// What a browser gives a page at once, and copies into a worker without running out of memory.
const MOST_BYTES = 2 ** 31 - 1;

export const countOf = (dims) => dims[0] * dims[1] * dims[2];
export const textOf = (dims) => dims.join(' x ');

// Before memory is taken. Returns bytes.
export function checkedSize(name, dims, type) {
  if (dims.length !== 3) refuse(`${name}: is ${dims.length}-D; a 3-D volume is needed`);
  if (!dims.every((n) => Number.isInteger(n) && n >= 2)) {
    refuse(`${name}: is not a volume (${textOf(dims)} voxels; at least 2 along each axis are needed)`);
  }
  const bytes = countOf(dims) * STORED[type].BYTES_PER_ELEMENT;
  const held = countOf(dims) * Math.max(STORED[type].BYTES_PER_ELEMENT, STORED[TAKEN[type] ?? 'f32'].BYTES_PER_ELEMENT);
  if (held > MOST_BYTES) {
    refuse(`${name}: has ${textOf(dims)} voxels, ${(held / 1e9).toFixed(1)} GB: more than the ${(MOST_BYTES / 1e9).toFixed(1)} GB that a page can hold; the command pellicle has no such limit`);
  }
  return bytes;
}

function swapBytes(bytes, size) {
  for (let at = 0; size > 1 && at < bytes.length; at += size) bytes.subarray(at, at + size).reverse();
}

function finite(name, values) {
  for (let i = 0; i < values.length; ++i) {
    if (!Number.isFinite(values[i])) refuse(`${name}: has voxels that are NaN or infinite`);
  }
  return values;
}

// bytes: those of the voxels; they are changed. A value is slope * voxel + intercept.
export function voxelsFrom(name, bytes, type, { bigEndian = false, slope = 1, intercept = 0 } = {}) {
  const Stored = STORED[type];
  if (bigEndian) swapBytes(bytes, Stored.BYTES_PER_ELEMENT);
  const stored = new Stored(bytes.buffer, 0, bytes.length / Stored.BYTES_PER_ELEMENT);
  if (slope !== 1 || intercept !== 0) return finite(name, Float32Array.from(stored, (x) => slope * x + intercept));
  if (type === 'u32') return stored.every((x) => x < 2 ** 31) ? Int32Array.from(stored) : Float32Array.from(stored);
  if (TAKEN[type] === type) return type === 'f32' ? finite(name, stored) : stored;
  return finite(name, STORED[TAKEN[type]].from(stored));
}

// The part of the image from voxel low to high, both within, as --box of the command.
export function cutOut(image, low, high) {
  const dims = [0, 1, 2].map((k) => high[k] - low[k] + 1);
  if (dims.every((n, k) => n === image.dims[k])) return image;
  const voxels = new image.voxels.constructor(countOf(dims));
  let to = 0;
  for (let z = low[2]; z <= high[2]; ++z) {
    for (let y = low[1]; y <= high[1]; ++y, to += dims[0]) {
      const from = (z * image.dims[1] + y) * image.dims[0] + low[0];
      voxels.set(image.voxels.subarray(from, from + dims[0]), to);
    }
  }
  const origin = [0, 1, 2].map((row) => image.origin[row] + [0, 1, 2].reduce((sum, k) => sum + image.direction[3 * row + k] * image.spacing[k] * low[k], 0));
  return { ...image, dims, voxels, origin };
}
