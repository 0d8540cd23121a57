// One extraction in a thread of its own: a message in, progress and the result out.
import { engineBytes, extractHere } from './engine.mjs';

const buffersOf = ({ vertices, faces }) => [vertices.buffer, faces.buffer];

async function work(port, { engine, voxels, dims, options, every }) {
  try {
    const result = await extractHere(engine ?? await engineBytes(), voxels, dims, options, {
      progress: (progress) => port.postMessage({ progress }),
      log: (level, line) => port.postMessage({ log: { level, line } }),
      preview: every === undefined ? null : (preview) => port.postMessage({ preview }, buffersOf(preview)),
      every,
    });
    const buffers = buffersOf(result);
    if (result.normals) buffers.push(result.normals.buffer);
    port.postMessage({ result }, buffers);
  } catch (error) {
    port.postMessage({ error: { status: error.status ?? 'internal', message: error.message } });
  }
}

// No await here: pages that are opened from disk can start a classic script alone.
if (typeof process === 'object' && process.versions?.node) {
  import('node:worker_threads').then(({ parentPort }) => parentPort.on('message', (data) => work(parentPort, data)));
} else {
  globalThis.onmessage = (event) => work(globalThis, event.data);
}
