// Vectors of three numbers, and matrices of three rows of them, row after row.
export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const sub = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scaled = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const unit = (a) => scaled(a, 1 / length(a));

export const column = (m, k) => [m[k], m[3 + k], m[6 + k]];
export const times = (m, a) => [dot(m.slice(0, 3), a), dot(m.slice(3, 6), a), dot(m.slice(6, 9), a)];

export function inverse(m) {
  const rows = [cross(column(m, 1), column(m, 2)), cross(column(m, 2), column(m, 0)), cross(column(m, 0), column(m, 1))];
  return rows.flatMap((row) => scaled(row, 1 / dot(column(m, 0), rows[0])));
}
