// Pages of `pellicle view` in a headless Chromium: nothing is fetched, nothing is complained of, there is
// something to see, and contours, positions, values and distances are those of the files.
//   node view_pages.mjs NPM_FOLDER CHROMIUM VIEW_CONTOURS FOLDER        run by test_view.sh
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import * as pages from './pages.mjs';
import { check, seen, settled } from './pages.mjs';

const [npm, chromium, contours, folder] = process.argv.slice(2);
await pages.start(npm, chromium);
const opened = (name) => pages.opened(join(folder, name));

function header(image) {
  const text = readFileSync(join(folder, image), 'utf8');
  const numbers = (key) => text.match(new RegExp(`^${key} = (.*)$`, 'm'))[1].trim().split(/\s+/).map(Number);
  return { dims: numbers('DimSize'), spacing: numbers('ElementSpacing'), axes: numbers('TransformMatrix'), offset: numbers('Offset') };
}
const voxels = new Int16Array(readFileSync(join(folder, 'blobs.raw')).buffer.slice(0));

// ---- contours

async function compareContours(page, name, image, files, space) {
  const planes = await page.evaluate(() => window.pellicle.then(({ state }) => state.frame.planes.map(({ axis, count }) => ({ axis, count }))));
  check(`${name}: planes along all axes`, new Set(planes.map(({ axis }) => axis)).size === 3);
  let compared = 0;
  let worst = 0;
  for (const [number, { axis, count }] of planes.entries()) {
    for (const k of [0.27, 0.5, 0.66].map((part) => Math.round(part * count))) {
      // As the page has them, in LPS.
      const theirs = await page.evaluate((which, slice) => window.pellicle.then(({ state }) => state.surfaces.map((surface) => {
        const { u, v, normal, first, step } = state.frame.planes[which];
        const { segments } = surface.contours[which].cut(slice);
        const depth = first + slice * step;
        const ends = [];
        for (let i = 0; i < segments.length; i += 2) {
          for (let c = 0; c < 3; ++c) ends.push(u[c] * segments[i] + v[c] * segments[i + 1] + normal[c] * depth + state.image.middle[c]);
        }
        return ends;
      })), number, k);
      for (const [s, file] of files.entries()) {
        const lines = execFileSync(contours, [join(folder, image), join(folder, file), space, String(axis), String(k)], { encoding: 'utf8', maxBuffer: 1 << 28 }).trim().split('\n');
        const length = Number(lines.shift());
        const ours = lines.map((line) => line.split(' ').map(Number));
        const where = `${name}, ${file}, slice ${k} along axis ${axis}`;
        check(`${where}: segments`, theirs[s].length === 6 * ours.length, `${theirs[s].length / 6} and ${ours.length}`);
        let sum = 0;
        ours.forEach((segment, i) => {
          const other = theirs[s].slice(6 * i, 6 * i + 6);
          sum += Math.hypot(other[0] - other[3], other[1] - other[4], other[2] - other[5]);
          const apart = (p, q) => Math.hypot(...[0, 1, 2].map((c) => segment[p + c] - other[q + c]));
          worst = Math.max(worst, Math.min(Math.max(apart(0, 0), apart(3, 3)), Math.max(apart(0, 3), apart(3, 0))));
        });
        check(`${where}: length`, Math.abs(sum - length) < 1e-3, `${sum} and ${length}`);
        compared += ours.length;
      }
    }
  }
  check(`${name}: ends of contours`, worst < 1e-3, `${worst} mm apart`);
  check(`${name}: contours to compare`, compared > 500, compared);
  console.log(`${name}: ${compared} segments, ends at most ${worst.toExponential(1)} mm apart`);
}

// ---- what is told of a point

const points = (page) => page.evaluate(() => Object.fromEntries([...document.querySelectorAll('#point dt')].map((dt) => [dt.textContent, dt.nextElementSibling.textContent])));
const numbersOf = (text) => text.replaceAll('−', '-').match(/-?\d+(\.\d+)?/g).map(Number);

async function clickIn(page, view, x, y) {
  const box = await (await page.$(`[data-view="${view}"]`)).boundingBox();
  await page.mouse.click(box.x + x * box.width, box.y + y * box.height);
  await settled(page);
}

// The value that is told is that of the file's voxel, which lies where it is told to be.
async function checkPoint(page, name, image) {
  const told = await points(page);
  const { dims, spacing, axes, offset } = header(image);
  const [i, j, k] = numbersOf(told.Voxel);
  const [value, half = 0.5] = numbersOf(told.Value);
  const found = voxels[(k * dims[1] + j) * dims[0] + i];
  const holds = told.Value.endsWith('or less') ? found <= value : told.Value.endsWith('or more') ? found >= value : Math.abs(value - found) <= half + 0.5;
  check(`${name}: value of voxel ${told.Voxel}`, holds, `${told.Value}, not ${found}`);
  const lps = [0, 1, 2].map((c) => offset[c] + [i, j, k].reduce((sum, index, axis) => sum + index * spacing[axis] * axes[3 * axis + c], 0));
  const apart = Math.hypot(...numbersOf(told.LPS).map((x, c) => x - lps[c]));
  check(`${name}: place of voxel ${told.Voxel}`, apart <= Math.hypot(...spacing) / 2 + 0.02, `${told.LPS}, not ${lps}`);
  return numbersOf(told.LPS);
}

