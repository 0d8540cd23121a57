// The column beside the views: what is at the cursor, surfaces, window and level, distances, notes.
import { changed, millimetres, state, text, valueOf } from './state.js';
import { length, sub } from './vectors.js';

const MANY = 3;
const byId = (id) => document.getElementById(id);

export function made(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}
export const row = (...children) => made('div', { className: 'row' }, ...children);
export const label = (words) => made('span', { className: 'label', textContent: words });

// ---- the point

function greyText(grey) {
  const { window: [low, high], range, exact } = state.image;
  const step = (high - low) / 255;
  if (exact) return text(valueOf(grey), 10);
  const value = text(valueOf(grey), step);
  if (grey === 0 && range[0] < low) return `${value} or less`;
  if (grey === 255 && range[1] > high) return `${value} or more`;
  return `${value} ± ${text(step / 2, step / 2)}`;
}

export function showPoint() {
  const { frame, cursor, picked } = state;
  const at = frame.indexOf(cursor);
  const lps = frame.patientOf(cursor).map(millimetres);
  const rows = [
    ['Voxel', frame.voxelOf(cursor).join(', ')],
    ['LPS', `${lps.join(', ')} mm`],
    ['Value', at < 0 ? 'outside the image' : greyText(state.greys[at])],
  ];
  if (picked) {
    rows.push(['Surface', picked.surface.name]);
    for (const { name, value } of picked.values) rows.push([name, Number.isFinite(value) ? value.toPrecision(5) : 'none']);
  }
  byId('point').replaceChildren(...rows.flatMap(([name, value]) => [made('dt', { textContent: name }), made('dd', { textContent: value })]));
}

// ---- surfaces

function legend(value) {
  const { scale } = value;
  if (scale.labels) return [row(label('Labels'), made('span', { textContent: `${scale.least} to ${scale.most}` }))];
  const bar = made('div', { className: 'legend' });
  bar.style.background = scale.css;
  const ends = [0, 1].map((i) => {
    const input = made('input', { type: 'number', step: 'any', value: Number(scale.range[i].toPrecision(4)), ariaLabel: i ? 'Upper end' : 'Lower end' });
    input.addEventListener('change', () => {
      if (!Number.isFinite(input.valueAsNumber)) return;
      scale.range[i] = input.valueAsNumber;
      changed('surfaces');
    });
    return input;
  });
  const whole = `${scale.least.toPrecision(4)} to ${scale.most.toPrecision(4)}`;
  return [row(label('Range'), ends[0], ends[1]), row(label(''), bar), row(label('All'), made('span', { className: 'faint', textContent: whole }))];
}

function surfaceRows(surface) {
  const box = made('div', { className: 'surface' });
  const visible = made('input', { type: 'checkbox', checked: surface.visible, ariaLabel: `Show ${surface.name}` });
  visible.addEventListener('change', () => { surface.visible = visible.checked; changed('surfaces'); });
  const colour = made('input', { type: 'color', value: surface.colour, ariaLabel: `Colour of ${surface.name}` });
  colour.addEventListener('input', () => { surface.colour = colour.value; changed('surfaces'); });
  const opacity = made('input', { type: 'range', min: 0, max: 1, step: 0.05, value: surface.opacity, ariaLabel: `Opacity of ${surface.name}` });
  opacity.addEventListener('input', () => { surface.opacity = Number(opacity.value); changed('surfaces'); });
  const count = `${surface.vertices.toLocaleString('en')} vertices, ${surface.faces.toLocaleString('en')} faces`;
  box.append(row(visible, colour, made('span', { className: 'grow', textContent: surface.name, title: `${surface.name}: ${count}` })));
  box.append(row(label('Opacity'), opacity));
  if (surface.values.length === 0) return box;
  const choice = made('select', { ariaLabel: `Colours of ${surface.name}` }, new Option('one colour', ''));
  surface.values.forEach((value, i) => choice.append(new Option(value.name, i)));
  choice.value = surface.shown ? surface.values.indexOf(surface.shown) : '';
  const below = made('div');
  const show = () => below.replaceChildren(...(surface.shown ? legend(surface.shown) : []));
  choice.addEventListener('change', () => {
    surface.shown = choice.value === '' ? null : surface.values[Number(choice.value)];
    show();
    changed('surfaces');
  });
  show();
  box.append(row(label('Values'), choice), below);
  return box;
}

// ---- window and level

// Of Hounsfield units; other images have none.
const PRESETS = [['Bone', 500, 2000], ['Soft tissue', 40, 400], ['Brain', 40, 100], ['Lung', -600, 1500]];

export function startWindow() {
  const { range, window: [low, high] } = state.image;
  const isCt = range[0] <= -500 && range[0] >= -4096 && range[1] > 500 && range[1] < 32768;
  // The darkest and the brightest hundredths of what is not background black.
  const histogram = new Uint32Array(256);
  for (const grey of state.greys) ++histogram[grey];
  const total = state.greys.length - histogram[0];
  let last = 255;
  for (let sum = histogram[255]; sum < total * 0.005 && last > 1;) sum += histogram[--last];
  const auto = { low, high: last > 1 ? valueOf(last) : high };
  const presets = [['All', (low + high) / 2, high - low], ...(isCt ? PRESETS : [])];
  state.window = isCt ? { low: -500, high: 1300 } : auto;
  return presets;
}

