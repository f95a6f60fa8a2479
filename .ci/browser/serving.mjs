// Serves the files of a page.

import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

const TYPES = { html: 'text/html', js: 'text/javascript', wasm: 'application/wasm' };

// Returns a function that answers requests with the files of `folder`.
export function serving(folder) {
  return async (request, response) => {
    const name = new URL(request.url, 'http://localhost').pathname.slice(1) || 'index.html';
    if (!/^[\w.]+$/.test(name)) return response.writeHead(404).end();
    const type = TYPES[name.split('.').pop()] ?? 'application/octet-stream';
    try {
      const body = await readFile(join(folder, name));
      response.writeHead(200, { 'content-type': type }).end(body);
    } catch {
      response.writeHead(404).end();
    }
  };
}
