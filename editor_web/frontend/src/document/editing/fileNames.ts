/** The id of a document, `behaviors/folder/name.yaml`, and its parts. Pure. */
import { partsOfPath } from '../path'

export interface FileParts {
  readonly folder: string
  readonly name: string
  /** `.yaml`, `.yml` or `.json`; it stays. */
  readonly ending: string
}

export function partsOfId(id: string): FileParts {
  const [, folder = '', name = id, ending = ''] = /^behaviors\/(?:(.*)\/)?([^/]*?)(\.[a-z]+)$/.exec(id) ?? []
  return { folder, name, ending }
}

export function idOfFile(folder: string, name: string, ending: string): string {
  return ['behaviors', folder.trim().replace(/^\/+|\/+$/g, ''), `${name.trim()}${ending}`].filter(Boolean).join('/')
}

/** What stands in the way of a name, or nothing. */
export function fileProblem(folder: string, name: string): string | undefined {
  if (!name.trim()) return 'It needs a name'
  if (!isPart(name.trim())) return 'A name begins with a letter or digit and has letters, digits, spaces, . _ and -'
  const parts = folder.trim().replace(/^\/+|\/+$/g, '')
  if (parts && !partsOfPath(parts).every(isPart)) return 'Folders have letters, digits, spaces, . _ and -, parted by /'
  if (name.trim().endsWith('.breakpoints')) return 'Such a file is for breakpoints'
  return undefined
}

function isPart(part: string): boolean {
  return /^[A-Za-z0-9_][A-Za-z0-9_. -]{0,70}$/.test(part) && !part.includes('..') && !part.endsWith('.')
}
