// The measuring of perf/wasm: in the page of tools/wasm/demo, by its worker and its engine, but without
// previews; then by the command.   node wasm.mjs ROOT CHROMIUM FOLDER RUNS COMMIT
import { spawnSync } from 'node:child_process';
import { readFileSync, readdirSync } from 'node:fs';
import { cpus } from 'node:os';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

const [root, chromium, folder, runs, commit] = process.argv.slice(2);
const IMAGES = [
  { file: 'chain.nrrd', name: 'chain phantom, 64 x 64 x 64 floats, iso 0.5', iso: 0.5, dims: [64, 64, 64], type: 'Float32Array', spacing: [1, 1, 1] },
  { file: 'head.nrrd', name: 'head CT, voxels 64 .. 191, 64 .. 191, 0 .. 107, 16 bits, iso 226', iso: 226, dims: [128, 128, 108], type: 'Int16Array', spacing: [0.9570312, 0.9570312, 1.5] },
];

const puppeteer = createRequire(join(root, 'build-wasm32/demo/view/package.json'))('puppeteer-core');
const browser = await puppeteer.launch({ executablePath: chromium, args: ['--no-sandbox', '--headless=new'], protocolTimeout: 600000 });
const page = await browser.newPage();
await page.goto(pathToFileURL(join(root, 'build-wasm32/pellicle.html')).href);

const read = (path) => readFileSync(path, 'utf8').trim();
function children(pid) {
  const all = readdirSync('/proc').filter((name) => /^\d+$/.test(name)).flatMap((name) => {
    try {
      return [[Number(name), Number(read(`/proc/${name}/stat`).replace(/^.*\) /, '').split(' ')[1])]];
    } catch { return []; }  // it has ended
  });
  const found = [pid];
  for (const parent of found) found.push(...all.filter(([, its]) => its === parent).map(([child]) => child));
  return found;
}
// Of the worker's thread, so far.
function workerSeconds() {
  for (const pid of children(browser.process().pid)) {
    for (const thread of readdirSync(`/proc/${pid}/task`)) {
      if (read(`/proc/${pid}/task/${thread}/comm`).startsWith('DedicatedWorker')) {
        return Number(read(`/proc/${pid}/task/${thread}/schedstat`).split(' ')[0]) / 1e9;
      }
    }
  }
  throw new Error('no worker is running');
}

async function inBrowser({ file, iso, dims, type, spacing }) {
  const bytes = readFileSync(join(folder, file));
  const voxels = bytes.subarray(bytes.indexOf('\n\n') + 2).toString('base64');
  const result = await page.evaluate(async (base64, kind, size, options) => {
    const decoded = (text) => Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    const inflated = async (text) => new Response(new Blob([decoded(text)]).stream().pipeThrough(new DecompressionStream('deflate'))).arrayBuffer();
    window.engine ??= await WebAssembly.compile(await inflated(document.getElementById('array-0').textContent));
    const code = URL.createObjectURL(new Blob([document.getElementById('worker').textContent]));
    window.worker = new Worker(code);
    return new Promise((resolve, reject) => {
      window.worker.onmessage = ({ data }) => {
        if (data.error) reject(new Error(data.error.message));
        if (data.result) resolve({ hash: data.result.hash, vertices: data.result.vertices.length / 3 });
      };
      window.worker.postMessage({ engine: window.engine, voxels: new globalThis[kind](decoded(base64).buffer), dims: size, options });
    });
  }, voxels, type, dims, { iso, spacing });
  const seconds = workerSeconds();
  await page.evaluate(() => window.worker.terminate());
  return { ...result, seconds };
}

function byCommand({ file, iso }, simd) {
  const words = ['extract', file, '--iso', iso, '--threads', 1, '--simd', simd, '-o', 'a.ply', '--report', 'a.json', '--quiet'].map(String);
  const ran = spawnSync('bash', ['-c', 'TIMEFORMAT="%U %S"; time "$@"', 'bash', join(root, 'build-perf/tools/pellicle'), ...words], { cwd: folder, encoding: 'utf8' });
  if (ran.status !== 0) throw new Error(ran.stderr);
  const seconds = ran.stderr.trim().split('\n').at(-1).split(' ').reduce((sum, x) => sum + Number(x), 0);
  return { hash: JSON.parse(read(join(folder, 'a.json'))).hash, seconds };
}

const rows = [];
for (const image of IMAGES) {
  const all = { wasm: [], scalar: [], sse4: [] };
  for (let run = 0; run < Number(runs); ++run) {
    all.wasm.push(await inBrowser(image));
    for (const simd of ['scalar', 'sse4']) all[simd].push(byCommand(image, simd));
  }
  const hashes = new Set(Object.values(all).flat().map(({ hash }) => hash));
  if (hashes.size !== 1) throw new Error(`${image.name}: not the same surface: ${[...hashes].join(', ')}`);
  const least = (kind) => Math.min(...all[kind].map(({ seconds }) => seconds));
  const cells = [all.wasm[0].vertices.toLocaleString('en'), [...hashes][0], ...[least('scalar'), least('sse4'), all.wasm[0].seconds, least('wasm')].map((s) => s.toFixed(2)), `${(least('wasm') / least('sse4')).toFixed(2)} x`];
  rows.push(`| ${[image.name, ...cells].join(' | ')} |`);
}
const version = await browser.version();
await browser.close();
console.log(`# WebAssembly in a browser

Of \`perf/wasm\` on ${new Date().toISOString().slice(0, 10)}, commit ${commit}, on ${cpus()[0].model}, in ${version.replace('/', ' ')}: seconds of the
processor, the least of ${runs} runs; of the command its whole process, on one thread, of the browser the
worker, whose first run is slower, as the browser compiles the engine better while it runs.

| image | vertices | hash, of all | command, scalar | command, SSE4 | browser, first run | browser | against SSE4 |
|---|---|---|---|---|---|---|---|
${rows.join('\n')}`);
