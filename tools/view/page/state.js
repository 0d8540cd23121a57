// What is looked at, and who is told when it changes.
export const state = {
  image: null,      // as tools/view/view_page.cpp writes it
  frame: null,
  greys: null,
  surfaces: [],
  cursor: [0, 0, 0],  // a place; every plane shows the slice through it
  picked: null,       // the surface under the cursor and its value there, where it was clicked in 3D
  tool: 'point',
  window: { low: 0, high: 255 },  // values that are black and white
  smooth: true,
  slicesInSpace: true,
  distances: [],      // [place, place], the last one perhaps of one place alone
};

let listeners = [];
export const listen = (listener) => { listeners.push(listener); };
export const nobodyListens = () => { listeners = []; };
// what: cursor, image (how slices look), surfaces (how they look), list (of surfaces), distances, tool, theme.
export function changed(...what) {
  for (const listener of listeners) listener(new Set(what));
}

// The image's value of a grey.
export function valueOf(grey) {
  const [low, high] = state.image.window;
  return low + (grey / 255) * (high - low);
}

// As many digits as tell two steps of `step` apart.
export function text(value, step) {
  const digits = Math.min(Math.max(Math.ceil(-Math.log10(Math.max(Math.abs(step), 1e-12))) + 1, 0), 6);
  return value.toFixed(digits).replace(/^-(0(?:\.0*)?)$/, '$1').replace('-', '−');
}

export const millimetres = (x) => text(x, 0.1);

export function setCursor(place, picked = null) {
  // Within the image, so that there is a slice to show.
  const { frame } = state;
  const grid = frame.gridOf(place).map((x, axis) => Math.min(Math.max(x, 0), frame.grid[axis] - 1));
  state.cursor = frame.placeOf(grid);
  state.picked = picked;
  changed('cursor');
}

export function sliceOf(plane) {
  const k = Math.round(state.frame.gridOf(state.cursor)[plane.axis]);
  return Math.min(Math.max(k, 0), plane.count - 1);
}

export function setSlice(plane, k) {
  const grid = state.frame.gridOf(state.cursor);
  grid[plane.axis] = Math.min(Math.max(k, 0), plane.count - 1);
  setCursor(state.frame.placeOf(grid));
}

// A click of the distance tool.
export function addDistancePoint(place) {
  const last = state.distances.at(-1);
  if (last && last.length === 1) last.push(place);
  else state.distances.push([place]);
  changed('distances');
}

export function setTool(tool) {
  state.tool = tool;
  if (state.distances.at(-1)?.length === 1) state.distances.pop();
  changed('tool', 'distances');
}
