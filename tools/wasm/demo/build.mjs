// Makes one HTML file of this folder, of the page of `pellicle view`, and of the npm package in PACKAGE.
//   node build.mjs PACKAGE OUT.html
import { readFileSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { deflateSync } from 'node:zlib';
import { bundled, inScript, pageAround } from '../../view/page/bundle.mjs';

const here = dirname(fileURLToPath(import.meta.url));
const [packaged, out] = process.argv.slice(2);
const { version } = JSON.parse(readFileSync(join(packaged, 'package.json'), 'utf8'));
// In a browser there is no process: what is node's alone is left out.
const inBrowser = { define: { process: 'undefined', 'import.meta.url': '""' }, external: ['node:*'], target: 'es2022' };
const worker = await bundled(join(here, '../worker.mjs'), inBrowser);
const [before, after] = await pageAround({
  script: join(here, 'main.js'),
  style: join(here, 'style.css'),
  panel: readFileSync(join(here, 'panel.html'), 'utf8'),
  policy: " 'wasm-unsafe-eval'; worker-src blob:",
  more: inBrowser,
});
const engine = deflateSync(readFileSync(join(packaged, 'pellicle.wasm')), { level: 9 }).toString('base64');
writeFileSync(out, [
  before.replace('<p id="version"></p>', `<p id="version">Pellicle ${version}</p>`),
  `<script type="text/plain" id="worker">${inScript(worker.text)}</script>\n`,
  `<script type="text/plain" id="array-0">${engine}</script>\n`,
  after,
].join(''));
