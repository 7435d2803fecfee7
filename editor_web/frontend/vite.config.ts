/** How the page is built: into the Python package, in files whose names carry their content's hash. */
import react from '@vitejs/plugin-react'
import { build, type Plugin } from 'vite'
import { defineConfig } from 'vitest/config'
import { notices } from './notices/plugin.ts'

/** Where `flexcell serve` listens, for `npm run dev`. */
const server = 'http://127.0.0.1:8642'

const thirdParty = notices()

/** The program of `flexcell picture` is built beside the page, after it: that build empties the folder. */
const picture: Plugin = {
  name: 'picture',
  apply: 'build',
  closeBundle: async () => void (await build({ configFile: 'vite.picture.config.ts', logLevel: 'warn' })),
}

export default defineConfig({
  plugins: [react(), thirdParty.page(), picture],
  build: {
    outDir: '../static',
    emptyOutDir: true,
    target: 'es2023',
    // The first of each that know light-dark(): what stands in for it needs a colour scheme that is written out.
    cssTarget: ['chrome123', 'firefox120', 'safari17.5'],
    chunkSizeWarningLimit: 1600,
    manifest: true,
    rolldownOptions: {
      // A file costs a request and time of its own: what the first page needs is one, what three views share another.
      output: {
        codeSplitting: {
          groups: [
            { name: 'first', tags: ['$initial'], priority: 2 },
            // What edits text is large, and no view shows it at once.
            {
              name: 'text',
              test: /node_modules\/(@codemirror|@lezer|crelt|style-mod|w3c-keyname)|components\/textFrame/,
              priority: 1.5,
            },
            { name: 'views', minShareCount: 3, priority: 1 },
          ],
        },
      },
    },
  },
  worker: { format: 'es', plugins: () => [thirdParty.worker()] },
  server: {
    proxy: {
      '/api': { target: server, ws: true },
      '/cell': { target: server, ws: true },
    },
  },
  test: {
    // How long a test takes depends on what else the machine does; one that never ends still fails.
    testTimeout: 60_000,
    projects: [
      // They share what is loaded: to load it anew for each file takes eight times as long as the tests.
      { extends: true, test: { name: 'functions', include: ['src/**/*.test.ts'], isolate: false } },
      {
        extends: true,
        test: {
          name: 'components',
          include: ['src/**/*.test.tsx'],
          environment: 'happy-dom',
          // Colours are read from it; other style sheets stay empty.
          css: { include: [/tokens\.css/] },
          isolate: false,
          setupFiles: 'testing/setup.ts',
        },
      },
    ],
  },
})
