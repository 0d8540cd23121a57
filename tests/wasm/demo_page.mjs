// The page of tools/wasm/demo in a headless Chromium.
//   node demo_page.mjs NPM_FOLDER CHROMIUM PELLICLE PAGE FOLDER        run by test_demo.sh
import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';
import * as pages from '../tools/pages.mjs';
import { check, seen, settled } from '../tools/pages.mjs';

const [npm, chromium, pellicle, path, folder] = process.argv.slice(2);
const inFolder = (name) => join(folder, name);
const command = (...words) => execFileSync(pellicle, words, { cwd: folder, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] });
const infoOf = (name) => JSON.parse(command('info', name, '--json'));

// ---- files

const DIMS = [40, 34, 30];
function ball(x, y, z) {
  return Math.round(1000 - 5 * Math.hypot(x - 19, y - 16, (z - 14) * 1.2) ** 2);
}
const IDENTITY = [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0];  // of a NIfTI file, to RAS

// version 1 or 2. value: of a voxel, as it is stored.
function nifti({ version = 1, big = false, type = 'i16', slope = 0, intercept = 0, sform = null, qform = null, units = 2, pixdim = [1, 1, 1, 1], value = ball }) {
  const wide = version === 2;
  const [code, bits, put] = { i16: [4, 16, 'setInt16'], i8: [256, 8, 'setInt8'], f64: [64, 64, 'setFloat64'], u32: [768, 32, 'setUint32'], f32: [16, 32, 'setFloat32'] }[type];
  const offset = wide ? 544 : 352;
  const view = new DataView(new ArrayBuffer(offset + (DIMS[0] * DIMS[1] * DIMS[2] * bits) / 8));
  const little = !big;
  const real = (at, x) => (wide ? view.setFloat64(at, x, little) : view.setFloat32(at, x, little));
  const reals = (at, all) => all.forEach((x, i) => real(at + i * (wide ? 8 : 4), x));
  const code_ = (at, x) => (wide ? view.setInt32(at, x, little) : view.setInt16(at, x, little));
  view.setInt32(0, wide ? 540 : 348, little);
  [3, ...DIMS, 1, 1, 1, 1].forEach((n, i) => (wide ? view.setBigInt64(16 + 8 * i, BigInt(n), little) : view.setInt16(40 + 2 * i, n, little)));
  const at = wide ? { magic: 4, type: 12, bits: 14, pixdim: 104, offset: 168, slope: 176, units: 500, qcode: 344, scode: 348, q: 352, s: 400 }
    : { magic: 344, type: 70, bits: 72, pixdim: 76, offset: 108, slope: 112, units: 123, qcode: 252, scode: 254, q: 256, s: 280 };
  [...(wide ? 'n+2\0' : 'n+1\0')].forEach((c, i) => view.setUint8(at.magic + i, c.charCodeAt(0)));
  view.setInt16(at.type, code, little);
  view.setInt16(at.bits, bits, little);
  reals(at.pixdim, pixdim);
  if (wide) view.setBigInt64(at.offset, BigInt(offset), little);
  else view.setFloat32(at.offset, offset, little);
  reals(at.slope, [slope, intercept]);
  if (wide) view.setInt32(at.units, units, little);
  else view.setUint8(at.units, units);
  code_(at.qcode, qform ? 1 : 0);
  code_(at.scode, sform ? 1 : 0);
  if (qform) reals(at.q, qform);
  if (sform) reals(at.s, sform);
  let to = offset;
  for (let z = 0; z < DIMS[2]; ++z) {
    for (let y = 0; y < DIMS[1]; ++y) {
      for (let x = 0; x < DIMS[0]; ++x, to += bits / 8) view[put](to, value(x, y, z), little);
    }
  }
  return Buffer.from(view.buffer);
}

