// serve.mjs FOLDER [PORT] [--plain]: static files with the headers that let a page share memory
// between threads; --plain leaves those out, as plain file hosts do.

import {createReadStream, statSync} from 'node:fs';
import {createServer} from 'node:http';
import {extname, join, normalize} from 'node:path';
import {pathToFileURL} from 'node:url';

const kTypes = {'.html': 'text/html', '.css': 'text/css', '.js': 'text/javascript',
  '.json': 'application/json', '.wasm': 'application/wasm'};

/// Resolves to a listening server; port 0 takes a free one.
export function serve(folder, port, isolated) {
  const server = createServer((request, response) => {
    const path = normalize(decodeURIComponent(new URL(request.url, 'http://host').pathname));
    const file = join(folder, path.endsWith('/') ? `${path}index.html` : path);
    try {
      const size = statSync(file).size;
      const headers = {'Content-Type': kTypes[extname(file)] ?? 'application/octet-stream',
        'Content-Length': size, 'Cache-Control': 'no-cache'};
      if (isolated) {
        headers['Cross-Origin-Opener-Policy'] = 'same-origin';
        headers['Cross-Origin-Embedder-Policy'] = 'require-corp';
      }
      response.writeHead(200, headers);
      createReadStream(file).pipe(response);
    } catch {
      response.writeHead(404).end();
    }
  });
  return new Promise((resolve) => server.listen(port, '127.0.0.1', () => resolve(server)));
}

if (import.meta.url === pathToFileURL(process.argv[1]).href) {
  const words = process.argv.slice(2).filter((word) => word !== '--plain');
  const server = await serve(words[0], Number(words[1] ?? 8000), !process.argv.includes('--plain'));
  console.log(`http://127.0.0.1:${server.address().port}/`);
}
