// One slice of the image with the contours of the surfaces in it.
import vtkImageMapper from '@kitware/vtk.js/Rendering/Core/ImageMapper';
import vtkImageSlice from '@kitware/vtk.js/Rendering/Core/ImageSlice';
import { CanvasView } from './canvas.js';
import { dragged } from './gestures.js';
import { drawDistances, drawScaleBar, font, outlined } from './over.js';
import { addDistancePoint, changed, millimetres, setCursor, setSlice, sliceOf, state } from './state.js';
import { add, dot, scaled } from './vectors.js';

export const PLANE_COLOURS = { Axial: '#ff6b6b', Sagittal: '#6bd66b', Coronal: '#6ba8ff' };
const MARGIN = 1.04;  // of the image at first

export function sliceActor(imageData, plane) {
  const mapper = vtkImageMapper.newInstance();
  mapper.setInputData(imageData);
  mapper.setSlicingMode(plane.axis);
  const actor = vtkImageSlice.newInstance();
  actor.setMapper(mapper);
  return actor;
}

export function showSlice(actor, k) {
  actor.getMapper().setSlice(k);
  const property = actor.getProperty();
  const [low, high] = state.image.window;
  const grey = (value) => ((value - low) / (high - low)) * 255;
  property.setColorWindow(Math.max(grey(state.window.high) - grey(state.window.low), 0.01));
  property.setColorLevel((grey(state.window.high) + grey(state.window.low)) / 2);
  if (state.smooth) property.setInterpolationTypeToLinear();
  else property.setInterpolationTypeToNearest();
}

