/** Paths with `/`: of nodes in a behavior, of documents and recordings, of names on the bus. Made and read here only. Pure. */

/** The last part: the name of a node, a file with its ending. */
export function nameOfPath(path: string): string {
  return path.slice(path.lastIndexOf('/') + 1)
}

export function partsOfPath(path: string): readonly string[] {
  return path.split('/')
}

/** The first part: the arm of a skill, the source of a button. */
export function firstOfPath(path: string): string {
  return path.split('/', 1)[0] ?? ''
}

/** All but the last part; empty where there is one only. */
export function parentPath(path: string): string {
  return path.slice(0, Math.max(0, path.lastIndexOf('/')))
}

/** The paths from the root down to `path`, both included. */
export function pathsTo(path: string): readonly string[] {
  const parts = path.split('/')
  return parts.map((_, index) => parts.slice(0, index + 1).join('/'))
}

/** How many parts stand before the last one; 0 for the root. */
export function depthOf(path: string): number {
  return path.split('/').length - 1
}

/** All parts but the first; empty where there is one only. */
export function restOfPath(path: string): string {
  return path.slice(firstOfPath(path).length + 1)
}

/** All parts but the first, for people: `both › left`; a path of one part as it is. */
export function pathWords(path: string): string {
  const [, ...inner] = path.split('/')
  return inner.join(' › ') || path
}

/** The name of a document's file without its ending. */
export function fileTitle(id: string): string {
  return nameOfPath(id).replace(/\.(ya?ml|json)$/, '')
}

/** The way from one document's folder to another document, as a reference is written. */
export function relativePath(from: string, to: string): string {
  const here = from.split('/').slice(0, -1)
  const there = to.split('/')
  let same = 0
  while (same < here.length && same < there.length - 1 && here[same] === there[same]) same += 1
  return [...here.slice(same).map(() => '..'), ...there.slice(same)].join('/')
}

/** A path as a part of an address; its slashes stay. */
export function addressOf(path: string): string {
  return path.split('/').map(encodeURIComponent).join('/')
}

/** The path in the rest of an address, as `addressOf` has written it. */
export function pathOfAddress(parts: readonly string[]): string {
  return parts.map(decoded).join('/')
}

/** A part of an address; one that cannot be decoded as it is. */
export function decoded(part: string): string {
  try {
    return decodeURIComponent(part)
  } catch {
    return part
  }
}
