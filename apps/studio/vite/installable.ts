// What makes the built page installable: icons, and a service worker that knows every file of its build by its hash.
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join, relative } from 'node:path';
import { decompress } from 'fzstd';
import type { Plugin } from 'vite';
import { iconPng } from './icon';

const serviceWorker = 'service_worker.js';
const sizes = [180, 192, 512]; // pixels: iOS, and the two that Chromium asks for

const hash = (bytes: Uint8Array) => `sha256-${createHash('sha256').update(bytes).digest('base64')}`;

/** What fetch() may give of it: a host that says how a packed file is packed has it unpacked by the browser. */
function hashesOf(path: string) {
  const bytes = readFileSync(path);
  return path.endsWith('.zst') ? `${hash(bytes)} ${hash(decompress(bytes))}` : hash(bytes);
}

export function installable(): Plugin {
  return {
    name: 'installable',
    apply: 'build',
    transformIndexHtml: () => [{ tag: 'link', attrs: { rel: 'apple-touch-icon', href: './icon_180.png' }, injectTo: 'head' }],
    generateBundle() {
      for (const size of sizes) this.emitFile({ type: 'asset', fileName: `icon_${size}.png`, source: iconPng(size) });
    },
    writeBundle({ dir }) {
      const paths = readdirSync(dir!, { recursive: true, withFileTypes: true })
        .filter((entry) => entry.isFile() && entry.name !== serviceWorker)
        .map((entry) => join(entry.parentPath, entry.name)).sort();
      // The page itself is asked for by its folder: a host may answer index.html with a redirect to it.
      const files = Object.fromEntries(paths.map((path) => [relative(dir!, path).replace(/^index\.html$/, ''), hashesOf(path)]));
      const script = join(dir!, serviceWorker), code = readFileSync(script, 'utf8');
      const version = createHash('sha256').update(JSON.stringify(files)).update(code).digest('hex').slice(0, 16);
      writeFileSync(script, `const version=${JSON.stringify(version)},builtFiles=${JSON.stringify(files)};${code}`);
    },
  };
}
