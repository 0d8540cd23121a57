// Colours of surfaces, labels and values.
export const SURFACE_COLOURS = ['#ffb454', '#4cc3e0', '#f47ba8', '#8bd46a', '#b79bf7', '#f4694e', '#f2e05c', '#58d6b0', '#d99a6c', '#7fa2ff'];

// Viridis, but for its dark end, which is not seen on black.
const VIRIDIS = ['#5a4fb0', '#4764b5', '#31688e', '#26828e', '#1f9e89', '#35b779', '#6ece58', '#b5de2b', '#fde725'];
const BLUE_RED = ['#3b4cc0', '#6788ee', '#9abbff', '#c9d7f0', '#edd1c2', '#f7a889', '#e26952', '#b40426'];
const NONE = [128, 128, 128];  // where there is no value
export const STEPS = 64;       // colours of a scale

export function rgbOf(hex) {
  return [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
}

function between(colours, t) {
  const at = Math.min(Math.max(t, 0), 1) * (colours.length - 1);
  const k = Math.min(Math.floor(at), colours.length - 2);
  const [a, b] = [rgbOf(colours[k]), rgbOf(colours[k + 1])];
  return a.map((x, i) => Math.round(x + (at - k) * (b[i] - x)));
}

// Neighbouring labels differ in hue: by the golden angle.
function labelColour(label) {
  if (label <= 0) return NONE;
  const hue = (label * 137.508) % 360;
  const channel = (n) => {
    const k = (n + hue / 30) % 12;
    return Math.round(255 * (0.62 - 0.32 * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [channel(0), channel(8), channel(4)];
}

// What values look like: `range` is where they mostly are; `of` gives the number of a colour, or -1.
export class Scale {
  constructor(name, values) {
    const known = values.filter((x) => Number.isFinite(x)).sort();
    const at = (part) => (known.length ? known[Math.round(part * (known.length - 1))] : 0);
    this.labels = /label/i.test(name) && known.every((x) => Number.isInteger(x) && Math.abs(x) <= 2 ** 24);
    this.least = at(0);
    this.most = at(1);
    this.signed = this.least < 0 && this.most > 0;
    const [low, high] = [at(0.02), at(0.98)];
    this.range = this.signed ? [-Math.max(-low, high), Math.max(-low, high)] : [low, high];
    this.colours = this.labels ? null : Array.from({ length: STEPS }, (_, i) => between(this.signed ? BLUE_RED : VIRIDIS, i / (STEPS - 1)));
  }

  // The number of a value's colour: the label, or a step of the scale; -1 where there is none.
  step(value) {
    if (!Number.isFinite(value)) return -1;
    if (this.labels) return Math.round(value);
    const [low, high] = this.range;
    const t = high > low ? (value - low) / (high - low) : 0.5;
    return Math.round(Math.min(Math.max(t, 0), 1) * (STEPS - 1));
  }
  colour(step) {
    if (step < 0) return NONE;
    return this.labels ? labelColour(step) : this.colours[step];
  }
  get css() {
    return `linear-gradient(90deg, ${this.colours.filter((_, i) => i % 7 === 0).map((c) => `rgb(${c})`).join(', ')})`;
  }
}
