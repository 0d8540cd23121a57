// The npm package in node: the recorded surface, progress, cancelling, errors of one line.
//   PELLICLE_PACKAGE=FOLDER node --test tests/wasm/test_wasm.mjs
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import path from 'node:path';
import test from 'node:test';
import { pathToFileURL } from 'node:url';
import { Worker } from 'node:worker_threads';

const folder = path.resolve(process.env.PELLICLE_PACKAGE);
const { extract, PellicleError } = await import(pathToFileURL(path.join(folder, 'pellicle.mjs')));

// Two balls that overlap: the image and the hash of tests/api/test_recorded_balls.cpp.
const kDims = [44, 36, 32];
const kHash = '3a1e62066a367129';
const kOptions = { iso: 600, spacing: [1, 1, 1.25], levels: 1, maxIterations: 60 };

function balls() {
  const voxels = new Int16Array(kDims[0] * kDims[1] * kDims[2]);
  let at = 0;
  for (let z = 0; z < kDims[2]; ++z) {
    for (let y = 0; y < kDims[1]; ++y) {
      for (let x = 0; x < kDims[0]; ++x) {
        const squared = (cx) => (x - cx) ** 2 + (y - 17) ** 2 + (z - 15) ** 2;
        voxels[at++] = Math.max(0, 1000 - 4 * Math.min(squared(15), squared(28)));
      }
    }
  }
  return voxels;
}

test('the surface is the recorded one, closed and of typed arrays', async () => {
  const surface = await extract(balls(), kDims, { ...kOptions, normals: true });
  assert.equal(surface.hash, kHash);
  assert.equal(surface.simd, 'wasm');
  assert.ok(surface.vertices instanceof Float32Array && surface.faces instanceof Uint32Array);
  assert.equal(surface.normals.length, surface.vertices.length);
  const vertices = surface.vertices.length / 3, faces = surface.faces.length / 3;
  assert.equal(vertices - faces / 2, 2);  // Euler's, of a sphere: edges are 3/2 of the faces
  assert.ok(surface.faces.every((v) => v < vertices));
});

test('measures are those of the surface, and it has come to rest', async () => {
  const { measures, converged, vertices, faces } = await extract(balls(), kDims, { ...kOptions, maxIterations: 1000 });
  assert.equal(converged, true);
  assert.deepEqual([measures.components, measures.euler, measures.genus], [1, 2, 0]);
  const p = (v) => [0, 1, 2].map((k) => vertices[3 * v + k]);
  let volume = 0;
  for (let f = 0; f < faces.length; f += 3) {
    const [a, b, c] = [p(faces[f]), p(faces[f + 1]), p(faces[f + 2])];
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6;
  }
  assert.ok(Math.abs(volume - measures.volume) < 1e-3 * volume);
  assert.ok(measures.area ** 3 > 36 * Math.PI * measures.volume ** 2);  // no less than a ball's
  assert.equal((await extract(balls(), kDims, { ...kOptions, maxIterations: 3 })).converged, false);
});

test('previews are surfaces on the way, and change nothing', async () => {
  const told = [];
  const surface = await extract(balls(), kDims, { ...kOptions, previewInterval: 0, preview: (p) => told.push(p) });
  assert.equal(surface.hash, kHash);
  assert.ok(told.length > 3);
  for (const { vertices, faces } of told) {
    assert.ok(vertices instanceof Float32Array && faces instanceof Uint32Array);
    assert.equal(vertices.length / 3 - faces.length / 6, 2);
  }
  assert.ok(told.at(-1).vertices.length > told[0].vertices.length);
});

test('what listens to previews may throw, and ends the extraction', async () => {
  const wrong = new Error('of the listener');
  await assert.rejects(extract(balls(), kDims, { ...kOptions, preview: () => { throw wrong; } }), wrong);
});

test('a host gives the engine and the worker itself', async () => {
  const engine = await WebAssembly.compile(await readFile(path.join(folder, 'pellicle.wasm')));
  let started = 0;
  const worker = () => {
    ++started;
    return new Worker(path.join(folder, 'worker.mjs'));
  };
  for (let run = 1; run <= 2; ++run) assert.equal((await extract(balls(), kDims, { ...kOptions, engine, worker })).hash, kHash);
  assert.equal(started, 2);
});

test('progress is told after every iteration and never falls', async () => {
  const told = [];
  await extract(balls(), kDims, { ...kOptions, progress: (p) => told.push(p) });
  assert.ok(told.length > 10);
  assert.deepEqual([told[0].level, told[0].iteration], [1, 1]);
  assert.equal(told.at(-1).level, 0);
  told.reduce((before, p) => (assert.ok(p.fraction >= before), p.fraction), 0);
});

test('an extraction is cancelled before it starts and in its midst', async () => {
  const stop = new AbortController();
  const reason = new Error('enough');
  const running = extract(balls(), kDims, { ...kOptions, signal: stop.signal, progress: () => stop.abort(reason) });
  await assert.rejects(running, reason);
  await assert.rejects(extract(balls(), kDims, { ...kOptions, signal: stop.signal }), reason);
});

test('what listens to progress may throw, and ends the extraction', async () => {
  const wrong = new Error('of the listener');
  await assert.rejects(extract(balls(), kDims, { ...kOptions, progress: () => { throw wrong; } }), wrong);
});

test('several extractions at a time do not disturb each other', async () => {
  const all = await Promise.all([1, 2, 3].map(() => extract(balls(), kDims, kOptions)));
  for (const surface of all) assert.equal(surface.hash, kHash);
});

const refusals = [
  [[balls(), kDims, { ...kOptions, iso: 5000 }], /iso/],
  [[balls(), kDims, { ...kOptions, curvatur: 1 }], /^curvatur: no such option$/],
  [[balls(), kDims, { ...kOptions, mesh: 'fine' }], /^mesh: cannot be "fine"$/],
  [[balls(), kDims, { ...kOptions, space: 'mni' }], /^space: must be one of lps, ras, voxel$/],
  [[balls(), kDims, { ...kOptions, spacing: [1, 2] }], /^spacing: must be 3 numbers$/],
  [[balls(), [44, 36, 31], kOptions], /^voxels: 50688, but dims are 44 x 36 x 31$/],
  [[Array.from(balls()), kDims, kOptions], /^voxels: must be a Uint8Array/],
  [[balls(), kDims, { ...kOptions, reduction: 9 }], /reduction/],
];
for (const [call, message] of refusals) {
  test(`refused in one line: ${message}`, async () => {
    await assert.rejects(extract(...call), (error) => {
      assert.ok(error instanceof PellicleError);
      assert.equal(error.status, 'invalid-argument');
      assert.match(error.message, message);
      assert.ok(!error.message.includes('\n'));
      return true;
    });
  });
}

test('a uniform mesh is asked for by its word', async () => {
  const surface = await extract(balls(), kDims, { ...kOptions, mesh: 'uniform' });
  assert.notEqual(surface.hash, kHash);
});
