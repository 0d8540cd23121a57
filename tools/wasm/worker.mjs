// One extraction in a thread of its own: a message in, progress and the result out.
import { engineBytes, extractHere } from './engine.mjs';

const inNode = typeof process === 'object' && process.versions?.node;
const port = inNode ? (await import('node:worker_threads')).parentPort : globalThis;

async function work({ voxels, dims, options }) {
  try {
    const result = await extractHere(await engineBytes(), voxels, dims, options, {
      progress: (progress) => port.postMessage({ progress }),
      log: (level, line) => port.postMessage({ log: { level, line } }),
    });
    const buffers = [result.vertices.buffer, result.faces.buffer];
    if (result.normals) buffers.push(result.normals.buffer);
    port.postMessage({ result }, buffers);
  } catch (error) {
    port.postMessage({ error: { status: error.status ?? 'internal', message: error.message } });
  }
}

if (inNode) port.on('message', work);
else port.onmessage = (event) => work(event.data);
