// Closed triangulated surfaces from 3D images, in a browser or in node; see README.md.
import { PellicleError } from './engine.mjs';

export { PellicleError };

const inNode = typeof process === 'object' && process.versions?.node;

async function startWorker() {
  const url = new URL('worker.mjs', import.meta.url);
  if (!inNode) return new Worker(url, { type: 'module' });
  const { Worker: NodeWorker } = await import('node:worker_threads');
  return new NodeWorker(url);
}

export async function extract(voxels, dims, options = {}) {
  const { signal, progress, log, preview, previewInterval = 250, engine, worker: hostsWorker, ...rest } = options;
  signal?.throwIfAborted();
  const worker = hostsWorker ? hostsWorker() : await startWorker();
  try {
    return await new Promise((resolve, reject) => {
      const receive = (message) => {
        if (message.progress) progress?.(message.progress);
        else if (message.preview) preview(message.preview);
        else if (message.log) log?.(message.log.level, message.log.line);
        else if (message.error) reject(new PellicleError(message.error.status, message.error.message));
        else resolve(message.result);
      };
      // What listens may throw: the extraction then ends with that.
      const guarded = (message) => {
        try {
          receive(message);
        } catch (error) {
          reject(error);
        }
      };
      if (inNode) {
        worker.on('message', guarded);
        worker.on('error', reject);
      } else {
        worker.onmessage = (event) => guarded(event.data);
        worker.onerror = (event) => reject(new PellicleError('internal', event.message ?? 'the worker cannot be started'));
      }
      signal?.addEventListener('abort', () => reject(signal.reason), { once: true });
      if (signal?.aborted) reject(signal.reason);
      worker.postMessage({ engine, voxels, dims, options: rest, every: preview ? previewInterval : undefined });
    });
  } finally {
    worker.terminate();  // a cancelled one in the middle of its work
  }
}
