/** Closed triangulated surfaces from 3D images. */

export type Voxels = Uint8Array | Uint8ClampedArray | Int16Array | Uint16Array | Int32Array | Float32Array;

/** What a run tells after every iteration, and now and then before the first. */
export interface Progress {
  /** Of the image in which the mesh evolves; counts down to 0. */
  level: number;
  /** Levels above the full image. */
  levels: number;
  /** Of this level, from 1; 0, without vertices, before the first. */
  iteration: number;
  vertices: number;
  /** An estimate of what is done, 0 .. 1, never falling. */
  fraction: number;
  seconds: number;
}

/**
 * Of the image, of the call, and every parameter of the engine by its name in engine/pellicle.h, in
 * camelCase: `iso`, `curvature`, `maxIterations`, ... A choice is a word: `mesh: 'uniform'`.
 */
export interface Options {
  /** The value that the surface is drawn at, in the image's units. */
  iso?: number;
  /** true: the object is where the image is at most `iso`. */
  insideBelow?: boolean;
  /** Between voxel centres, mm; 1 unless told. */
  spacing?: ArrayLike<number>;
  /** Of the first voxel's centre, LPS, mm; 0 unless told. */
  origin?: ArrayLike<number>;
  /** 3 x 3, row-major: columns are the image's axes in LPS; the identity unless told. */
  direction?: ArrayLike<number>;
  /** Of the vertices; 'lps' unless told. */
  space?: 'lps' | 'ras' | 'voxel';
  /** Whether normals are wanted, too. */
  normals?: boolean;
  /** Ends the extraction at once: its promise is rejected with the signal's reason. */
  signal?: AbortSignal;
  progress?: (progress: Progress) => void;
  log?: (level: 'info' | 'warning', line: string) => void;
  /** Is given the surface as it grows, valid at any time. Takes more memory, and the time of copying it. */
  preview?: (surface: Triangles) => void;
  /** Between two previews, milliseconds at least; 250 unless told. */
  previewInterval?: number;
  /**
   * What pages need that cannot fetch files, as those that are opened from disk: the bytes of
   * pellicle.wasm, or what WebAssembly.compile makes of them, and a worker that runs worker.mjs. It
   * is ended with the extraction.
   */
  engine?: BufferSource | WebAssembly.Module;
  worker?: () => Worker;
  [parameter: string]: unknown;
}

export interface Triangles {
  /** x, y, z of every vertex. */
  vertices: Float32Array;
  /** Three vertices of every face, counter-clockwise seen from outside. */
  faces: Uint32Array;
}

export interface Surface extends Triangles {
  /** Outward, of length 1; where they were asked for. */
  normals?: Float32Array;
  measures: {
    components: number;
    /** Vertices - edges + faces. */
    euler: number;
    /** Of all components together. */
    genus: number;
    /** In the space of the vertices, mm2 and mm3 in patient space. */
    area: number;
    volume: number;
  };
  /** Whether every level came to rest; false where `maxIterations` ended one. */
  converged: boolean;
  /** 16 hexadecimal digits: two surfaces are the same, bit for bit, where these are. */
  hash: string;
  /** The instruction set that was computed with: 'wasm'. */
  simd: string;
  version: string;
}

export class PellicleError extends Error {
  status: 'invalid-argument' | 'invalid-data' | 'out-of-memory' | 'cancelled' | 'internal';
}

/** `voxels`: x fastest, `dims[0] * dims[1] * dims[2]` of them; they are copied. Runs in a worker. */
export function extract(voxels: Voxels, dims: ArrayLike<number>, options?: Options): Promise<Surface>;
