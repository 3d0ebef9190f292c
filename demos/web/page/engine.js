// The page's end of the engine: one promise per message to the worker.

/// How many threads this page may use: all cores up to 4 where memory may be shared, else 1. The
/// address may ask for fewer: ?threads=1; ?single takes the build without threads.
export function chooseBuild(address, isolated, cores) {
  const wish = new URLSearchParams(address);
  if (!isolated || wish.has('single')) {
    return {name: 'single', threads: 1};
  }
  const most = Math.min(cores || 1, 4);
  const threads = Math.min(Math.max(Number(wish.get('threads')) || most, 1), 8);
  return {name: 'threads', threads};
}

export class Engine {
  #worker = new Worker('engine_worker.js');
  #waiting = new Map();
  #last = 0;

  constructor() {
    this.#worker.onmessage = ({data}) => {
      const {resolve, reject} = this.#waiting.get(data.id);
      this.#waiting.delete(data.id);
      if (data.error === undefined) {
        resolve(data.value);
      } else {
        reject(new Error(data.error));
      }
    };
    this.#worker.onerror = (event) => {
      for (const {reject} of this.#waiting.values()) {
        reject(new Error(event.message || 'the engine stopped'));
      }
      this.#waiting.clear();
    };
  }

  /// Resolves to what the worker's operation `op` returns.
  ask(op, values = {}) {
    const id = ++this.#last;
    return new Promise((resolve, reject) => {
      this.#waiting.set(id, {resolve, reject});
      this.#worker.postMessage({id, op, ...values});
    });
  }

  /// Resolves to the catalogue of scenes, presets and views.
  start(build) {
    const base = new URL(`${build.name}/`, document.baseURI).href;
    return this.ask('start', {threads: build.threads, base});
  }
}
