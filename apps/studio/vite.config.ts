import { fileURLToPath } from 'node:url';
import { defineConfig, type Plugin } from 'vite';
import { installable } from './vite/installable';

const at = (path: string) => fileURLToPath(new URL(path, import.meta.url));

// The page loads the packed engine alone.
const onlyPacked = (): Plugin => ({
  name: 'only-packed',
  generateBundle(_, bundle) {
    for (const name of Object.keys(bundle)) if (/limber_engine.*\.wasm$/.test(name)) delete bundle[name];
  },
});

// js-aruco2 is plain scripts that hang their names on `this`.
const plainScripts = (): Plugin => ({
  name: 'plain-scripts',
  transform(code, id) {
    if (!/js-aruco2\/src\/.*\.js$/.test(id)) return;
    const needed = [...new Set([...code.matchAll(/require\(['"](.+?)['"]\)/g)].map(([, name]) => name!))];
    const exported = [...new Set([...code.matchAll(/^this\.(\w+) = /gm)].map(([, name]) => name!))];
    return `${needed.map((name, i) => `import * as needed${i} from '${name}.js';`).join('\n')}
const scope = {}, needed = { ${needed.map((name, i) => `'${name}': needed${i}`).join(', ')} };
(function (require) {${code}\n}).call(scope, (name) => needed[name]);
export const { ${exported.join(', ')} } = scope;`;
  },
});

// A folder of static files that any web host can serve, also below a path of its own.
export default defineConfig({
  base: './',
  resolve: { alias: { '@engine': at('../../build/wasm'), '@shapes': at('../../limber/reading/data') } },
  build: {
    outDir: at('../../dist'), emptyOutDir: true, target: 'es2022', chunkSizeWarningLimit: 1000,
    rollupOptions: {
      input: { index: at('index.html'), service_worker: at('src/offline/service_worker.ts') },
      // A browser knows a service worker by its address, so that one stays.
      output: { entryFileNames: ({ name }) => (name === 'service_worker' ? '[name].js' : 'assets/[name]-[hash].js') },
    },
  },
  optimizeDeps: { exclude: ['js-aruco2'] },
  ssr: { noExternal: ['js-aruco2'] },
  plugins: [onlyPacked(), plainScripts(), installable()],
  worker: { format: 'es', plugins: () => [onlyPacked(), plainScripts()] },
  preview: { host: '127.0.0.1', port: 8080, strictPort: true },
});