const oblique = [-0.9, 0.2, 0.05, 31, 0.25, -1.1, 0.1, -20, 0, 0.15, 1.4, 90];
const plain = nifti({ sform: IDENTITY });
const good = {
  'oblique.nii.gz': gzipSync(nifti({ sform: oblique, qform: [0, 0, 0, 1, 2, 3] })),
  'turned.nii': nifti({ qform: [0.1, -0.2, 0.3, 5, -6, 7], pixdim: [-1, 0.8, 0.9, 1.5], big: true }),
  'placeless.nii': nifti({ version: 2, type: 'f64', slope: 0.25, intercept: 3, pixdim: [1, 2, 2, 2] }),
  'microns.nii.gz': gzipSync(nifti({ type: 'i8', units: 3, sform: [-500, 0, 0, 10, 0, -500, 0, 10, 0, 0, 500, 10], value: (x, y, z) => Math.max(ball(x, y, z) / 10, -100) })),
  'unsigned.nii': nifti({ type: 'u32', sform: IDENTITY, value: (x, y, z) => Math.max(ball(x, y, z), 0) }),
  'packed.nrrd': Buffer.concat([
    Buffer.from(`NRRD0005\n# a comment\ntype: short\ndimension: 3\nspace: RAS\nsizes: ${DIMS.join(' ')}\nspace directions: (0.9,0,0.1) (0,1.1,0) (0,0,1.3)\nkey:=value: no field\nencoding: gzip\nendian: big\nspace origin: (5,-6,7)\n\n`),
    gzipSync(nifti({ big: true }).subarray(352)),
  ]),
  'spaced.nrrd': Buffer.concat([
    Buffer.from(`NRRD0001\r\ntype: unsigned char\r\ndimension: 3\r\nsizes: ${DIMS.join(' ')}\r\nspacings: 0.5 0.75 1\r\nencoding: raw\r\n\r\n`),
    Buffer.from(Array.from({ length: DIMS[0] * DIMS[1] * DIMS[2] }, (_, i) => Math.max(ball(i % 40, Math.floor(i / 40) % 34, Math.floor(i / 1360)) / 4, 0))),
  ]),
};
const packed = gzipSync(plain);
const header = (more) => Buffer.from(`NRRD0004\ntype: ${more.type ?? 'short'}\ndimension: 3\nsizes: ${more.sizes ?? '9 9 9'}\nencoding: ${more.encoding ?? 'raw'}\n${more.line ?? ''}\n`);
const damagedMiddle = Buffer.from(packed);
damagedMiddle.fill(0x55, packed.length >> 1, (packed.length >> 1) + 40);
const wrongMagic = Buffer.from(plain);
wrongMagic.write('nope', 344);
const nan = nifti({ type: 'f32', sform: IDENTITY, value: (x, y, z) => (x + y + z === 9 ? NaN : x) });
const bad = [
  ['words.txt', Buffer.from('no image'), 'words.txt: is neither NIfTI (.nii, .nii.gz) nor NRRD (.nrrd)'],
  ['empty.nii', Buffer.alloc(0), 'empty.nii: is neither NIfTI'],
  ['short.nii', plain.subarray(0, 5000), 'short.nii: is truncated (4648 bytes of voxels, 81600 are needed)'],
  ['short.nii.gz', packed.subarray(0, packed.length >> 1), 'short.nii.gz: is truncated or damaged (its gzip stream is not whole)'],
  ['damaged.nii.gz', damagedMiddle, 'damaged.nii.gz: is truncated or damaged (its gzip stream is not whole)'],
  ['nope.nii', wrongMagic, 'nope.nii: is not a readable NIfTI file'],
  ['nan.nii', nan, 'nan.nii: has voxels that are NaN or infinite'],
  ['flat.nii', nifti({ sform: IDENTITY, value: () => 7 }), 'flat.nii: all its voxels have the value 7'],
  ['endless.nrrd', Buffer.from('NRRD0004\ntype: short\n'), 'endless.nrrd: is not a readable NRRD file (its header does not end)'],
  ['typeless.nrrd', Buffer.from('NRRD0004\ndimension: 3\n\n'), 'typeless.nrrd: is not a readable NRRD file (it has no "type")'],
  ['block.nrrd', header({ type: 'block' }), 'block.nrrd: has voxels of a type that is not supported (block)'],
  ['bzip.nrrd', header({ encoding: 'bzip2' }), 'bzip.nrrd: has the encoding bzip2, which is not supported here'],
  ['apart.nrrd', header({ line: 'data file: a.raw\n' }), 'apart.nrrd: has its voxels in another file'],
  ['plane.nrrd', header({ sizes: '9 9' }), 'plane.nrrd: is 2-D; a 3-D volume is needed'],
  ['thin.nrrd', header({ sizes: '9 9 1' }), 'thin.nrrd: is not a volume (9 x 9 x 1 voxels'],
  ['huge.nrrd', header({ sizes: '4000 4000 4000' }), 'huge.nrrd: has 4000 x 4000 x 4000 voxels, 128.0 GB: more than the 2.1 GB that a page can hold'],
  ['short.nrrd', Buffer.concat([header({}), Buffer.alloc(99)]), 'short.nrrd: is truncated (99 bytes of voxels, 1458 are needed)'],
];