export class SliceView extends CanvasView {
  constructor(parent, number, imageData) {
    const plane = state.frame.planes[number];
    super(parent, 'slice', plane.name);
    this.number = number;
    this.plane = plane;
    this.title.style.color = PLANE_COLOURS[plane.name];
    this.where = document.createElement('div');
    this.where.className = 'where';
    this.slider = document.createElement('input');
    Object.assign(this.slider, { type: 'range', min: 0, max: plane.count - 1, step: 1 });
    this.slider.setAttribute('aria-label', `${plane.name} slice`);
    this.slider.addEventListener('input', () => setSlice(plane, Number(this.slider.value)));
    this.root.append(this.where, this.slider);
    this.actor = sliceActor(imageData, plane);
    this.renderer.addActor(this.actor);
    this.renderer.getActiveCamera().setParallelProjection(true);
    this.paths = new WeakMap();  // of contours, by surface, while the slice and the looks are the same
    this.centre = null;  // in mm along u and v; none until there is room
    dragged(this);
    this.root.addEventListener('keydown', (event) => {
      const step = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 10, PageDown: -10 }[event.key];
      if (!step || event.target !== this.root) return;
      event.preventDefault();
      setSlice(plane, sliceOf(plane) + step);
    });
  }

  // The whole image in the view.
  reset() {
    const { u, v } = this.plane;
    const [nx, ny, nz] = state.frame.grid;
    let [left, right, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
    for (const i of [-0.5, nx - 0.5]) {
      for (const j of [-0.5, ny - 0.5]) {
        for (const k of [-0.5, nz - 0.5]) {
          const corner = state.frame.placeOf([i, j, k]);
          left = Math.min(left, dot(u, corner));
          right = Math.max(right, dot(u, corner));
          bottom = Math.min(bottom, dot(v, corner));
          top = Math.max(top, dot(v, corner));
        }
      }
    }
    this.centre = [(left + right) / 2, (bottom + top) / 2];
    this.size = [(right - left) * MARGIN, (top - bottom) * MARGIN];
    this.zoom = 1;
    this.ask();
  }
  resized() { if (!this.centre) this.reset(); }

  get scale() { return this.zoom * Math.min(this.width / this.size[0], this.height / this.size[1]); }
  get depth() { return this.plane.first + sliceOf(this.plane) * this.plane.step; }
  placeAt([x, y], depth = this.depth) {
    const { u, v, normal } = this.plane;
    const right = this.centre[0] + (x - this.width / 2) / this.scale;
    const up = this.centre[1] - (y - this.height / 2) / this.scale;
    return add(add(scaled(u, right), scaled(v, up)), scaled(normal, depth));
  }
  project(place) {
    const x = this.width / 2 + (dot(this.plane.u, place) - this.centre[0]) * this.scale;
    const y = this.height / 2 - (dot(this.plane.v, place) - this.centre[1]) * this.scale;
    const near = Math.abs(dot(this.plane.normal, place) - this.depth) < Math.abs(this.plane.step) * 0.75;
    return { x, y, near };
  }

  // What gestures.js calls.
  pressed(at) {
    if (state.tool === 'distance') addDistancePoint(this.placeAt(at));
    if (state.tool === 'point') this.#point(at);
  }
  moved(at, by) {
    if (state.tool === 'point') this.#point(at);
    if (state.tool === 'window') this.#window(by);
    if (state.tool === 'pan') this.pan(by);
  }
  pan([dx, dy]) {
    this.centre = [this.centre[0] - dx / this.scale, this.centre[1] + dy / this.scale];
    this.ask();
  }
  zoomed(factor, at) {
    const before = this.placeAt(at);
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.2), 80);
    const after = this.project(before);
    this.pan([at[0] - after.x, at[1] - after.y]);
  }
  turned(steps) { setSlice(this.plane, sliceOf(this.plane) + steps); }

  // The depth of the cursor stays where it is, between slices, too.
  #point(at) { setCursor(this.placeAt(at)); }
  #window([dx, dy]) {
    const { low, high } = state.window;
    const range = state.image.window[1] - state.image.window[0];
    const width = Math.max(high - low + (dx / 400) * range, range / 500);
    const level = (low + high) / 2 - (dy / 400) * range;
    state.window = { low: level - width / 2, high: level + width / 2 };
    changed('image');
  }

  prepare() {
    const k = sliceOf(this.plane);
    showSlice(this.actor, k);
    const { u, v, normal } = this.plane;
    const focus = add(add(scaled(u, this.centre[0]), scaled(v, this.centre[1])), scaled(normal, this.depth));
    const camera = this.renderer.getActiveCamera();
    camera.setFocalPoint(...focus);
    camera.setPosition(...add(focus, scaled(normal, 100)));
    camera.setViewUp(...v);
    camera.setParallelScale(this.height / 2 / this.scale);
    camera.setClippingRange(1, 200);
    this.slider.value = k;
    const middle = dot(normal, state.image.middle) + this.depth;
    const sign = Math.sign(normal.reduce((best, x) => (Math.abs(x) > Math.abs(best) ? x : best), 0));
    this.where.textContent = `${k + 1} / ${this.plane.count}   ${millimetres(middle * sign)} mm`;
  }

  // Contours in mm, of one colour each: they need not be made again to be moved or magnified.
  #contours(surface) {
    const k = sliceOf(this.plane);
    const known = this.paths.get(surface);
    const shown = surface.shown;
    const key = shown ? [k, shown.name, ...shown.scale.range].join() : `${k}`;
    if (known?.key === key) return known.paths;
    const { segments, means } = surface.contours[this.number].cut(k, shown?.array);
    const paths = new Map();
    for (let i = 0; 4 * i < segments.length; ++i) {
      const step = means ? shown.scale.step(means[i]) : 0;
      let path = paths.get(step);
      if (!path) paths.set(step, (path = new Path2D()));
      path.moveTo(segments[4 * i], segments[4 * i + 1]);
      path.lineTo(segments[4 * i + 2], segments[4 * i + 3]);
    }
    this.paths.set(surface, { key, paths });
    return paths;
  }

  drawOver(context) {
    context.save();
    context.translate(this.width / 2, this.height / 2);
    context.scale(this.scale, -this.scale);
    context.translate(-this.centre[0], -this.centre[1]);
    context.lineCap = 'round';
    context.lineWidth = 1.6 / this.scale;
    for (const surface of state.surfaces) {
      if (!surface.visible) continue;
      for (const [step, path] of this.#contours(surface)) {
        context.strokeStyle = surface.shown ? `rgb(${surface.shown.scale.colour(step)})` : surface.colour;
        context.stroke(path);
      }
    }
    context.restore();
    this.#drawCross(context);
    drawDistances(context, (place) => this.project(place));
    this.#drawLetters(context);
    drawScaleBar(context, this.scale, this.width, this.height);
  }

  // The other two planes, with a gap at the cursor.
  #drawCross(context) {
    const gap = 12;
    const { x, y } = this.project(state.cursor);
    context.lineWidth = 1;
    context.globalAlpha = 0.75;
    for (const plane of state.frame.planes) {
      if (plane === this.plane) continue;
      // A line along this view's u where the other plane cuts across v.
      const level = Math.abs(dot(plane.normal, this.plane.v)) > Math.abs(dot(plane.normal, this.plane.u));
      context.strokeStyle = PLANE_COLOURS[plane.name];
      context.beginPath();
      for (const [from, to] of level ? [[0, x - gap], [x + gap, this.width]] : [[0, y - gap], [y + gap, this.height]]) {
        context.moveTo(...(level ? [from, y] : [x, from]));
        context.lineTo(...(level ? [to, y] : [x, to]));
      }
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  #drawLetters(context) {
    const { left, right, top, bottom } = this.plane.letters;
    font(context, 14, 600);
    context.fillStyle = '#cfd6df';
    context.textBaseline = 'middle';
    context.textAlign = 'left';
    outlined(context, left, 10, this.height / 2);
    context.textAlign = 'right';
    outlined(context, right, this.width - 10, this.height / 2);
    context.textAlign = 'center';
    outlined(context, top, this.width / 2, 15);
    outlined(context, bottom, this.width / 2, this.height - 36);
  }
}
