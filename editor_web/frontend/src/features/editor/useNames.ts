/** The names that `${…}` can use at the selected node: parameters of the behavior, and userdata around it. */
import type { Dict } from '../../document/dict'
import { useMemo } from 'react'
import { allNodes, nodeOf, type EditNode } from '../../document/editing/model'
import type { Name } from '../../document/editing/completion'
import { pathsTo } from '../../document/path'
import { draftOf, rootOf, useEditor } from './store'

export function useNames(): readonly Name[] {
  const document = useEditor((s) => draftOf(s).document)
  const root = useEditor(rootOf)
  const path = useEditor((s) => s.selection.at(-1) ?? 'root')
  return useMemo(() => {
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
  }, [document, root, path])
}

function written(node: EditNode): readonly string[] {
  const own = [node.settings['as'], node.settings['index']].filter((key) => typeof key === 'string')
  return [...Object.values(node.outputs), ...own]
}

function detailOf(parameter: unknown): string {
  const given = typeof parameter === 'object' && parameter !== null ? (parameter as Dict<unknown>) : {}
  return [given['type'], given['unit']].filter((part) => typeof part === 'string' && part).join(' ')
}
