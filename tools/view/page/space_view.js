// The surfaces and the three slices in space.
import '@kitware/vtk.js/Rendering/OpenGL/Profiles/Geometry';
import '@kitware/vtk.js/Rendering/OpenGL/ImageMapper';
import '@kitware/vtk.js/Rendering/OpenGL/ImageSlice';
import vtkActor from '@kitware/vtk.js/Rendering/Core/Actor';
import vtkDataArray from '@kitware/vtk.js/Common/Core/DataArray';
import vtkInteractorStyleTrackballCamera from '@kitware/vtk.js/Interaction/Style/InteractorStyleTrackballCamera';
import vtkMapper from '@kitware/vtk.js/Rendering/Core/Mapper';
import vtkPiecewiseFunction from '@kitware/vtk.js/Common/DataModel/PiecewiseFunction';
import vtkPolyData from '@kitware/vtk.js/Common/DataModel/PolyData';
import vtkRenderWindowInteractor from '@kitware/vtk.js/Rendering/Core/RenderWindowInteractor';
import { CanvasView } from './canvas.js';
import { rgbOf } from './colours.js';
import { drawDistances, font, outlined } from './over.js';
import { firstMet } from './pick.js';
import { PLANE_COLOURS, showSlice, sliceActor } from './slice_view.js';
import { addDistancePoint, setCursor, sliceOf, state } from './state.js';
import { add, cross, dot, scaled, sub, unit } from './vectors.js';

const BLACK = 0.06;  // of the window
const CLICK = 4;  // pixels that a click may move

function polyData(surface) {
  const data = vtkPolyData.newInstance();
  data.getPoints().setData(surface.points, 3);
  const polys = new Uint32Array((surface.corners.length / 3) * 4);
  for (let f = 0, at = 0; f < surface.corners.length; f += 3) {
    polys[at++] = 3;
    for (let k = 0; k < 3; ++k) polys[at++] = surface.corners[f + k];
  }
  data.getPolys().setData(polys);
  data.getPointData().setNormals(vtkDataArray.newInstance({ name: 'Normals', values: surface.normals, numberOfComponents: 3 }));
  return data;
}

// What is black, or nearly, is seen through: the air around the object hides no surface.
function seeThroughBlack(slice) {
  const [low, high] = state.image.window;
  const grey = (value) => ((value - low) / (high - low)) * 255;
  const black = grey(state.window.low) + BLACK * (grey(state.window.high) - grey(state.window.low));
  const opacity = vtkPiecewiseFunction.newInstance();
  for (const [at, alpha] of [[Math.min(black - 1, 0), 0], [black, 0], [black + 1, 1], [Math.max(black + 2, 255), 1]]) {
    opacity.addPoint(at, alpha);
  }
  slice.getProperty().setPiecewiseFunction(0, opacity);
}

class SurfaceActor {
  constructor(surface) {
    this.surface = surface;
    this.data = polyData(surface);
    this.mapper = vtkMapper.newInstance({ scalarVisibility: false });
    this.mapper.setInputData(this.data);
    this.mapper.setColorModeToDirectScalars();
    this.actor = vtkActor.newInstance();
    this.actor.setMapper(this.mapper);
    this.actor.getProperty().set({ ambient: 0.12, diffuse: 0.9, specular: 0.18, specularPower: 24 });
    this.coloured = '';
  }
  update() {
    const { surface } = this;
    this.actor.setVisibility(surface.visible && surface.opacity > 0);
    this.actor.getProperty().setOpacity(surface.opacity);
    this.actor.getProperty().setColor(...rgbOf(surface.colour).map((x) => x / 255));
    const { shown } = surface;
    const key = shown ? [shown.name, ...shown.scale.range].join() : '';
    if (key === this.coloured) return;
    this.coloured = key;
    this.mapper.setScalarVisibility(shown !== null);
    if (!shown) return;
    const colours = new Uint8Array(3 * shown.array.length);
    for (let i = 0; i < shown.array.length; ++i) colours.set(shown.scale.colour(shown.scale.step(shown.array[i])), 3 * i);
    this.data.getPointData().setScalars(vtkDataArray.newInstance({ name: 'Colours', values: colours, numberOfComponents: 3 }));
    this.data.modified();
  }
}

export class SpaceView extends CanvasView {
  constructor(parent, imageData) {
    super(parent, 'space', '3D');
    this.slices = state.frame.planes.map((plane) => sliceActor(imageData, plane));
    for (const slice of this.slices) this.renderer.addActor(slice);
    this.surfaces = [];
    this.interactor = vtkRenderWindowInteractor.newInstance();
    this.interactor.setView(this.gl);
    this.interactor.initialize();
    this.interactor.setInteractorStyle(vtkInteractorStyleTrackballCamera.newInstance());
    this.interactor.bindEvents(this.stage);
    this.stage.tabIndex = -1;
    // vtk.js has keys of its own, as W for wires: here they are those of the page.
    this.root.addEventListener('keypress', (event) => event.stopPropagation(), true);
    this.renderer.getActiveCamera().onModified(() => this.ask());
    this.#clicks();
    this.fitted = false;
    this.black = null;  // the window for which black is seen through
  }

