// The bytes of a file one after the other, unpacked on the way where it is gzip's.
import { refuse } from './failure.js';

const MOST_BEHIND = 2 ** 24;  // bytes after the voxels that are read for gzip's checksum

export class Bytes {
  constructor(stream, name) {
    this.name = name;
    this.reader = stream.getReader();
    this.left = new Uint8Array(0);
  }

  // Whether there are more in `left`.
  async #more() {
    try {
      const { done, value } = await this.reader.read();
      this.left = done ? new Uint8Array(0) : value;
      return !done;
    } catch (error) {
      if (error.name === 'NotReadableError' || error.name === 'NotFoundError') refuse(`${this.name}: cannot be read`);
      return refuse(`${this.name}: is truncated or damaged (its gzip stream is not whole)`);
    }
  }

  // Into `to`, a Uint8Array, unless they end before. Returns how many.
  async fill(to) {
    let count = 0;
    while (count < to.length) {
      if (this.left.length === 0 && !(await this.#more())) break;
      const some = this.left.subarray(0, to.length - count);
      to.set(some, count);
      count += some.length;
      this.left = this.left.subarray(some.length);
    }
    return count;
  }

  // The first ones, up to `count`, which are read again afterwards.
  async peek(count) {
    const head = new Uint8Array(count);
    const some = head.slice(0, await this.fill(head));
    const left = new Uint8Array(some.length + this.left.length);
    left.set(some);
    left.set(this.left, some.length);
    this.left = left;
    return some;
  }

  async skip(count) {
    const some = new Uint8Array(Math.min(count, 2 ** 16));
    for (let left = count; left > 0; left -= some.length) {
      if ((await this.fill(some.subarray(0, Math.min(left, some.length)))) === 0) return;
    }
  }

  // As many voxels as there must be; on to the end, where gzip's checksum is.
  async voxels(size) {
    const all = new Uint8Array(size);
    const count = await this.fill(all);
    if (count < size) refuse(`${this.name}: is truncated (${count} bytes of voxels, ${size} are needed)`);
    for (let behind = 0; behind < MOST_BEHIND && (await this.#more());) behind += this.left.length;
    await this.reader.cancel();
    return all;
  }
}

// From byte `begin` of the file on.
export async function bytesOf(file, { begin = 0, packed } = {}) {
  const part = file.slice(begin);
  const magic = new Uint8Array(await part.slice(0, 2).arrayBuffer());
  const isPacked = packed ?? (magic[0] === 0x1f && magic[1] === 0x8b);
  const stream = isPacked ? part.stream().pipeThrough(new DecompressionStream('gzip')) : part.stream();
  return new Bytes(stream, file.name);
}
