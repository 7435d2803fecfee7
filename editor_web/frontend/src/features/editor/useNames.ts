/** The names that `${…}` can use at the selected node: parameters of the behavior, and userdata around it. */
import type { Dict } from '../../document/dict'
import { allNodes, nodeOf, ROOT, type Draft, type EditNode } from '../../document/editing/model'
import type { Name } from '../../document/editing/completion'
import { pathsTo } from '../../document/path'
import { draftOf, editor, rootOf, useEditor } from './store'

interface Known {
  readonly document: Draft['document']
  readonly path: string
  readonly names: readonly Name[]
}

/** Of each graph those asked for last: every field of a form asks. */
const known = new WeakMap<EditNode, Known>()

export function useNames(): readonly Name[] {
  return useEditor(namesNow)
}

/** For what is done when somebody types, which need not follow every edit. */
export function namesNow(state = editor()): readonly Name[] {
  const root = rootOf(state)
  const { document } = draftOf(state)
  const path = state.selection.at(-1) ?? ROOT
  const before = root && known.get(root)
  if (before?.document === document && before?.path === path) return before.names
  const names = namesAt(document, root, path)
  if (root) known.set(root, { document, path, names })
  return names
}

function namesAt(document: Draft['document'], root: EditNode | undefined, path: string): readonly Name[] {
  const parameters = Object.entries(document?.parameters ?? {}).map(([name, given]): Name => ({
    name,
    origin: 'parameter',
    detail: detailOf(given),
  }))
  const keys = new Map<string, Name>()
  const userdata = (names: Iterable<string>, detail: string) => {
    for (const name of names) if (!keys.has(name)) keys.set(name, { name, origin: 'userdata', detail })
  }
  userdata(Object.keys(document?.userdata ?? {}), 'of the behavior')
  if (root) {
    for (const above of pathsTo(path)) userdata(Object.keys(nodeOf(root, above)?.userdata ?? {}), `of ${above}`)
    for (const node of allNodes(root)) userdata(written(node), `written by ${node.name}`)
  }
  return [...parameters, ...keys.values()]
}

function written(node: EditNode): readonly string[] {
  const own = [node.settings['as'], node.settings['index']].filter((key) => typeof key === 'string')
  return [...Object.values(node.outputs), ...own]
}

function detailOf(parameter: unknown): string {
  const given = typeof parameter === 'object' && parameter !== null ? (parameter as Dict<unknown>) : {}
  return [given['type'], given['unit']].filter((part) => typeof part === 'string' && part).join(' ')
}
