/** What differs between two versions, in words and as marks on both drawings. Pure. */
import type { NodeChange } from '../../api/types'
import { edgeId, edgeOf, sourceOf } from '../edgeId'
import { allNodes, isMachine, type EditNode } from './model'
import { nameOfPath, parentPath, pathsTo } from '../path'

export type Marking = 'added' | 'removed' | 'changed'

export interface ChangeWords {
  /** The node that it is about; the behavior itself without. */
  readonly path: string | undefined
  readonly kind: 'added' | 'removed' | 'changed' | 'moved'
  readonly title: string
  readonly lines: readonly string[]
}

/** Without what follows from other changes: a container's order counts only where what stays changed places. */
export function meaningful(changes: readonly NodeChange[]): readonly NodeChange[] {
  return changes.flatMap((change) => {
    const fields = change.fields.filter(({ field, before, after }) => !field.endsWith('.order') || isReordered(before, after))
    if (fields.length === 0 && change.fields.length > 0 && change.change === 'changed') return []
    return [{ ...change, fields }]
  })
}

function isReordered(before: unknown, after: unknown): boolean {
  if (!Array.isArray(before) || !Array.isArray(after)) return true
  const stayed = before.filter((name) => after.includes(name))
  return stayed.some((name, index) => name !== after.filter((each) => before.includes(each))[index])
}

export function wordsOfChange(change: NodeChange): ChangeWords {
  const isDocument = change.path === 'document'
  const name = isDocument ? 'The behavior' : change.path === 'root' ? 'The outermost container' : nameOfPath(change.path)
  const around = parentPath(change.path)
  const place = isDocument || around === 'root' || around === '' ? '' : ` in ${nameOfPath(around)}`
  const lines = change.fields.map(({ field, before, after }) => fieldWords(field, before, after))
  switch (change.change) {
    case 'added':
      return { path: change.path, kind: 'added', title: `${name} added${place}`, lines }
    case 'removed':
      return { path: change.path, kind: 'removed', title: `${name} removed${place}`, lines }
    case 'moved':
      return { path: change.path, kind: 'moved', title: movedWords(change.before_path ?? '', change.path), lines }
    default:
      return {
        path: isDocument ? undefined : change.path,
        kind: 'changed',
        title: `${name} changed${place}`,
        lines,
      }
  }
}

function movedWords(before: string, after: string): string {
  const [was, is] = [nameOfPath(before), nameOfPath(after)]
  if (parentPath(before) === parentPath(after)) return `${was} renamed to ${is}`
  const into = nameOfPath(parentPath(after))
  return `${was} moved into ${into === 'root' ? 'the behavior itself' : into}${was === is ? '' : ` as ${is}`}`
}

function fieldWords(field: string, before: unknown, after: unknown): string {
  if (field === 'view') return 'places on the canvas'
  const [, name, part] = /^canvas_notes\.[^.]+\.([^.]+)\.(\w+)$/.exec(field) ?? []
  if (name !== undefined && part !== undefined && part !== 'text') return `${part} of the note ${name} on the canvas`
  if (field.endsWith('.order')) return `order: ${(Array.isArray(after) ? after : []).join(', ')}`
  const what = field
    .replace(/^with\./, '')
    .replace(/^canvas_notes\.[^.]+\.([^.]+)\.text$/, 'note $1 on the canvas')
    .replace(/^transitions\.(.*)$/, '$1 leads to')
    .replace(/^(machine|priority)\.initial$/, 'begins with')
  if (before === null || before === undefined) return `${what}: ${shown(after)}`
  if (after === null || after === undefined) return `${what}: ${shown(before)} taken away`
  return `${what}: ${shown(before)} → ${shown(after)}`
}

const LONGEST = 120

function shown(value: unknown): string {
  const words = typeof value === 'string' ? value : (JSON.stringify(value) ?? '')
  return words.length > LONGEST ? `${words.slice(0, LONGEST)}…` : words
}

export interface Markings {
  readonly before: ReadonlyMap<string, Marking>
  readonly after: ReadonlyMap<string, Marking>
}

/** The marks of nodes and arrows in the older and in the newer drawing. */
export function markingsOf(changes: readonly NodeChange[], before: EditNode | undefined, after: EditNode | undefined): Markings {
  const older = new Map<string, Marking>()
  const newer = new Map<string, Marking>()
  for (const change of changes) {
    if (change.path === 'document') continue
    if (change.change === 'added') newer.set(change.path, 'added')
    else if (change.change === 'removed') older.set(change.path, 'removed')
    else {
      older.set(change.before_path ?? change.path, 'changed')
      newer.set(change.path, 'changed')
    }
  }
  const [was, is] = [arrowsOf(before), arrowsOf(after)]
  for (const [id, target] of was) if (is.get(id) !== target) older.set(id, is.has(id) ? 'changed' : 'removed')
  for (const [id, target] of is) if (was.get(id) !== target) newer.set(id, was.has(id) ? 'changed' : 'added')
  return { before: older, after: newer }
}

function arrowsOf(root: EditNode | undefined): ReadonlyMap<string, string> {
  const machines = root ? allNodes(root).filter((node) => isMachine(node.kind)) : []
  return new Map(
    machines.flatMap((machine) =>
      machine.transitions.map((t) => [edgeId({ machine: machine.path, source: t.source, outcome: t.outcome }), t.target] as const),
    ),
  )
}

/** The containers that have to be open for what is marked to be seen. */
export function containersOfMarks(markings: ReadonlyMap<string, Marking>): ReadonlySet<string> {
  const paths = [...markings.keys()].map((id) => {
    const edge = edgeOf(id)
    return edge ? sourceOf(edge) : id
  })
  return new Set(paths.flatMap((path) => pathsTo(path).slice(0, -1)))
}
