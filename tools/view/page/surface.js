// A surface as the page has it, and what is chosen of its looks.
import { Scale, SURFACE_COLOURS } from './colours.js';
import { Contours } from './contours.js';
import { cross, dot } from './vectors.js';

// Of each vertex, its faces' normals weighted by area.
function normalsOf(points, corners) {
  const normals = new Float32Array(points.length);
  for (let f = 0; f < corners.length; f += 3) {
    const [a, b, c] = [3 * corners[f], 3 * corners[f + 1], 3 * corners[f + 2]];
    const ux = points[b] - points[a];
    const uy = points[b + 1] - points[a + 1];
    const uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a];
    const vy = points[c + 1] - points[a + 1];
    const vz = points[c + 2] - points[a + 2];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const at of [a, b, c]) {
      for (let k = 0; k < 3; ++k) normals[at + k] += n[k];
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const size = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[i + k] /= size;
  }
  return normals;
}

function volumeOf(points, corners) {
  let sum = 0;
  const p = (i) => points.subarray(3 * i, 3 * i + 3);
  for (let f = 0; f < corners.length; f += 3) sum += dot(p(corners[f]), cross(p(corners[f + 1]), p(corners[f + 2])));
  return Math.abs(sum) / 6;
}

function boxOf(points) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], points[i]);
    high[i % 3] = Math.max(high[i % 3], points[i]);
  }
  return { low, high };
}

export class Surface {
  // planes: of the frame. points: places, x, y, z of each vertex.
  constructor(number, told, points, corners, arrays, planes) {
    this.name = told.name;
    this.faces = told.faces;
    this.vertices = told.vertices;
    this.points = points;
    this.corners = corners;
    this.normals = normalsOf(this.points, corners);
    this.box = boxOf(this.points);
    this.volume = volumeOf(this.points, corners);
    this.contours = planes.map((plane) => new Contours(this, plane));
    this.values = told.values.map((value, i) => ({ name: value.name, array: arrays[i], scale: new Scale(value.name, arrays[i]) }));
    this.visible = true;
    this.opacity = 1;
    this.colour = SURFACE_COLOURS[number % SURFACE_COLOURS.length];
    // Labels are what one looks for in a file that has them.
    this.shown = this.values.find((value) => value.scale.labels) ?? null;
  }

  // Whether nearly all of another, smaller one is in the box around it.
  encloses(other) {
    if (this.volume <= other.volume) return false;
    const { low, high } = this.box;
    let inside = 0;
    for (let i = 0; i < other.points.length; i += 3) {
      if ([0, 1, 2].every((k) => other.points[i + k] >= low[k] && other.points[i + k] <= high[k])) ++inside;
    }
    return inside > 0.9 * other.vertices;
  }
}
