// A page that extracts surfaces: an image is dropped on it, a value chosen, and the surface grows. Nothing
// is fetched, nothing leaves the page.
import { Frame } from '../../view/page/frame.js';
import { bindKeys, requireBrowser, show } from '../../view/page/show.js';
import { made, row } from '../../view/page/panel.js';
import { changed, nobodyListens, setCursor, state } from '../../view/page/state.js';
import { Surface } from '../../view/page/surface.js';
import { commandLine, extraction } from './extraction.js';
import { lineOf, refuse } from './failure.js';
import { greysOf } from './greys.js';
import { Histogram } from './histogram.js';
import { HistogramView } from './histogram_view.js';
import { readImage } from './image_file.js';
import { download } from './mesh_files.js';
import { countOf, cutOut, textOf } from './voxels.js';

const byId = (id) => document.getElementById(id);
const number = (x) => x.toLocaleString('en');

// Of an extraction. 2^27 floats, as a ball of 209,048 vertices, take 0.9 GB of the engine's 4 GiB, and 1.1 GB
// outside of it: the page has them, and so has the worker.
const MOST_VOXELS = 2 ** 27;

let image = null;      // what has been read
let histogram = null;
let views = {};
let running = null;    // an AbortController
let finished = null;   // {surface, stem} of the last extraction
let box = null;        // {low, high}, voxels, both within

const shown = new HistogramView(byId('histogram'), byId('iso'), () => {});

function tell(line) {
  byId('line').textContent = line ?? '';
  byId('line').hidden = !line;
}
function tellState(line) {
  byId('state').textContent = line ?? '';
  byId('state').hidden = !line;
}

// ---- the image

function wholeBox() {
  return { low: [0, 0, 0], high: image.dims.map((n) => n - 1) };
}
// As much of the middle as can be extracted at once, in the proportions of the image.
function middleBox() {
  const part = Math.min(Math.cbrt(MOST_VOXELS / countOf(image.dims)), 1);
  const dims = image.dims.map((n) => Math.max(Math.floor(n * part), 2));
  const low = image.dims.map((n, k) => Math.floor((n - dims[k]) / 2));
  return { low, high: low.map((x, k) => x + dims[k] - 1) };
}
const boxDims = () => box.high.map((x, k) => x - box.low[k] + 1);
const isWhole = () => boxDims().every((n, k) => n === image.dims[k]);

function tellBox() {
  const count = countOf(boxDims());
  const few = count > MOST_VOXELS ? `: more than the ${number(MOST_VOXELS)} that can be extracted here at a time` : '';
  byId('box-size').textContent = `${textOf(boxDims())}, ${number(count)} voxels${few}`;
  byId('start').disabled = few !== '';
}

function boxRows() {
  const rows = ['x', 'y', 'z'].map((name, k) => {
    const ends = ['low', 'high'].map((end) => {
      const input = made('input', { type: 'number', min: 0, max: image.dims[k] - 1, step: 1, value: box[end][k], ariaLabel: `${end === 'low' ? 'First' : 'Last'} voxel along ${name}` });
      input.dataset.box = `${end}-${k}`;
      input.addEventListener('change', () => {
        const [least, most] = end === 'low' ? [0, box.high[k] - 1] : [box.low[k] + 1, image.dims[k] - 1];
        if (Number.isFinite(input.valueAsNumber)) box[end][k] = Math.min(Math.max(Math.round(input.valueAsNumber), least), most);
        input.value = box[end][k];
        tellBox();
      });
      return input;
    });
    return row(made('span', { className: 'label', textContent: name }), ends[0], made('span', { textContent: 'to' }), ends[1]);
  });
  byId('box').replaceChildren(...rows);
  tellBox();
}

