// The histogram with the value on it, which is dragged, typed, or moved by arrow keys.
const BARS = 256;
const HEIGHT = 84;  // pixels of the page

export class HistogramView {
  // chosen: called with the value when the user has moved it.
  constructor(canvas, number, chosen) {
    this.canvas = canvas;
    this.number = number;
    this.chosen = chosen;
    this.histogram = null;
    this.value = NaN;
    this.below = false;
    const take = (event) => {
      const box = canvas.getBoundingClientRect();
      this.set(this.#valueAt(Math.min(Math.max((event.clientX - box.left) / box.width, 0), 1)));
    };
    canvas.addEventListener('pointerdown', (event) => {
      if (!this.histogram || canvas.dataset.off) return;
      canvas.setPointerCapture(event.pointerId);
      take(event);
    });
    canvas.addEventListener('pointermove', (event) => { if (canvas.hasPointerCapture(event.pointerId)) take(event); });
    canvas.addEventListener('keydown', (event) => {
      const step = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
      if (!step || !this.histogram || canvas.dataset.off) return;
      event.preventDefault();
      this.set(this.value + (step * (this.histogram.high - this.histogram.low)) / BARS);
    });
    number.addEventListener('change', () => this.set(number.valueAsNumber));
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  show(histogram, value) {
    this.histogram = histogram;
    this.bars = histogram.bars(BARS);
    this.set(value);
  }

  // Within the image's range.
  set(value) {
    const { low, high } = this.histogram;
    if (Number.isFinite(value)) this.value = Math.min(Math.max(value, low), high);
    this.number.value = this.value;
    this.canvas.setAttribute('aria-valuenow', this.value);
    this.draw();
    this.chosen(this.value);
  }
  setBelow(below) {
    this.below = below;
    this.draw();
  }

  // What the mouse chooses has no more digits than pixels.
  #valueAt(part) {
    const { low, high } = this.histogram;
    const digits = Math.max(Math.ceil(-Math.log10((high - low) / 1000 || 1)), 0);
    return Number((low + part * (high - low)).toFixed(Math.min(digits, 100)));
  }

  draw() {
    const { width } = this.canvas.getBoundingClientRect();
    if (!this.histogram || width < 1) return;
    const ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(HEIGHT * ratio);
    const context = this.canvas.getContext('2d');
    context.scale(ratio, ratio);
    const { low, high } = this.histogram;
    const place = high > low ? (this.value - low) / (high - low) : 0.5;
    const most = Math.log1p(Math.max(...this.bars));
    const style = getComputedStyle(document.documentElement);
    const [faint, accent] = ['--faint', '--accent'].map((name) => style.getPropertyValue(name).trim());
    this.bars.forEach((count, i) => {
      const inside = this.below ? (i + 0.5) / BARS <= place : (i + 0.5) / BARS >= place;
      context.fillStyle = inside ? accent : faint;
      const height = count > 0 ? Math.max((Math.log1p(count) / most) * (HEIGHT - 8), 1) : 0;
      context.fillRect((i / BARS) * width, HEIGHT - height, width / BARS + 0.5, height);
    });
    context.fillStyle = style.getPropertyValue('--text').trim();
    context.fillRect(place * (width - 2), 0, 2, HEIGHT);
  }
}
