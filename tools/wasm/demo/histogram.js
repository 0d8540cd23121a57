// What values an image has: their range, percentiles, and Otsu's threshold.
const BINS = 65536;

export class Histogram {
  // A bin for each value of integers within a range of 65,536, else 65,536 bins over the range.
  constructor(voxels) {
    let [low, high] = [Infinity, -Infinity];
    for (let i = 0; i < voxels.length; ++i) {
      const x = voxels[i];
      if (x < low) low = x;
      if (x > high) high = x;
    }
    const whole = !(voxels instanceof Float32Array) && high - low < BINS;
    const bins = whole ? high - low + 1 : BINS;
    this.low = low;
    this.high = high;
    this.whole = whole;
    this.width = whole ? 1 : (high - low) / BINS;
    this.counts = new Float64Array(bins);
    for (let i = 0; i < voxels.length; ++i) {
      const place = this.width > 0 ? Math.floor((voxels[i] - low) / this.width) : 0;
      ++this.counts[Math.min(place, bins - 1)];
    }
    this.total = voxels.length;
  }

  // The value that no fewer than `part` of the voxels do not exceed, to a bin.
  quantile(part) {
    let sum = 0;
    const bin = this.counts.findIndex((count) => (sum += count) >= part * this.total);
    return this.whole ? this.low + bin : Math.min(this.low + (bin + 0.5) * this.width, this.high);
  }

  // As `pellicle info` tells it, to the bit: tools/volume/volume_statistics.cpp. NaN where all voxels
  // have one value.
  otsu() {
    if (!(this.low < this.high)) return NaN;
    let total = 0;
    this.counts.forEach((count, b) => { total += b * count; });
    let [below, sum, best, begin, end] = [0, 0, -1, 0, 0];
    for (let b = 0; b + 1 < this.counts.length; ++b) {
      below += this.counts[b];
      sum += b * this.counts[b];
      if (below === 0 || below === this.total) continue;
      const apart = sum / below - (total - sum) / (this.total - below);
      const between = below * (this.total - below) * apart * apart;
      if (between > best) begin = b;
      if (between >= best) end = b;  // of bins of no voxels all are equally good
      best = Math.max(best, between);
    }
    return this.low + (this.whole ? 0.5 : this.width) + this.width * (begin + end) / 2;
  }

  // The same in fewer bins over the range.
  bars(count) {
    const bars = new Float64Array(count);
    this.counts.forEach((n, b) => { bars[Math.min(Math.floor((b / this.counts.length) * count), count - 1)] += n; });
    return bars;
  }
}
