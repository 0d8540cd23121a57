// Where a surface meets the slices of a plane: exactly, edge by edge. vtk.js has a cutter (vtkCutter),
// but it compares every crossing with all before it and numbers them in 16 bits: too slow, and wrong
// beyond 65,536 crossings.

// A vertex at or beyond a slice is above it, any other is below: a face that touches a slice without
// crossing it has no segment there, and one that lies in it has its borders' from its neighbours.
export class Contours {
  constructor(surface, plane) {
    this.surface = surface;
    this.plane = plane;
    const { points, corners } = surface;
    const { normal, first, step, count } = plane;
    const vertices = points.length / 3;
    this.heights = new Float64Array(vertices);  // in slices
    for (let i = 0, k = 0; i < vertices; ++i, k += 3) {
      this.heights[i] = (normal[0] * points[k] + normal[1] * points[k + 1] + normal[2] * points[k + 2] - first) / step;
    }
    // Faces by the slices that they cross, those of slice k from begins[k] to begins[k + 1].
    this.begins = new Uint32Array(count + 1);
    this.#eachCrossing((k) => { ++this.begins[k + 1]; });
    for (let k = 0; k < count; ++k) this.begins[k + 1] += this.begins[k];
    const next = this.begins.slice();
    this.faces = new Uint32Array(this.begins[count]);
    this.#eachCrossing((k, face) => { this.faces[next[k]++] = face; });
    this.corners = corners;
  }

  #eachCrossing(visit) {
    const { corners } = this.surface;
    const h = this.heights;
    for (let f = 0; f < corners.length; f += 3) {
      const a = h[corners[f]];
      const b = h[corners[f + 1]];
      const c = h[corners[f + 2]];
      const last = Math.min(Math.floor(Math.max(a, b, c)), this.plane.count - 1);
      for (let k = Math.max(Math.floor(Math.min(a, b, c)) + 1, 0); k <= last; ++k) visit(k, f);
    }
  }

  // Segments u0, v0, u1, v1 in slice k, in the order of their faces; where values of the vertices are
  // given, the mean of each segment's ends.
  cut(k, values = null) {
    const { points } = this.surface;
    const { u, v } = this.plane;
    const h = this.heights;
    const count = k >= 0 && k < this.plane.count ? this.begins[k + 1] - this.begins[k] : 0;
    const segments = new Float64Array(4 * count);
    const means = values ? new Float32Array(count) : null;
    const cross = (from, to, at) => {
      const t = (k - h[from]) / (h[to] - h[from]);
      const x = points[3 * from] + t * (points[3 * to] - points[3 * from]);
      const y = points[3 * from + 1] + t * (points[3 * to + 1] - points[3 * from + 1]);
      const z = points[3 * from + 2] + t * (points[3 * to + 2] - points[3 * from + 2]);
      segments[at] = u[0] * x + u[1] * y + u[2] * z;
      segments[at + 1] = v[0] * x + v[1] * y + v[2] * z;
      return values ? values[from] + t * (values[to] - values[from]) : 0;
    };
    for (let i = 0; i < count; ++i) {
      const f = this.faces[this.begins[k] + i];
      const abc = [this.corners[f], this.corners[f + 1], this.corners[f + 2]];
      const above = abc.map((vertex) => h[vertex] >= k);
      // The corner that is alone on its side; the segment ends on its two edges.
      const alone = above[0] === above[1] ? 2 : above[0] === above[2] ? 1 : 0;
      const tip = abc[alone];
      const first = cross(tip, abc[(alone + 1) % 3], 4 * i);
      const second = cross(tip, abc[(alone + 2) % 3], 4 * i + 2);
      if (means) means[i] = (first + second) / 2;
    }
    return { segments, means };
  }
}
