#!/usr/bin/env node
// A picture of the page of tools/wasm/demo while a surface grows, by Chromium; that of README.md is of
//   tools/wasm/picture.mjs build-wasm32/pellicle.html head.nrrd 226 tools/pictures/demo.png
// where tests/wasm/head_ct has made head.nrrd. It is taken in the midst of level 1.
import { createRequire } from 'node:module';
import { resolve } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';

const [page, image, iso, out] = process.argv.slice(2);
if (!out) {
  console.error('usage: tools/wasm/picture.mjs PAGE.html IMAGE ISO OUT.png');
  process.exit(2);
}
const root = fileURLToPath(new URL('../../', import.meta.url));
const puppeteer = createRequire(`${root}build-wasm32/demo/view/package.json`)('puppeteer-core');
const browser = await puppeteer.launch({
  executablePath: '/usr/bin/chromium',
  args: ['--no-sandbox', '--headless=new', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  protocolTimeout: 120000,
});
const tab = await browser.newPage();
await tab.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: 'dark' }]);
await tab.setViewport({ width: 1060, height: 680 });
await tab.goto(pathToFileURL(resolve(page)).href);
await (await tab.$('#file')).uploadFile(resolve(image));
await tab.waitForFunction(() => !document.getElementById('extract-panel').hidden);
await tab.$eval('#iso', (input, value) => {
  input.value = value;
  input.dispatchEvent(new Event('change'));
}, iso);
await tab.click('#start');
await tab.waitForFunction(() => /level 1, iteration \d\d/.test(document.getElementById('state').textContent), { timeout: 120000 });
await tab.evaluate(() => new Promise((done) => { setTimeout(done, 500); }));
await tab.screenshot({ path: out });
await browser.close();