function notesOf(grey) {
  const notes = [...(image.notes ?? [])];
  if (grey.reduction.some((f) => f > 1)) notes.push(`The image is shown reduced to ${textOf(grey.grid)} voxels, each the mean of ${textOf(grey.reduction)}; it is extracted as it is`);
  if (!grey.exact) notes.push(`Values ${grey.window.map((x) => Number(x.toPrecision(5))).join(' .. ')} are shown in 256 greys; it is extracted as it is`);
  return notes;
}

function showImage() {
  Object.values(views).forEach((view) => view.dispose());
  nobodyListens();
  byId('drop').hidden = true;
  finished = null;
  byId('result-panel').hidden = true;
  const { greys, image: grey } = greysOf(image, histogram);
  Object.assign(state, { image: grey, greys, frame: new Frame(grey), surfaces: [], distances: [], picked: null });
  for (const id of ['point-panel', 'image-panel', 'distance-panel', 'note-panel', 'extract-panel']) byId(id).hidden = false;
  views = show(notesOf(grey));
  document.title = `${image.name} – Pellicle`;
  byId('title').textContent = image.name;
  byId('file-name').textContent = `${textOf(image.dims)} voxels`;
  shown.show(histogram, histogram.otsu());
  box = wholeBox();
  if (countOf(image.dims) > MOST_VOXELS) {
    box = middleBox();
    byId('box-panel').open = true;
    tell(`${image.name}: has ${textOf(image.dims)} voxels, more than the ${number(MOST_VOXELS)} that can be extracted here at a time: its middle has been chosen, take another part where you like; the command pellicle takes all of it`);
  }
  boxRows();
}

async function open(file) {
  if (!file) return;
  running?.abort();
  tell();
  byId('file-name').textContent = `reading ${file.name}`;
  try {
    const read = await readImage(file);
    const values = new Histogram(read.voxels);
    if (!(values.low < values.high)) refuse(`${file.name}: all its voxels have the value ${values.low}`);
    [image, histogram] = [read, values];
    showImage();
  } catch (error) {
    byId('file-name').textContent = image ? `${textOf(image.dims)} voxels` : 'NIfTI or NRRD, or drop it';
    tell(lineOf(error));
  }
}

// ---- the surface

function surfaceOf({ vertices, faces }, name) {
  const { middle } = state.image;
  const points = vertices.map((x, i) => x - middle[i % 3]);
  return new Surface(state.surfaces.length, { name, vertices: vertices.length / 3, faces: faces.length / 3, values: [] }, points, faces, [], state.frame.planes);
}

// What is growing, in place of what it was before. The last of those that come while one is drawn is taken.
function previews(name) {
  const before = [...state.surfaces];
  let next = null;
  let ended = false;
  const draw = () => {
    const begin = performance.now();
    const triangles = next;
    next = null;
    if (ended || !triangles) return;
    state.surfaces = before;
    const surface = surfaceOf(triangles, name);
    state.surfaces = [...before, surface];
    changed('surfaces');
    // The page stays responsive: it draws for no more than a third of the time.
    requestAnimationFrame(() => setTimeout(() => { busy = false; if (next) ask(); }, 2 * (performance.now() - begin)));
  };
  let busy = false;
  const ask = () => {
    if (busy) return;
    busy = true;
    setTimeout(draw);
  };
  return {
    take: (triangles) => { next = triangles; ask(); },
    end: () => {
      ended = true;
      state.surfaces = before;
    },
  };
}

function setRunning(on) {
  for (const id of ['iso', 'otsu', 'inside', 'mesh', 'levels', 'open']) byId(id).disabled = on;
  for (const input of byId('box').querySelectorAll('input')) input.disabled = on;
  byId('histogram').toggleAttribute('data-off', on);
  byId('start').hidden = on;
  byId('cancel').hidden = !on;
  byId('progress').hidden = !on;
  byId('progress').value = 0;
}