// ---- the page

const textOf = (page, id) => page.$eval(`#${id}`, (element) => element.textContent);
const resultOf = (page) => page.evaluate(() => Object.fromEntries([...document.querySelectorAll('#result dd')].map((dd) => [dd.dataset.result, dd.textContent])));
const choose = (page, id, value) => page.$eval(`#${id}`, (element, to) => {
  element.value = to;
  element.dispatchEvent(new Event('change'));
}, String(value));

async function drop(page, name) {
  const before = await page.evaluate(() => { document.getElementById('line').textContent = ''; return window.pellicle.state.image; });
  await (await page.$('#file')).uploadFile(inFolder(name));
  await page.waitForFunction((image) => document.getElementById('line').textContent !== '' || (window.pellicle.state.image && JSON.stringify(window.pellicle.state.image) !== image), {}, JSON.stringify(before));
  await settled(page);
}

async function extract(page) {
  await page.click('#start');
  await page.waitForFunction(() => document.getElementById('cancel').hidden, { timeout: 240000 });
  await settled(page);
}

// The hash in the page is that of the command, with the words that the page gives for it.
async function sameAsCommand(page, what, name) {
  check(`${what}: no complaint`, (await textOf(page, 'line')) === '', await textOf(page, 'line'));
  const line = await textOf(page, 'command');
  check(`${what}: the command line names the file`, line.startsWith(`pellicle extract ${name} `), line);
  command(...line.split(' ').slice(1), '--report', 'report.json', '--quiet');
  const report = JSON.parse(readFileSync(inFolder('report.json'), 'utf8'));
  const result = await resultOf(page);
  check(`${what}: the hash`, result.hash === report.hash && result.hash.length === 16, `${result.hash}, not ${report.hash} of ${line}`);
  return { result, report };
}
const numberOf = (text) => Number(text.replaceAll(',', '').split(' ')[0]);

await pages.start(npm, chromium);
for (const [name, bytes] of [...Object.entries(good), ...bad]) writeFileSync(inFolder(name), bytes);
const page = await pages.opened(path);
const session = await page.createCDPSession();
await session.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: inFolder('out') });

// Bad files before there is any image.
for (const [name, , line] of bad) {
  await drop(page, name);
  const told = await textOf(page, 'line');
  check(`${name}: one line`, told.startsWith(line) && !told.includes('\n'), `"${told}"`);
  check(`${name}: nothing is shown`, await page.$eval('#extract-panel', (panel) => panel.hidden));
}

// The chain phantom: Otsu's threshold, the result, the views, the downloads.
{
  await drop(page, 'chain.nrrd');
  const told = Number(await page.$eval('#iso', (input) => input.value));
  check('Otsu\'s threshold', told === infoOf('chain.nrrd').otsu, `${told}, not ${infoOf('chain.nrrd').otsu}`);
  for (const view of ['Axial', 'Sagittal', 'Coronal']) check(`${view} is not empty`, (await seen(page, view, '.stage')).colours > 40);
  const before = { space: await seen(page, '3D'), axial: await seen(page, 'Axial') };
  await extract(page);
  const { result, report } = await sameAsCommand(page, 'chain.nrrd', 'chain.nrrd');
  check('the surface is seen in space', (await seen(page, '3D')).sum !== before.space.sum && (await seen(page, '3D', '.stage')).colours > 40);
  check('the surface is seen in slices', (await seen(page, 'Axial')).sum !== before.axial.sum);
  check('one surface is left', (await page.evaluate(() => window.pellicle.state.surfaces.length)) === 1);
  const [surface] = [report.surface ?? report];
  const shown = [numberOf(result.vertices), numberOf(result.components), result['at rest'].startsWith('yes')];
  check('the measures', shown.join() === [surface.vertices ?? report.vertices, 2, true].join(), JSON.stringify(result));

  for (const format of ['ply', 'stl', 'glb']) {
    await page.click(`[data-format="${format}"]`);
    const name = () => readdirSync(inFolder('out')).find((file) => file.endsWith(`.${format}`));
    for (let tries = 0; !name() && tries < 100; ++tries) await new Promise((done) => { setTimeout(done, 50); });
    const file = `out/${name()}`;
    check(`${format}: downloaded`, name() !== undefined);
    if (format === 'glb') {
      command('mesh', 'surface.ply', '-o', 'expected.glb');
      const [theirs, ours] = ['expected.glb', file].map((f) => readFileSync(inFolder(f)));
      const block = (glb) => glb.subarray(20 + glb.readUInt32LE(12));
      const json = (glb) => JSON.stringify(JSON.parse(glb.subarray(20, 20 + glb.readUInt32LE(12)).toString()));
      check('glb: its arrays are those of the command\'s', block(ours).equals(block(theirs)));
      check('glb: its description is that of the command\'s', json(ours).length > 100 && JSON.parse(json(ours)).accessors[0].count === JSON.parse(json(theirs)).accessors[0].count);
      check('glb: its size is what it says', ours.readUInt32LE(8) === ours.length);
    } else {
      command('extract', 'chain.nrrd', '--iso', String(told), '-o', `expected.${format}`, '--quiet');
      check(`${format}: the bytes of the command's`, readFileSync(inFolder(file)).equals(readFileSync(inFolder(`expected.${format}`))));
      command('check', file);
    }
  }
}