// ---- the pages

{
  const page = await opened('oblique.html');
  check('its title', (await page.title()).startsWith('oblique.mhd'), await page.title());
  const names = await page.$$eval('.surface .grow', (all) => all.map((one) => one.textContent));
  check('a name that looks like HTML', names[1] === '<b>&"x', names);
  for (const view of ['Axial', 'Sagittal', 'Coronal', '3D']) {
    const { colours, drawn } = await seen(page, view, '.stage');
    check(`${view} is not empty`, colours > 40 && drawn > 5000, `${colours} colours, ${drawn} pixels`);
  }
  await compareContours(page, 'oblique.html', 'oblique.mhd', ['surface.ply', 'inner.stl'], 'lps');

  // Surfaces are seen in space and in slices; values colour them.
  const both = { space: await seen(page, '3D'), axial: await seen(page, 'Axial') };
  await page.select('.surface select', '0');
  await settled(page);
  const coloured = { space: await seen(page, '3D'), axial: await seen(page, 'Axial') };
  check('values colour the surface', coloured.space.sum !== both.space.sum);
  check('values colour the contours', coloured.axial.sum !== both.axial.sum && coloured.axial.colours > both.axial.colours);
  const arrays = await page.$$eval('.surface select option', (all) => all.map((one) => one.textContent));
  check('all values can be chosen', ['MeanCurvature', 'GaussianCurvature', 'Distance'].every((name) => arrays.includes(name)), arrays);
  for (const box of await page.$$('.surface input[type="checkbox"]')) await box.click();
  await settled(page);
  const none = { space: await seen(page, '3D'), axial: await seen(page, 'Axial') };
  check('surfaces can be hidden in space', none.space.sum !== coloured.space.sum);
  check('surfaces can be hidden in slices', none.axial.sum !== coloured.axial.sum);
  for (const box of await page.$$('.surface input[type="checkbox"]')) await box.click();

  // Points, distances.
  const from = [];
  for (const [view, x, y] of [['Axial', 0.4, 0.45], ['Coronal', 0.6, 0.5], ['Sagittal', 0.45, 0.6]]) {
    await clickIn(page, view, x, y);
    from.push(await checkPoint(page, `a click in ${view}`, 'oblique.mhd'));
  }
  await clickIn(page, 'Axial', 0.35, 0.4);
  const a = await checkPoint(page, 'a click', 'oblique.mhd');
  await clickIn(page, 'Axial', 0.6, 0.65);
  const b = await checkPoint(page, 'a click', 'oblique.mhd');
  await page.keyboard.press('d');
  await clickIn(page, 'Axial', 0.35, 0.4);
  await clickIn(page, 'Axial', 0.6, 0.65);
  const distance = numbersOf(await page.$eval('#distances', (list) => list.textContent))[0];
  check('a distance', Math.abs(distance - Math.hypot(...a.map((x, c) => x - b[c]))) < 0.03, `${distance}`);
  await page.keyboard.press('p');

  // A click on a surface in space: its point is on the surface, and its values are told.
  const middle = await page.evaluate(() => window.pellicle.then(({ state, views }) => {
    const { points } = state.surfaces[0];
    let best = null;  // the vertex nearest to the eye is not hidden
    const eye = views.space.renderer.getActiveCamera().getPosition();
    for (let i = 0; i < points.length; i += 3) {
      const p = [points[i], points[i + 1], points[i + 2]];
      const far = Math.hypot(p[0] - eye[0], p[1] - eye[1], p[2] - eye[2]);
      if (!best || far < best.far) best = { far, p };
    }
    const { x, y } = views.space.project(best.p);
    return [x / views.space.width, y / views.space.height, ...best.p.map((c, k) => c + state.image.middle[k])];
  }));
  await clickIn(page, '3D', middle[0], middle[1]);
  const picked = await points(page);
  check('a click in space takes a surface', picked.Surface === 'values' && 'Distance' in picked, JSON.stringify(picked));
  const apart = Math.hypot(...numbersOf(picked.LPS).map((x, c) => x - middle[2 + c]));
  check('a click in space takes the point', apart < 1, `${picked.LPS}, ${apart} mm apart`);

  // vtk.js would show wires.
  await page.keyboard.press('w');
  const surfaces = await page.evaluate(() => window.pellicle.then(({ views }) => views.space.surfaces.every(({ actor }) => actor.getProperty().getRepresentation() === 2)));
  check('W is a key of the page alone', surfaces && (await page.$eval('[data-tool="window"]', (button) => button.getAttribute('aria-checked'))) === 'true');
  await page.keyboard.press('p');

  // Wheel, keys, window, one view alone, theme.
  const slice = () => page.$eval('[data-view="Axial"] .where', (where) => where.textContent);
  const before = await slice();
  const box = await (await page.$('[data-view="Axial"]')).boundingBox();
  await page.mouse.move(box.x + 50, box.y + 80);
  await page.mouse.wheel({ deltaY: 120 });
  await settled(page);
  check('the wheel turns slices', (await slice()) !== before);
  await page.focus('[data-view="Axial"]');
  for (let i = 0; i < 3; ++i) await page.keyboard.press('ArrowUp');
  await settled(page);
  check('keys turn slices back', (await slice()) === before, `${await slice()}, not ${before}`);
  const dark = await seen(page, 'Axial', '.stage');
  const number = await page.$('#image input[type="number"]');
  await number.evaluate((input) => { input.value = 100; input.dispatchEvent(new Event('change')); });
  await settled(page);
  check('the level changes the picture', (await seen(page, 'Axial', '.stage')).sum !== dark.sum);
  const size = async () => (await (await page.$('[data-view="Axial"]')).boundingBox()).width;
  const small = await size();
  await page.click('[data-view="Axial"] button');
  check('a view alone is larger', (await size()) > 1.8 * small);
  await page.click('[data-view="Axial"] button');
  const theme = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  await page.click('#theme');
  check('there are two themes', (await page.evaluate(() => getComputedStyle(document.body).backgroundColor)) !== theme);
  for (const [width, height] of [[400, 800], [800, 600], [1600, 1000]]) {
    await page.setViewport({ width, height });
    await settled(page);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    check(`it fits ${width} x ${height}`, wide <= width, wide);
  }
  await page.close();
}

