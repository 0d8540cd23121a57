// What is drawn over the views: in pixels of the page, not of vtk.js, as WebGL's lines are one pixel wide.
import { millimetres, state } from './state.js';
import { length, sub } from './vectors.js';

const MARK = '#ffe14d';

export function outlined(context, words, x, y) {
  context.lineWidth = 3;
  context.lineJoin = 'round';
  context.strokeStyle = 'rgba(0, 0, 0, 0.75)';
  context.strokeText(words, x, y);
  context.fillText(words, x, y);
}

export function font(context, size, weight = 400) {
  context.font = `${weight} ${size}px system-ui, sans-serif`;
}

// project: a place to [x, y], and whether it is near what the view shows.
export function drawDistances(context, project) {
  font(context, 13, 600);
  context.textAlign = 'left';
  context.textBaseline = 'middle';
  for (const places of state.distances) {
    const ends = places.map(project);
    context.globalAlpha = ends.every(({ near }) => near) ? 1 : 0.35;
    context.strokeStyle = MARK;
    context.fillStyle = MARK;
    context.lineWidth = 1.5;
    if (ends.length === 2) {
      context.beginPath();
      context.moveTo(ends[0].x, ends[0].y);
      context.lineTo(ends[1].x, ends[1].y);
      context.stroke();
    }
    for (const { x, y } of ends) {
      context.beginPath();
      context.arc(x, y, 3.5, 0, 2 * Math.PI);
      context.fill();
    }
    if (ends.length === 2) {
      const [x, y] = [(ends[0].x + ends[1].x) / 2, (ends[0].y + ends[1].y) / 2];
      outlined(context, `${millimetres(length(sub(places[0], places[1])))} mm`, x + 8, y - 10);
    }
  }
  context.globalAlpha = 1;
}

// A bar of a round length, as long as a fifth of the view at most.
export function drawScaleBar(context, pixelsPerMm, width, height) {
  const most = width / 5 / pixelsPerMm;
  const power = 10 ** Math.floor(Math.log10(most));
  const size = [5, 2, 1].map((f) => f * power).find((x) => x <= most);
  const pixels = size * pixelsPerMm;
  const [right, y] = [width - 12, height - 34];
  context.strokeStyle = '#e4e8ee';
  context.fillStyle = '#e4e8ee';
  context.lineWidth = 1.5;
  context.beginPath();
  context.moveTo(right - pixels, y - 4);
  context.lineTo(right - pixels, y);
  context.lineTo(right, y);
  context.lineTo(right, y - 4);
  context.stroke();
  font(context, 11);
  context.textAlign = 'right';
  context.textBaseline = 'bottom';
  const name = size >= 10 && size % 10 === 0 ? `${size / 10} cm` : `${Number(size.toPrecision(1))} mm`;
  outlined(context, name, right, y - 5);
}