// Every kind of file lies where the command has it, and has its values.
for (const name of Object.keys(good)) {
  await drop(page, name);
  const theirs = infoOf(name);
  const ours = await page.evaluate(() => window.pellicle.state.image);
  const matrix = theirs.direction.map((x, i) => x * theirs.spacing[i % 3]);
  const far = Math.max(...[...ours.matrix.map((x, i) => x - matrix[i]), ...ours.origin.map((x, i) => x - theirs.origin[i])].map(Math.abs));
  check(`${name}: its place`, far < 1e-5, `${JSON.stringify(ours.matrix)} ${ours.origin}, not ${JSON.stringify(matrix)} ${theirs.origin}`);
  const otsu = Number(await page.$eval('#iso', (input) => input.value));
  check(`${name}: its values`, otsu === theirs.otsu, `${otsu}, not ${theirs.otsu}`);
  await extract(page);
  await sameAsCommand(page, name, name);
}

// What can be chosen: the value by hand, darker objects, uniform meshes, levels, a part of the image.
{
  await drop(page, 'oblique.nii.gz');
  const box = await (await page.$('#histogram')).boundingBox();
  const before = await page.$eval('#iso', (input) => input.value);
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.9 * box.width, box.y + 30, { steps: 4 });
  await page.mouse.up();
  const dragged = await page.$eval('#iso', (input) => input.value);
  check('the value is dragged', dragged !== before && Number(dragged) > Number(before), `${before} ${dragged}`);
  await page.focus('#histogram');
  await page.keyboard.press('ArrowLeft');
  check('the value is moved by keys', Number(await page.$eval('#iso', (input) => input.value)) < Number(dragged));
  await page.click('#otsu');
  check('back to Otsu\'s', (await page.$eval('#iso', (input) => input.value)) === before);
  await choose(page, 'iso', -300.5);
  await choose(page, 'inside', 'below');
  await choose(page, 'levels', 1);
  await extract(page);
  check('a dark object is in the command line', /--iso=-300\.5 --inside below --levels 1/.test(await textOf(page, 'command')), await textOf(page, 'command'));
  await sameAsCommand(page, 'a dark object', 'oblique.nii.gz');
  await choose(page, 'iso', 600);
  await choose(page, 'inside', 'above');
  await choose(page, 'levels', -1);
  await choose(page, 'mesh', 'uniform');
  await extract(page);
  await sameAsCommand(page, 'a uniform mesh', 'oblique.nii.gz');
  check('surfaces are kept beside each other', (await page.evaluate(() => window.pellicle.state.surfaces.length)) === 2);
  await choose(page, 'iso', 5000);
  check('the value stays in the range', (await page.$eval('#iso', (input) => input.value)) === '1000');
}

