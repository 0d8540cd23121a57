// What pointers and the wheel do in a slice: one finger or button is a tool, two fingers move and
// magnify, the right button magnifies, the middle one and Shift move.
const between = ([a, b]) => Math.hypot(a[0] - b[0], a[1] - b[1]);
const middle = ([a, b]) => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
const controls = (target) => target.closest('button, input');

export function dragged(view) {
  const { root } = view;
  const pointers = new Map();
  let action = null;
  let rest = 0;  // of the wheel, below a slice

  root.addEventListener('contextmenu', (event) => event.preventDefault());
  root.addEventListener('pointerdown', (event) => {
    if (controls(event.target)) return;
    root.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, view.at(event));
    if (pointers.size > 1) action = 'pinch';
    else if (event.button === 2) action = 'zoom';
    else if (event.button === 1 || event.shiftKey) action = 'pan';
    else {
      action = 'tool';
      view.pressed(view.at(event));
    }
  });
  root.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const at = view.at(event);
    const by = [at[0] - before[0], at[1] - before[1]];
    const old = [...pointers.values()];
    pointers.set(event.pointerId, at);
    const now = [...pointers.values()];
    if (action === 'tool') view.moved(at, by);
    if (action === 'pan') view.pan(by);
    if (action === 'zoom') view.zoomed(Math.exp(-by[1] / 150), [view.width / 2, view.height / 2]);
    if (action === 'pinch' && now.length === 2) {
      const [from, to] = [middle(old), middle(now)];
      view.pan([to[0] - from[0], to[1] - from[1]]);
      view.zoomed(between(now) / Math.max(between(old), 1), to);
    }
  });
  const ended = (event) => {
    pointers.delete(event.pointerId);
    if (pointers.size === 0) action = null;
  };
  root.addEventListener('pointerup', ended);
  root.addEventListener('pointercancel', ended);
  root.addEventListener('wheel', (event) => {
    event.preventDefault();
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / 40 : event.deltaY;
    if (event.ctrlKey) {
      view.zoomed(Math.exp(-lines / 6), view.at(event));
      return;
    }
    rest -= lines;
    const steps = Math.trunc(rest);
    rest -= steps;
    if (steps !== 0) view.turned(steps);
  }, { passive: false });
}
