#!/usr/bin/env node
// A picture of a page that `pellicle view` has written, by Chromium; what is made of README's:
//   tools/view/picture.mjs PAGE.html OUT.png [WIDTH HEIGHT] [STATEMENTS]
// STATEMENTS run in the page before, with `view` for what window.pellicle resolves to.
// Needs a build of the project with node (build/tools/view/npm), and chromium.
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const root = fileURLToPath(new URL('../../', import.meta.url));
const puppeteer = createRequire(`${root}build/tools/view/npm/package.json`)('puppeteer-core');
const [page, out, width = '1280', height = '800', statements = ''] = process.argv.slice(2);
if (!out) {
  console.error('usage: tools/view/picture.mjs PAGE.html OUT.png [WIDTH HEIGHT] [STATEMENTS]');
  process.exit(2);
}

const browser = await puppeteer.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--headless=new', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  protocolTimeout: 120000,
});
const tab = await browser.newPage();
await tab.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: 'dark' }]);
await tab.setViewport({ width: Number(width), height: Number(height) });
await tab.goto(`file://${resolve(page)}`);
await tab.evaluate(`window.pellicle.then((view) => { ${statements} })`);
await tab.evaluate(() => new Promise((done) => { setTimeout(done, 500); }));
await tab.screenshot({ path: out });
await browser.close();