for (const [html, image, files, space] of [
  ['sagittal.html', 'sagittal.mhd', ['voxels.ply'], 'voxel'],
]) {
  const page = await opened(html);
  await compareContours(page, html, image, files, space);
  await clickIn(page, 'Coronal', 0.45, 0.55);
  await checkPoint(page, html, image);
  // Looked at from the front: what is further left on the screen is further to the patient's right.
  const right = numbersOf((await points(page)).LPS)[0];
  await clickIn(page, 'Coronal', 0.6, 0.55);
  check('the patient is seen from the front', numbersOf((await points(page)).LPS)[0] > right);
  await page.close();
}

// Voxels of a reduced image are means; those of the file are told.
{
  const page = await opened('reduced.html');
  const notes = await page.$eval('#notes', (list) => list.textContent);
  check('the page tells that it is reduced', /reduced to 20 x 22 x 18 voxels/.test(notes), notes);
  check('the file\'s size is told, too', /40 × 44 × 36 voxels/.test(notes), notes);
  await clickIn(page, 'Axial', 0.45, 0.55);
  const told = await points(page);
  const { dims } = header('oblique.mhd');
  const start = numbersOf(told.Voxel).map((x) => x - (x % 2));
  let sum = 0;
  for (let n = 0; n < 8; ++n) {
    sum += voxels[((start[2] + (n >> 2)) * dims[1] + start[1] + ((n >> 1) & 1)) * dims[0] + start[0] + (n & 1)];
  }
  const [value, half] = numbersOf(told.Value);
  check('the value is the mean of what it stands for', Math.abs(value - sum / 8) <= half + 0.5, `${told.Value}, not ${sum / 8}`);
  await page.close();
}

// Labels at vertices are colours without being asked for, and values of a label image are whole.
{
  const page = await opened('labels.html');
  const labels = await page.evaluate(() => window.pellicle.then(({ state, views }) => {
    const [surface] = state.surfaces;
    const contours = [...views.axial.paths.get(surface).paths.keys()];
    return { shown: surface.shown?.name, contours, colours: contours.map((label) => surface.shown.scale.colour(label).join()) };
  }));
  check('labels are shown', labels.shown === 'Label' && labels.contours.sort().join() === '3,8' && new Set(labels.colours).size === 2, JSON.stringify(labels));
  check('a label is a whole number', /^\d+$/.test((await points(page)).Value), (await points(page)).Value);
  await page.close();
}

{
  const page = await opened('alone.html');
  check('an image alone is seen', (await seen(page, 'Axial', '.stage')).colours > 40);
  await page.close();
}

await pages.end();
console.log(pages.failures ? `${pages.failures} failures in the browser` : 'the pages are as expected');
process.exit(pages.failures ? 1 : 0);
