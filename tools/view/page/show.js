// What is in `state`, on the page: three planes and space, the panel beside them, keys and themes.
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkImageData from '@kitware/vtk.js/Common/DataModel/ImageData';
import { buildPanel, startWindow } from './panel.js';
import { SliceView } from './slice_view.js';
import { SpaceView } from './space_view.js';
import { changed, listen, setCursor, setTool, state } from './state.js';
import { column, unit } from './vectors.js';

const byId = (id) => document.getElementById(id);

// What no page of ours can do without.
export function requireBrowser() {
  if (!document.createElement('canvas').getContext('webgl2')) throw new Error('This browser has no WebGL 2, or it is turned off.');
  if (typeof DecompressionStream === 'undefined') throw new Error('This browser is too old: it cannot unpack the page.');
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

// Once, before there is anything to show. views: what is shown when a key is pressed.
export function bindKeys(views) {
  const light = window.matchMedia('(prefers-color-scheme: light)');
  const follow = () => setTheme(light.matches ? 'light' : 'dark');
  follow();
  light.addEventListener('change', follow);
  const reset = () => Object.values(views()).forEach((view) => view.reset());
  const turn = () => setTheme(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark');
  byId('reset').addEventListener('click', reset);
  byId('theme').addEventListener('click', turn);
  byId('help').addEventListener('click', () => byId('help-dialog').showModal());
  for (const button of document.querySelectorAll('[data-tool]')) {
    button.addEventListener('click', () => setTool(button.dataset.tool));
  }
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

// The image, greys and surfaces of `state`, whose frame must be there. Returns the views.
export function show(notes) {
  const presets = startWindow();
  const data = imageData();
  const [axial, sagittal, coronal] = [0, 1, 2].map((number) => new SliceView(byId('views'), number, data));
  const space = new SpaceView(byId('views'), data);
  axial.root.after(space.root);
  const views = { axial, sagittal, coronal, space };
  const panel = buildPanel(notes, presets);
  listen((what) => {
    panel(what);
    Object.values(views).forEach((view) => view.ask());
  });
  setTool('point');
  setCursor(state.frame.placeOf(state.frame.grid.map((n) => Math.floor(n / 2))));
  changed('image');
  return views;
}