function imageRows(presets) {
  const { image } = state;
  const range = image.window[1] - image.window[0];
  const controls = [['Level', image.window[0], image.window[1]], ['Width', range / 500, range]].map(([name, min, max]) => {
    const slider = made('input', { type: 'range', min, max, step: range / 1000, ariaLabel: name });
    const number = made('input', { type: 'number', step: 'any', ariaLabel: name });
    for (const input of [slider, number]) {
      input.addEventListener(input === slider ? 'input' : 'change', () => {
        if (Number.isFinite(input.valueAsNumber)) set({ [name]: input.valueAsNumber });
      });
    }
    return { name, slider, number };
  });
  const now = () => ({ Level: (state.window.low + state.window.high) / 2, Width: state.window.high - state.window.low });
  function set(part) {
    const { Level, Width } = { ...now(), ...part };
    const width = Math.max(Width, range / 500);
    state.window = { low: Level - width / 2, high: Level + width / 2 };
    changed('image');
  }
  const preset = made('select', { ariaLabel: 'Window' }, new Option('Window…', ''));
  presets.forEach(([name], i) => preset.append(new Option(name, i)));
  preset.addEventListener('change', () => {
    if (preset.value === '') return;
    const [, Level, Width] = presets[Number(preset.value)];
    preset.value = '';
    set({ Level, Width });
  });
  const smooth = made('input', { type: 'checkbox', checked: state.smooth, id: 'smooth' });
  smooth.addEventListener('change', () => { state.smooth = smooth.checked; changed('image'); });
  const inSpace = made('input', { type: 'checkbox', checked: state.slicesInSpace, id: 'in-space' });
  inSpace.addEventListener('change', () => { state.slicesInSpace = inSpace.checked; changed('image'); });
  byId('image').replaceChildren(
    row(preset),
    ...controls.map(({ name, slider, number }) => row(label(name), slider, number)),
    row(smooth, made('label', { htmlFor: 'smooth', className: 'grow', textContent: 'Smooth between voxels' })),
    row(inSpace, made('label', { htmlFor: 'in-space', className: 'grow', textContent: 'Slices in the 3D view' })),
  );
  return () => {
    for (const { name, slider, number } of controls) {
      slider.value = now()[name];
      number.value = Number(text(now()[name], range / 255).replace('−', '-'));
    }
  };
}

// ---- distances, notes

function showDistances() {
  const rows = state.distances.map((places, i) => {
    const words = places.length === 2 ? `${millimetres(length(sub(places[0], places[1])))} mm` : 'click the second point';
    const remove = made('button', { type: 'button', textContent: '×', ariaLabel: 'Remove', title: 'Remove' });
    remove.addEventListener('click', () => { state.distances.splice(i, 1); changed('distances'); });
    return made('li', { className: 'row' }, made('span', { className: 'grow', textContent: words }), remove);
  });
  const hint = state.tool === 'distance' ? 'Click two points, in slices or on surfaces in 3D.' : 'Choose Distance above, then click two points.';
  byId('distances').replaceChildren(...(rows.length ? rows : [made('li', { className: 'faint', textContent: hint })]));
}

// All surfaces on or off at once, where they are many.
function showSurfaces() {
  const both = [['Show all', true], ['Hide all', false]].map(([words, visible]) => {
    const button = made('button', { type: 'button', textContent: words });
    button.addEventListener('click', () => {
      for (const surface of state.surfaces) surface.visible = visible;
      showSurfaces();
      changed('surfaces');
    });
    return button;
  });
  const rows = state.surfaces.map(surfaceRows);
  byId('surfaces').replaceChildren(...(rows.length > MANY ? [row(...both)] : []), ...rows);
  byId('surface-panel').hidden = rows.length === 0;
}

// notes: lines of text. Returns what is to be called with what has changed.
export function buildPanel(notes, presets) {
  const spacing = state.image.spacing.map((x) => Number(x.toPrecision(4))).join(' × ');
  const all = [`${state.image.dims.join(' × ')} voxels of ${spacing} mm`, ...notes];
  byId('notes').replaceChildren(...all.map((note) => made('li', { textContent: note })));
  showSurfaces();
  const showWindow = imageRows(presets);
  return (what) => {
    if (what.has('list')) showSurfaces();
    if (what.has('cursor')) showPoint();
    if (what.has('image')) showWindow();
    if (what.has('distances') || what.has('tool')) showDistances();
    if (what.has('tool')) {
      for (const button of document.querySelectorAll('[data-tool]')) {
        button.setAttribute('aria-checked', String(button.dataset.tool === state.tool));
      }
    }
  };
}