  #clicks() {
    let down = null;
    this.stage.addEventListener('pointerdown', (event) => {
      down = event.button === 0 && !event.shiftKey && !event.ctrlKey ? this.at(event) : null;
    });
    this.stage.addEventListener('pointerup', (event) => {
      const at = this.at(event);
      if (down && Math.hypot(at[0] - down[0], at[1] - down[1]) < CLICK) this.#clicked(at);
      down = null;
    });
  }
  #clicked(at) {
    const { from, along } = this.ray(at);
    const met = firstMet(state.surfaces, from, along);
    if (!met) return;
    const place = add(from, scaled(along, met.t));
    if (state.tool === 'distance') addDistancePoint(place);
    else setCursor(place, met);
  }

  #camera() {
    const camera = this.renderer.getActiveCamera();
    const back = unit(sub(camera.getPosition(), camera.getFocalPoint()));
    const right = unit(cross(camera.getViewUp(), back));
    return { position: camera.getPosition(), back, right, up: cross(back, right), focal: this.height / 2 / Math.tan((camera.getViewAngle() * Math.PI) / 360) };
  }
  ray([x, y]) {
    const { position, back, right, up, focal } = this.#camera();
    const along = add(add(scaled(right, x - this.width / 2), scaled(up, this.height / 2 - y)), scaled(back, -focal));
    return { from: position, along };
  }
  project(place) {
    const { position, back, right, up, focal } = this.#camera();
    const from = sub(place, position);
    const scale = focal / -dot(from, back);
    return { x: this.width / 2 + dot(from, right) * scale, y: this.height / 2 - dot(from, up) * scale, near: scale > 0 };
  }

  dispose() {
    this.interactor.unbindEvents();
    super.dispose();
  }

  // From the front, the left and a little above, as anatomy is drawn.
  reset() {
    const camera = this.renderer.getActiveCamera();
    camera.setFocalPoint(0, 0, 0);
    camera.setPosition(0.62, -1, 0.32);
    camera.setViewUp(0, 0, 1);
    this.update();
    this.renderer.resetCamera();
    camera.dolly(1.4);
    this.fitted = true;
    this.ask();
  }
  resized() { if (!this.fitted) this.reset(); }
  // Actors of surfaces that have gone are dropped, others made.
  #follow() {
    const known = new Map(this.surfaces.map((actor) => [actor.surface, actor]));
    for (const { surface, actor } of this.surfaces) {
      if (!state.surfaces.includes(surface)) this.renderer.removeActor(actor);
    }
    this.surfaces = state.surfaces.map((surface) => {
      if (known.has(surface)) return known.get(surface);
      const made = new SurfaceActor(surface);
      this.renderer.addActor(made.actor);
      return made;
    });
  }
  update() {
    this.#follow();
    for (const surface of this.surfaces) surface.update();
    for (const slice of this.slices) slice.setVisibility(state.slicesInSpace);
  }

  prepare() {
    this.update();
    if (this.black !== state.window) {
      this.black = state.window;
      this.slices.forEach(seeThroughBlack);
    }
    this.slices.forEach((slice, i) => showSlice(slice, sliceOf(state.frame.planes[i])));
    const back = getComputedStyle(document.documentElement).getPropertyValue('--back').trim();
    this.renderer.setBackground(...rgbOf(back).map((x) => x / 255));
    this.renderer.resetCameraClippingRange();
  }

  drawOver(context) {
    drawDistances(context, (place) => this.project(place));
    this.#drawCursor(context);
    this.#drawAxes(context);
  }
  #drawCursor(context) {
    const { x, y, near } = this.project(state.cursor);
    if (!near) return;
    context.lineWidth = 1.5;
    context.strokeStyle = '#ffffff';
    context.beginPath();
    context.arc(x, y, 5, 0, 2 * Math.PI);
    context.stroke();
    context.strokeStyle = '#000000';
    context.beginPath();
    context.arc(x, y, 6.5, 0, 2 * Math.PI);
    context.stroke();
  }
  // The axes of the patient in a corner, those that point away first.
  #drawAxes(context) {
    const { right, up, back } = this.#camera();
    const [x, y, size] = [48, this.height - 48, 28];
    const axes = [['L', [1, 0, 0], PLANE_COLOURS.Sagittal], ['P', [0, 1, 0], PLANE_COLOURS.Coronal], ['S', [0, 0, 1], PLANE_COLOURS.Axial]];
    axes.sort((a, b) => dot(a[1], back) - dot(b[1], back));
    font(context, 12, 600);
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    context.lineWidth = 2;
    for (const [letter, axis, colour] of axes) {
      const end = [x + size * dot(axis, right), y - size * dot(axis, up)];
      context.strokeStyle = colour;
      context.fillStyle = colour;
      context.lineWidth = 2;
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(...end);
      context.stroke();
      outlined(context, letter, x + (end[0] - x) * 1.35, y + (end[1] - y) * 1.35);
    }
  }
}
