// Which visible surface a ray meets first.
import { cross, dot, sub } from './vectors.js';

function boxMet({ low, high }, from, along) {
  let [near, far] = [0, Infinity];
  for (let k = 0; k < 3; ++k) {
    const a = (low[k] - from[k]) / along[k];
    const b = (high[k] - from[k]) / along[k];
    if (Number.isNaN(a) || Number.isNaN(b)) continue;  // parallel, on a side
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near <= far;
}

// Möller and Trumbore. Returns where along the ray, and the weights of the second and third corner.
function triangleMet(a, b, c, from, along) {
  const ab = sub(b, a);
  const ac = sub(c, a);
  const p = cross(along, ac);
  const area = dot(ab, p);
  if (area === 0) return null;
  const s = sub(from, a);
  const second = dot(s, p) / area;
  if (second < 0 || second > 1) return null;
  const q = cross(s, ab);
  const third = dot(along, q) / area;
  if (third < 0 || second + third > 1) return null;
  const t = dot(ac, q) / area;
  return t > 0 ? { t, second, third } : null;
}

// The surface, how far along the ray, and its value there.
export function firstMet(surfaces, from, along) {
  let best = null;
  for (const surface of surfaces) {
    if (!surface.visible || surface.opacity === 0 || !boxMet(surface.box, from, along)) continue;
    const { points, corners } = surface;
    const corner = (i) => points.subarray(3 * corners[i], 3 * corners[i] + 3);
    for (let f = 0; f < corners.length; f += 3) {
      const met = triangleMet(corner(f), corner(f + 1), corner(f + 2), from, along);
      if (met && (!best || met.t < best.t)) best = { ...met, surface, face: f };
    }
  }
  if (!best) return null;
  const { surface, face, t, second, third } = best;
  const value = (array) => array[surface.corners[face]] * (1 - second - third)
    + array[surface.corners[face + 1]] * second + array[surface.corners[face + 2]] * third;
  return { surface, t, values: surface.values.map(({ name, array }) => ({ name, value: value(array) })) };
}
