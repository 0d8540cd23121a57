// The engine in WebAssembly's memory: one extraction, on the calling thread.

const kTypes = new Map([
  [Uint8Array, 0], [Uint8ClampedArray, 0], [Int16Array, 1], [Uint16Array, 2], [Int32Array, 3], [Float32Array, 4],
]);
const kSpaces = ['lps', 'ras', 'voxel'];
const kIdentity = [1, 0, 0, 0, 1, 0, 0, 0, 1];
const kStatus = ['ok', 'invalid-argument', 'invalid-data', 'out-of-memory', 'cancelled', 'internal'];
// Of extract() itself; every other option is a parameter of the engine.
const kOwn = new Set(['spacing', 'origin', 'direction', 'space', 'normals']);

export class PellicleError extends Error {
  constructor(status, message) {
    super(message);
    this.name = 'PellicleError';
    this.status = status;
  }
}

function refuse(message) {
  throw new PellicleError('invalid-argument', message);
}

// The bytes of pellicle.wasm, which lies beside this file.
export async function engineBytes() {
  const url = new URL('pellicle.wasm', import.meta.url);
  if (typeof process === 'object' && process.versions?.node) {
    return (await import('node:fs/promises')).readFile(url);
  }
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: ${response.status} ${response.statusText}`);
  return response.arrayBuffer();
}

function triple(name, value, fallback, count = 3) {
  if (value === undefined) return fallback;
  const numbers = Array.from(value);
  if (numbers.length !== count || !numbers.every((n) => typeof n === 'number')) {
    refuse(`${name}: must be ${count} numbers`);
  }
  return numbers;
}

// code: bytes or a WebAssembly.Module. voxels: a typed array, x fastest; dims: three numbers. told: {progress(p), log(level, line)}, and where
// the surface is wanted on the way {preview(surface), every: milliseconds between two at least}.
export async function extractHere(code, voxels, dims, options, told) {
  const type = kTypes.get(voxels?.constructor);
  if (type === undefined) refuse('voxels: must be a Uint8Array, Int16Array, Uint16Array, Int32Array or Float32Array');
  const size = triple('dims', dims);
  if (size === undefined || !size.every((n) => Number.isInteger(n) && n > 0 && n < 2 ** 31)) {
    refuse('dims: must be three whole numbers above 0');
  }
  if (size[0] * size[1] * size[2] !== voxels.length) {
    refuse(`voxels: ${voxels.length}, but dims are ${size.join(' x ')}`);
  }
  const geometry = [
    ...triple('spacing', options.spacing, [1, 1, 1]), ...triple('origin', options.origin, [0, 0, 0]),
    ...triple('direction', options.direction, kIdentity, 9),
  ];
  const space = kSpaces.indexOf(options.space ?? 'lps');
  if (space < 0) refuse(`space: must be one of ${kSpaces.join(', ')}`);

  let memory;
  const text = (at) => {
    const all = new Uint8Array(memory.buffer);
    return new TextDecoder().decode(all.slice(at, all.indexOf(0, at)));
  };
  const made = await WebAssembly.instantiate(code, {
    pellicle: {
      progress: (level, levels, iteration, vertices, fraction, seconds) =>
        told.progress?.({ level, levels, iteration, vertices, fraction, seconds }),
      log: (level, line) => told.log?.(level === 1 ? 'warning' : 'info', text(line)),
    },
    env: { emscripten_notify_memory_growth: () => {} },
    // What the C library asks a system for. The engine asks for the time alone.
    wasi_snapshot_preview1: {
      clock_time_get: (_clock, _precision, at) => {
        new DataView(memory.buffer).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
        return 0;
      },
      proc_exit: (code) => { throw new PellicleError('internal', `the engine has ended: ${code}`); },
      fd_write: () => 8, fd_close: () => 8, fd_seek: () => 8, fd_read: () => 8,
      environ_sizes_get: (count, length) => {
        const view = new DataView(memory.buffer);
        view.setUint32(count, 0, true);
        view.setUint32(length, 0, true);
        return 0;
      },
      environ_get: () => 0,
    },
  });
  const engine = (made.instance ?? made).exports;
  memory = engine.memory;
  engine._initialize?.();
  const check = (status) => {
    if (status !== 0) throw new PellicleError(kStatus[status], text(engine.last_message()));
  };
  // A view of memory lasts until the engine is called.
  const room = (Type, length) => {
    const at = engine.allocate(length * Type.BYTES_PER_ELEMENT) >>> 0;
    if (at === 0) throw new PellicleError('out-of-memory', 'there is no more memory');
    return { at, view: () => new Type(memory.buffer, at, length) };
  };
  const placed = (Type, values) => {
    const made = room(Type, values.length);
    made.view().set(values);
    return made.at;
  };
  const word = (s) => placed(Uint8Array, new TextEncoder().encode(`${s}\0`));

  check(engine.start());
  for (const [option, value] of Object.entries(options)) {
    if (kOwn.has(option) || value === undefined) continue;
    const name = word(option.replace(/[A-Z]/g, (c) => `_${c.toLowerCase()}`));
    const values = Array.isArray(value) ? value : [value];
    values.forEach((v, index) => {
      let code = 3;
      if (typeof v === 'string') code = engine.choose_parameter(name, word(v));
      else if (typeof v === 'number' || typeof v === 'boolean') code = engine.set_parameter(name, index, Number(v));
      if (code === 1) refuse(`${option}: no such option`);
      if (code !== 0) refuse(`${option}: cannot be ${JSON.stringify(v)}`);
    });
    if (option === 'levelIso') engine.set_parameter(word('level_iso_count'), 0, values.length);
  }
  engine.set_image(type, placed(voxels.constructor, voxels), ...size, placed(Float64Array, geometry));

  // `fill` writes the values, which are copied out of the engine's memory.
  const taken = (Type, length, fill) => {
    const made = room(Type, length);
    try {
      check(fill(space, made.at));
      return made.view().slice();
    } finally {
      engine.release(made.at);
    }
  };
  const triangles = () => ({
    vertices: taken(Float32Array, 3 * engine.vertex_count(), engine.positions),
    faces: taken(Uint32Array, 3 * engine.face_count(), engine.faces),
  });
  if (told.preview) {
    check(engine.run_start());
    let next = 0;
    while (!engine.run_done()) {
      check(engine.run_advance());
      const begin = performance.now();
      if (begin < next) continue;
      check(engine.take_surface());
      told.preview(triangles());
      const end = performance.now();
      next = end + Math.max(told.every, 9 * (end - begin));  // looking takes no more than a tenth
    }
    check(engine.take_surface());
  } else {
    check(engine.extract());
  }

  const [components, euler, genus, area, volume] = taken(Float64Array, 5, engine.measure);
  const hex = (n) => (n >>> 0).toString(16).padStart(8, '0');
  const result = {
    ...triangles(),
    measures: { components, euler, genus, area, volume },
    converged: engine.converged() === 1,
    hash: hex(engine.hash_high()) + hex(engine.hash_low()),
    simd: text(engine.simd()),
    version: text(engine.version()),
  };
  if (options.normals) result.normals = taken(Float32Array, 3 * engine.vertex_count(), engine.normals);
  return result;
}
