import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const at = (path: string) => fileURLToPath(new URL(path, import.meta.url));

// A folder of static files that any web host can serve, also below a path of its own.
export default defineConfig({
  base: './',
  resolve: { alias: { '@engine': at('../../build/wasm') } },
  build: { outDir: at('../../dist'), emptyOutDir: true, target: 'es2022', chunkSizeWarningLimit: 1000 },
  worker: { format: 'es' },
  preview: { host: '127.0.0.1', port: 8080, strictPort: true },
});