// A crop of the head CT, the surface as it grows, and cancelling.
if (existsSync(inFolder('head.nrrd'))) {
  await drop(page, 'head.nrrd');
  await choose(page, 'mesh', 'uniform');
  await choose(page, 'iso', 226);
  await page.click('#box-panel summary');
  for (const [end, low] of [['low', [100, 100, 40]], ['high', [155, 155, 87]]]) {
    for (const k of [0, 1, 2]) {
      await page.$eval(`[data-box="${end}-${k}"]`, (input, to) => { input.value = to; input.dispatchEvent(new Event('change')); }, String(low[k]));
    }
  }
  check('the box is told', (await textOf(page, 'box-size')).startsWith('56 x 56 x 48, 150,528 voxels'), await textOf(page, 'box-size'));
  await extract(page);
  check('the box is in the command line', (await textOf(page, 'command')).endsWith('--box 100,155,100,155,40,87'), await textOf(page, 'command'));
  const { result } = await sameAsCommand(page, 'a crop of the head', 'head.nrrd');
  const [kept] = [result.hash];
  for (const k of [0, 1, 2]) {
    await page.$eval(`[data-box="low-${k}"]`, (input) => { input.value = 0; input.dispatchEvent(new Event('change')); });
  }
  await page.evaluate(() => { window.grown = []; });
  await page.click('#start');
  await page.waitForFunction(() => {
    const last = window.pellicle.state.surfaces[1];
    if (last && !window.grown.includes(last)) window.grown.push(last);
    return window.grown.length === 3 || document.getElementById('cancel').hidden;
  }, { polling: 5, timeout: 240000 });
  const grown = await page.evaluate(() => window.grown.map((surface) => surface.vertices));
  check('the surface is seen to grow', grown.length === 3 && grown.every((n) => n > 0), grown);
  await page.click('#cancel');
  await page.waitForFunction(() => document.getElementById('cancel').hidden);
  check('it tells that it was cancelled', (await textOf(page, 'state')) === 'cancelled', await textOf(page, 'state'));
  check('a cancelled extraction leaves no surface', (await page.evaluate(() => window.pellicle.state.surfaces.length)) === 1);
  check('a cancelled extraction leaves the result', (await resultOf(page)).hash === kept);
  // A damaged file leaves the image as it is.
  await drop(page, 'short.nii');
  check('a damaged file after an image: one line', (await textOf(page, 'line')).startsWith('short.nii: is truncated'));
  check('a damaged file leaves the image', (await page.title()).startsWith('head.nrrd'));
}

// Another image in the midst of an extraction, by dropping it.
{
  await drop(page, 'chain.nrrd');
  await choose(page, 'mesh', 'adaptive');
  await page.click('#start');
  await page.waitForFunction(() => /iteration/.test(document.getElementById('state').textContent));
  const bytes = good['placeless.nii'].toString('base64');
  await page.evaluate((base64) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], 'dropped.nii'));
    document.dispatchEvent(new DragEvent('drop', { dataTransfer: data }));
  }, bytes);
  await page.waitForFunction(() => document.title.startsWith('dropped.nii'));
  await settled(page);
  const left = await page.evaluate(() => [window.pellicle.state.surfaces.length, document.getElementById('cancel').hidden, document.getElementById('line').textContent]);
  check('another image ends the extraction', left.join() === '0,true,', left);
  check('an image without a place: it is told', /says nothing of its place/.test(await textOf(page, 'notes')), await textOf(page, 'notes'));
  await choose(page, 'mesh', 'uniform');
  await extract(page);
  check('and can be extracted', (await resultOf(page)).hash.length === 16 && (await textOf(page, 'line')) === '');
}

// Too many voxels for one extraction: the middle is chosen, and more is refused.
{
  const big = header({ type: 'uchar', sizes: '640 520 512', encoding: 'gzip' });
  const voxels = Buffer.alloc(640 * 520 * 512);
  voxels.fill(200, voxels.length >> 1);
  writeFileSync(inFolder('big.nrrd'), Buffer.concat([big, gzipSync(voxels, { level: 1 })]));
  await drop(page, 'big.nrrd');
  check('a large image: what is done is told', /^big\.nrrd: has 640 x 520 x 512 voxels, more than the 134,217,728 .* its middle has been chosen/.test(await textOf(page, 'line')), await textOf(page, 'line'));
  check('a large image: it is shown reduced', /reduced to/.test(await textOf(page, 'notes')), await textOf(page, 'notes'));
  const start = () => page.$eval('#start', (button) => button.disabled);
  check('a large image: its middle can be extracted', !(await start()));
  for (const [end, to] of [['low-0', 0], ['high-0', 639], ['low-1', 0], ['high-1', 519], ['low-2', 0], ['high-2', 511]]) {
    await page.$eval(`[data-box="${end}"]`, (input, x) => { input.value = x; input.dispatchEvent(new Event('change')); }, to);
  }
  check('a large image: all of it cannot', (await start()) && /more than/.test(await textOf(page, 'box-size')), await textOf(page, 'box-size'));
}

// Small screens.
for (const [width, height] of [[400, 800], [800, 600]]) {
  await page.setViewport({ width, height });
  await settled(page);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  check(`it fits ${width} x ${height}`, wide <= width, wide);
}

await pages.end();
console.log(pages.failures ? `${pages.failures} failures in the browser` : 'the page is as expected');
process.exit(pages.failures ? 1 : 0);
