// Where voxels lie. All that is drawn is in patient space (LPS, mm) relative to the middle of the
// image, where floats are precise: a "place". The grid are the voxels of the page, the image those of
// the file; they differ where the image has been reduced.
import { add, column, cross, dot, inverse, scaled, sub, times, unit } from './vectors.js';

const LETTERS = [['R', 'L'], ['A', 'P'], ['I', 'S']];
const ORDERS = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

// Which patient axes go to the right and up on the screen; radiological convention.
const PLANES = [
  { name: 'Axial', along: 2, right: [0, 1], up: [1, -1] },
  { name: 'Sagittal', along: 0, right: [1, 1], up: [2, 1] },
  { name: 'Coronal', along: 1, right: [0, 1], up: [2, 1] },
];

export class Frame {
  constructor(image) {
    this.image = image;
    this.grid = image.grid;
    const half = image.reduction.map((r) => (r - 1) / 2);
    this.matrix = image.matrix.map((m, i) => m * image.reduction[i % 3]);
    this.first = sub(add(image.origin, times(image.matrix, half)), image.middle);
    this.toGrid = inverse(this.matrix);
    this.toImage = inverse(image.matrix);
    this.planes = PLANES.map((plane) => this.#plane(plane));
  }

  gridOf(place) { return times(this.toGrid, sub(place, this.first)); }
  placeOf(grid) { return add(this.first, times(this.matrix, grid)); }
  patientOf(place) { return add(place, this.image.middle); }
  voxelOf(place) { return times(this.toImage, sub(this.patientOf(place), this.image.origin)).map((x) => Math.round(x) + 0); }

  // Where in the grid's array a place is; -1 outside of the image.
  indexOf(place) {
    const [i, j, k] = this.gridOf(place).map(Math.round);
    const [nx, ny, nz] = this.grid;
    const inside = i >= 0 && j >= 0 && k >= 0 && i < nx && j < ny && k < nz;
    return inside ? (k * ny + j) * nx + i : -1;
  }

  // The axis of the image that is nearest to each axis of the patient.
  get axes() {
    const fit = (order) => order.reduce((sum, axis, patient) => sum + Math.abs(unit(column(this.matrix, axis))[patient]), 0);
    return ORDERS.reduce((best, order) => (fit(order) > fit(best) ? order : best));
  }

  // The slices of a plane lie at depths first + k * step along its normal, which points to the viewer.
  #plane({ name, along, right, up }) {
    const axes = this.axes;
    const towards = ([patient, sign]) => {
      const axis = unit(column(this.matrix, axes[patient]));
      return axis[patient] * sign < 0 ? scaled(axis, -1) : axis;
    };
    const u = towards(right);
    const slanted = towards(up);
    const v = unit(sub(slanted, scaled(u, dot(slanted, u))));
    const normal = cross(u, v);
    const axis = axes[along];
    return {
      name,
      axis,
      count: this.grid[axis],
      u,
      v,
      normal,
      first: dot(normal, this.first),
      step: dot(normal, column(this.matrix, axis)),
      letters: {
        left: LETTERS[right[0]][right[1] > 0 ? 0 : 1],
        right: LETTERS[right[0]][right[1] > 0 ? 1 : 0],
        top: LETTERS[up[0]][up[1] > 0 ? 1 : 0],
        bottom: LETTERS[up[0]][up[1] > 0 ? 0 : 1],
      },
    };
  }
}