function showResult(surface, choices, seconds) {
  const { measures } = surface;
  const rows = [
    ['Vertices', number(surface.vertices.length / 3)],
    ['Faces', number(surface.faces.length / 3)],
    ['Components', number(measures.components)],
    ['Genus', number(measures.genus)],
    ['Area', `${number(Number(measures.area.toPrecision(7)))} mm²`],
    ['Volume', `${number(Number(measures.volume.toPrecision(7)))} mm³`],
    ['At rest', surface.converged ? 'yes, it has converged' : 'no: iterations were at an end before'],
    ['Hash', surface.hash],
    ['Time', `${seconds.toFixed(1)} s, ${surface.simd}`],
  ];
  byId('result').replaceChildren(...rows.flatMap(([name, value]) => {
    const told = made('dd', { textContent: value });
    told.dataset.result = name.toLowerCase();
    return [made('dt', { textContent: name }), told];
  }));
  byId('command').textContent = commandLine(image.name, choices, isWhole() ? null : box);
  byId('result-panel').hidden = false;
}

async function start() {
  const choices = { iso: shown.value, below: byId('inside').value === 'below', mesh: byId('mesh').value, levels: Number(byId('levels').value) };
  const name = `${image.name.replace(/\.(nii|nii\.gz|nrrd)$/i, '')} ${choices.iso}`;
  const growing = previews(name);
  running = new AbortController();
  const { signal } = running;
  const begin = performance.now();
  tell();
  tellState('starting');
  setRunning(true);
  try {
    const surface = await extraction(cutOut(image, box.low, box.high), choices, signal, {
      preview: growing.take,
      progress: (p) => {
        byId('progress').value = p.fraction;
        tellState(`level ${p.level}, iteration ${p.iteration}: ${number(p.vertices)} vertices`);
      },
      log: (level, line) => { if (level === 'warning') tell(line); },
    });
    growing.end();
    if (signal.aborted) return;
    state.surfaces = [...state.surfaces, surfaceOf(surface, name)];
    finished = { surface, stem: name.replaceAll(' ', '-') };
    showResult(surface, choices, (performance.now() - begin) / 1000);
    tellState();
  } catch (error) {
    growing.end();
    tellState(signal.aborted ? 'cancelled' : '');
    if (!signal.aborted) tell(lineOf(error));
  } finally {
    running = null;
    setRunning(false);
    tellBox();
    changed('list', 'surfaces');
  }
}

// ---- the page

function bind() {
  const drop = made('div', { id: 'drop' }, made('b', { textContent: 'Drop a NIfTI or NRRD image here' }), 'It is read by this page and goes nowhere else.');
  byId('views').append(drop);
  for (const target of [byId('open'), drop]) target.addEventListener('click', () => byId('file').click());
  byId('file').addEventListener('change', () => {
    open(byId('file').files[0]);
    byId('file').value = '';
  });
  document.addEventListener('dragover', (event) => {
    event.preventDefault();
    document.body.classList.add('dropping');
  });
  document.addEventListener('dragleave', () => document.body.classList.remove('dropping'));
  document.addEventListener('drop', (event) => {
    event.preventDefault();
    document.body.classList.remove('dropping');
    open(event.dataTransfer.files[0]);
  });
  byId('otsu').addEventListener('click', () => shown.set(histogram.otsu()));
  byId('inside').addEventListener('change', () => shown.setBelow(byId('inside').value === 'below'));
  byId('start').addEventListener('click', start);
  byId('cancel').addEventListener('click', () => running?.abort());
  for (const button of document.querySelectorAll('[data-format]')) {
    button.addEventListener('click', () => download(finished.surface, button.dataset.format, finished.stem));
  }
}

try {
  requireBrowser();
  bindKeys(() => views);
  bind();
  document.title = 'Pellicle';
  byId('title').textContent = 'Pellicle: surfaces from 3D images';
  for (const id of ['point-panel', 'surface-panel', 'image-panel', 'distance-panel', 'note-panel']) byId(id).hidden = true;
  // For tests, and for whoever opens the browser's console.
  window.pellicle = { state, setCursor, get views() { return views; } };
} catch (error) {
  byId('failure').hidden = false;
  byId('failure').textContent = error.message;
}
