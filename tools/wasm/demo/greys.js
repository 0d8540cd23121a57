// The image in 256 greys, reduced where it has too many voxels to look at: as tools/view/grey_image.cpp does it.
import { countOf } from './voxels.js';

const MOST = 2 ** 24;  // voxels
const CUT = 1e-4;      // of the voxels that the window leaves out at each end

function reductionOf({ dims, spacing }) {
  const reduction = [1, 1, 1];
  const grid = () => dims.map((n, k) => Math.ceil(n / reduction[k]));
  while (countOf(grid()) > MOST) {
    // The axis whose voxels are then the shortest.
    const next = [0, 1, 2].filter((k) => grid()[k] > 2).sort((a, b) => spacing[a] * (reduction[a] + 1) - spacing[b] * (reduction[b] + 1))[0];
    ++reduction[next];
  }
  return { reduction, grid: grid() };
}

// Returns {greys, image}: image is what tools/view/page/ shows, but for the greys.
export function greysOf(image, histogram) {
  const { dims, spacing, origin, direction, voxels } = image;
  const { reduction, grid } = reductionOf(image);
  const few = histogram.whole && histogram.high - histogram.low <= 255;
  let [low, high] = few ? [histogram.low, histogram.low + 255] : [histogram.quantile(CUT), histogram.quantile(1 - CUT)];
  if (!(high > low)) [low, high] = [histogram.low, Math.max(histogram.high, histogram.low + 1)];
  const greys = new Uint8ClampedArray(countOf(grid));
  const sums = new Float64Array(grid[0]);
  let to = 0;
  for (let z = 0; z < grid[2]; ++z) {
    for (let y = 0; y < grid[1]; ++y) {
      sums.fill(0);
      const zEnd = Math.min((z + 1) * reduction[2], dims[2]);
      const yEnd = Math.min((y + 1) * reduction[1], dims[1]);
      for (let zz = z * reduction[2]; zz < zEnd; ++zz) {
        for (let yy = y * reduction[1]; yy < yEnd; ++yy) {
          const row = (zz * dims[1] + yy) * dims[0];
          for (let x = 0, f = reduction[0]; x < dims[0]; ++x) sums[f === 1 ? x : Math.floor(x / f)] += voxels[row + x];
        }
      }
      const rows = (zEnd - z * reduction[2]) * (yEnd - y * reduction[1]);
      for (let x = 0; x < grid[0]; ++x) {
        const columns = Math.min((x + 1) * reduction[0], dims[0]) - x * reduction[0];
        greys[to++] = ((sums[x] / (rows * columns) - low) / (high - low)) * 255;  // rounded and clamped
      }
    }
  }
  const matrix = direction.map((x, i) => x * spacing[i % 3]);
  const half = dims.map((n) => (n - 1) / 2);
  const middle = origin.map((x, row) => x + half.reduce((sum, h, k) => sum + h * matrix[3 * row + k], 0));
  const exact = few && reduction.every((f) => f === 1);
  return {
    greys: new Uint8Array(greys.buffer),
    image: { name: image.name, dims, spacing, matrix, origin, middle, exact, range: [histogram.low, histogram.high], window: [low, high], reduction, grid },
  };
}
