/** How the program is built that draws behaviors without a browser, for `flexcell picture`: one file beside the page. */
import react from '@vitejs/plugin-react'
import { defineConfig } from 'vite'

export default defineConfig({
  plugins: [react()],
  define: { 'process.env.NODE_ENV': '"production"' },
  publicDir: false,
  build: {
    outDir: '../static',
    emptyOutDir: false,
    target: 'es2020',
    lib: { entry: 'src/app/pictureFile.tsx', formats: ['iife'], name: 'flexcell', fileName: () => 'picture.js' },
  },
})
