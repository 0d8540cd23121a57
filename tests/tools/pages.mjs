// Pages in a headless Chromium: nothing is fetched, nothing is complained of, and what is seen.
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';

export let failures = 0;
export function check(what, holds, found = '') {
  if (holds) return;
  console.log(`FAILED: ${what} ${found}`);
  ++failures;
}

let browser = null;
export async function start(npm, chromium) {
  const puppeteer = createRequire(join(npm, 'package.json'))('puppeteer-core');
  browser = await puppeteer.launch({
    executablePath: chromium,
    // Without the last two there is no WebGL, and nothing would be tested.
    args: ['--no-sandbox', '--headless=new', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
    protocolTimeout: 300000,
  });
}
export const end = () => browser.close();

export async function opened(path) {
  const page = await browser.newPage();
  await page.setViewport({ width: 1100, height: 760 });
  const url = pathToFileURL(path).href;
  page.on('request', (request) => check(`${path} fetches`, request.url() === url || /^(data|blob):/.test(request.url()), request.url()));
  page.on('console', (message) => check(`${path} says`, false, message.text()));
  page.on('pageerror', (error) => check(`${path} fails`, false, error.message));
  await page.goto(url);
  await page.evaluate(() => Promise.resolve(window.pellicle).then(() => null));
  await settled(page);
  return page;
}
export const settled = (page) => page.evaluate(() => new Promise((done) => { requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))); }));

// What is seen of a view: [colours, pixels that are not as the first one], by the browser's decoder.
export async function seen(page, view, part = '') {
  const element = await page.$(`[data-view="${view}"] ${part}`.trim());
  const picture = await element.screenshot({ encoding: 'base64' });
  const reader = await browser.newPage();
  const result = await reader.evaluate(async (base64) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: 'image/png' }));
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const pixels = new Uint32Array(context.getImageData(0, 0, bitmap.width, bitmap.height).data.buffer);
    return { colours: new Set(pixels).size, drawn: pixels.filter((p) => p !== pixels[0]).length, sum: pixels.reduce((s, p) => (s * 31 + p) % 4294967291, 7) };
  }, picture);
  await reader.close();
  return result;
}
