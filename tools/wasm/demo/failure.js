// What is wrong with a file or a choice, in one line for the user.
export class Failure extends Error {}
export function refuse(line) { throw new Failure(line); }

// One line of any error: of ours, of the engine, of the browser.
export function lineOf(error) {
  if (error instanceof Failure || error.name === 'PellicleError') return error.message;
  if (error instanceof RangeError) return `this browser has not enough memory (${error.message})`;
  return `${error.name}: ${error.message}`.split('\n')[0];
}
