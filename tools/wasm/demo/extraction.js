// An extraction in a worker, whose code and whose engine are in the page: it works from a file.
import { extract } from '../pellicle.mjs';
import { unpackedBytes } from '../../view/page/unpack.js';

let code = null;   // a URL of the worker's script
let engine = null;  // a promise of the compiled module

async function compiled() {
  return WebAssembly.compile(await unpackedBytes(0));
}

// image: of image_file.js or a part of it. told: {progress, preview, log}.
export async function extraction(image, choices, signal, told) {
  if (!engine) {
    code = URL.createObjectURL(new Blob([document.getElementById('worker').textContent], { type: 'text/javascript' }));
    engine = compiled();
  }
  const { iso, below, mesh, levels } = choices;
  const { voxels, dims, spacing, origin, direction } = image;
  return extract(voxels, dims, {
    iso,
    insideBelow: below,
    mesh,
    levels,
    spacing,
    origin,
    direction,
    normals: true,
    signal,
    ...told,
    previewInterval: 50,
    engine: await engine,
    worker: () => new Worker(code),
  });
}

const quoted = (name) => (/^[\w./-]+$/.test(name) ? name : `'${name.replaceAll("'", "'\\''")}'`);

// What gives the same surface, bit for bit. box: [low, high] where it is not the whole image.
export function commandLine(name, { iso, below, mesh, levels }, box) {
  const words = ['pellicle extract', quoted(name), '-o surface.ply', iso < 0 ? `--iso=${iso}` : `--iso ${iso}`];
  if (below) words.push('--inside below');
  if (mesh !== 'adaptive') words.push(`--mesh ${mesh}`);
  if (levels >= 0) words.push(`--levels ${levels}`);
  if (box) words.push(`--box ${[0, 1, 2].flatMap((k) => [box.low[k], box.high[k]]).join(',')}`);
  return words.join(' ');
}
