// The page of `pellicle view`. What it shows stands before this script in the page: arrays, and the
// scene that tells what they are.
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkImageData from '@kitware/vtk.js/Common/DataModel/ImageData';
import { Frame } from './frame.js';
import { buildPanel, startWindow } from './panel.js';
import { SliceView } from './slice_view.js';
import { SpaceView } from './space_view.js';
import { changed, listen, setCursor, setTool, state } from './state.js';
import { Surface } from './surface.js';
import { column, unit } from './vectors.js';
import { floatsOf, greysOf, indicesOf } from './unpack.js';

const byId = (id) => document.getElementById(id);

async function loadedSurface(told, number) {
  const points = await floatsOf(told.points);
  const corners = await indicesOf(told.corners);
  const arrays = [];
  for (const value of told.values) arrays.push(await floatsOf(value.array));
  return new Surface(number, told, points, corners, arrays, state.frame.planes);
}

function imageData() {
  const { frame } = state;
  const axes = [0, 1, 2].map((k) => column(frame.matrix, k));
  const data = vtkImageData.newInstance({
    spacing: axes.map((axis) => Math.hypot(...axis)),
    origin: frame.first,
    direction: axes.flatMap(unit),
  });
  data.setDimensions(...frame.grid);
  data.getPointData().setScalars(vtkDataArray.newInstance({ name: 'Greys', values: state.greys, numberOfComponents: 1 }));
  return data;
}

function setTheme(theme) {
  document.documentElement.dataset.theme = theme;
  changed('theme');
}

function keys(views) {
  const reset = () => views.forEach((view) => view.reset());
  const turn = () => setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
  byId('reset').addEventListener('click', reset);
  byId('theme').addEventListener('click', turn);
  byId('help').addEventListener('click', () => byId('help-dialog').showModal());
  const tools = { p: 'point', d: 'distance', w: 'window', m: 'pan' };
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.closest('input, select, dialog')) return;
    const key = event.key.toLowerCase();
    if (tools[key]) setTool(tools[key]);
    if (key === 'r') reset();
    if (key === 't') turn();
    if (key === '?') byId('help-dialog').showModal();
    if (key === 'escape') setTool('point');
  });
}

// A surface around another one starts so that this one is seen through it.
function clearOuter(surfaces) {
  for (const surface of surfaces) {
    if (surfaces.some((other) => surface.encloses(other))) surface.opacity = 0.3;
  }
}

async function start() {
  if (!document.createElement('canvas').getContext('webgl2')) throw new Error('This browser has no WebGL 2, or it is turned off.');
  if (typeof DecompressionStream === 'undefined') throw new Error('This browser is too old: it cannot unpack the page.');
  const told = JSON.parse(byId('scene').textContent);
  document.title = `${told.image.name} – Pellicle`;
  byId('title').textContent = [told.image.name, ...told.surfaces.map(({ name }) => name)].join('  ·  ');
  byId('version').textContent = `Pellicle ${told.version}`;
  state.image = told.image;
  state.frame = new Frame(told.image);
  state.greys = await greysOf(told.image.greys);
  for (const [number, surface] of told.surfaces.entries()) state.surfaces.push(await loadedSurface(surface, number));
  clearOuter(state.surfaces);

  const dark = window.matchMedia('(prefers-color-scheme: light)');
  setTheme(dark.matches ? 'light' : 'dark');
  dark.addEventListener('change', () => setTheme(dark.matches ? 'light' : 'dark'));
  const presets = startWindow();
  const data = imageData();
  const [axial, sagittal, coronal] = [0, 1, 2].map((number) => new SliceView(byId('views'), number, data));
  const space = new SpaceView(byId('views'), data);
  axial.root.after(space.root);
  const views = [axial, space, sagittal, coronal];
  const panel = buildPanel(told, presets);
  listen((what) => {
    panel(what);
    views.forEach((view) => view.ask());
  });
  keys(views);
  setTool('point');
  setCursor(state.frame.placeOf(state.frame.grid.map((n) => Math.floor(n / 2))));
  changed('image');
  return { state, setCursor, views: { axial, sagittal, coronal, space } };
}

// For tests, and for whoever opens the browser's console: what is shown, once it is.
window.pellicle = start();
window.pellicle.catch((error) => {
  byId('failure').hidden = false;
  byId('failure').textContent = error.message;
});
