/** Writes THIRD-PARTY-NOTICES.txt: every package that a module of the page comes from, with its licence's whole text. */
import type { Plugin, Rolldown } from 'vite'

type Files = Rolldown.PluginContext['fs']

/** What a package says about itself. */
interface Manifest {
  readonly name: string
  readonly version: string
  readonly license?: string
}

const FILE = 'THIRD-PARTY-NOTICES.txt'
const HEAD = 'Third-party software in the page of flexcell.'
const RULE = '='.repeat(80)
/** What the folder of a package calls the texts that have to go with it. */
const TEXTS = /^(licen[cs]e|copying|notice)([.-]|$)/i
/** The innermost package of a path: its folder, and its name. */
const PACKAGE = /^(.*\/node_modules\/((?:@[^/]+\/)?[^/]+))\//
/** Modules in no file begin with this, as those that load others; their authors follow. */
const VIRTUAL = '\0'
const AUTHORS = /^\0(vite|rolldown)\//

/** The plugin for the page, and the one for its workers, which are built one by one and come in no bundle of the page. */
export function notices(): { page: () => Plugin; worker: () => Plugin } {
  const folders = new Set<string>()
  let root = ''
  const collect = (ids: Iterable<string>) => {
    for (const id of ids) {
      const folder = folderOf(id, root)
      if (folder) folders.add(folder)
    }
  }
  return {
    page: () => ({
      name: 'notices',
      apply: 'build',
      configResolved: (config) => void (root = config.root),
      async generateBundle(_, bundle) {
        collect(this.getModuleIds())
        // The runtime of the bundler is in no list but this one.
        for (const output of Object.values(bundle)) if (output.type === 'chunk') collect(output.moduleIds)
        const texts = await Promise.all([...folders].sort().map((folder) => notice(folder, root, this.fs)))
        this.emitFile({ type: 'asset', fileName: FILE, source: [HEAD, ...texts.sort()].join(`\n\n${RULE}\n\n`) + '\n' })
      },
    }),
    worker: () => ({
      name: 'notices-of-worker',
      apply: 'build',
      buildEnd() {
        collect(this.getModuleIds())
      },
    }),
  }
}

/** The folder of the package that a module comes from, unless it is one of ours. */
function folderOf(id: string, root: string): string | undefined {
  const author = AUTHORS.exec(id)?.[1]
  if (!author && id.startsWith(VIRTUAL))
    throw new Error(`nobody knows whose module ${JSON.stringify(id)} is: name its author in notices/plugin.ts`)
  return author ? `${root}/node_modules/${author}` : PACKAGE.exec(id)?.[1]
}

/** Name, version, licence and texts of one package; without a text there is no build. */
async function notice(folder: string, root: string, files: Files): Promise<string> {
  const { name, version, license } = JSON.parse(await read(files, `${folder}/package.json`)) as Manifest
  const own = (await files.readdir(folder)).filter((file) => TEXTS.test(file)).sort()
  const paths = own.length > 0 ? own.map((file) => `${folder}/${file}`) : [`${root}/notices/licences/${fileName(name)}`]
  const texts = await Promise.all(paths.map((path) => read(files, path)))
  return [`${name} ${version}`, `Licence: ${license}`, ...texts.map((text) => text.trim())].join('\n\n')
}

/** A scoped name has a slash. */
function fileName(name: string): string {
  return `${name.replace('/', '__')}.txt`
}

function read(files: Files, path: string): Promise<string> {
  return files.readFile(path, { encoding: 'utf8' })
}
