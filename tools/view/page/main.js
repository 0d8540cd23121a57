// The page of `pellicle view`. What it shows stands before this script in the page: arrays, and the
// scene that tells what they are.
import { Frame } from './frame.js';
import { bindKeys, requireBrowser, show } from './show.js';
import { setCursor, state } from './state.js';
import { Surface } from './surface.js';
import { floatsOf, greysOf, indicesOf } from './unpack.js';

const byId = (id) => document.getElementById(id);

// Packed are all x, all y, all z.
async function pointsOf(array, vertices) {
  const axes = await floatsOf(array);
  const points = new Float32Array(axes.length);
  for (let k = 0; k < 3; ++k) {
    for (let i = 0; i < vertices; ++i) points[3 * i + k] = axes[k * vertices + i];
  }
  return points;
}

async function loadedSurface(told, number) {
  const points = await pointsOf(told.points, told.vertices);
  const corners = await indicesOf(told.corners);
  const arrays = [];
  for (const value of told.values) arrays.push(await floatsOf(value.array));
  return new Surface(number, told, points, corners, arrays, state.frame.planes);
}

// A surface around another one starts so that this one is seen through it.
function clearOuter(surfaces) {
  for (const surface of surfaces) {
    if (surfaces.some((other) => surface.encloses(other))) surface.opacity = 0.3;
  }
}

async function start() {
  requireBrowser();
  const told = JSON.parse(byId('scene').textContent);
  document.title = `${told.image.name} – Pellicle`;
  byId('title').textContent = [told.image.name, ...told.surfaces.map(({ name }) => name)].join('  ·  ');
  byId('version').textContent = `Pellicle ${told.version}`;
  state.image = told.image;
  state.frame = new Frame(told.image);
  state.greys = await greysOf(told.image.greys);
  for (const [number, surface] of told.surfaces.entries()) state.surfaces.push(await loadedSurface(surface, number));
  clearOuter(state.surfaces);

  const views = show(told.notes);
  bindKeys(() => views);
  return { state, setCursor, views };
}

// For tests, and for whoever opens the browser's console: what is shown, once it is.
window.pellicle = start();
window.pellicle.catch((error) => {
  byId('failure').hidden = false;
  byId('failure').textContent = error.message;
});
