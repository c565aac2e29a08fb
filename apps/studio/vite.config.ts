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

// A folder of static files that any web host can serve, also below a path of its own.
export default defineConfig({
  base: './',
  resolve: { alias: { '@engine': at('../../build/wasm') } },
  build: {
    outDir: at('../../dist'), emptyOutDir: true, target: 'es2022', chunkSizeWarningLimit: 1000,
    rollupOptions: {
      input: { index: at('index.html'), service_worker: at('src/offline/service_worker.ts') },
      // A browser knows a service worker by its address, so that one stays.
      output: { entryFileNames: ({ name }) => (name === 'service_worker' ? '[name].js' : 'assets/[name]-[hash].js') },
    },
  },
  plugins: [onlyPacked(), installable()],
  worker: { format: 'es', plugins: () => [onlyPacked()] },
  preview: { host: '127.0.0.1', port: 8080, strictPort: true },
});
