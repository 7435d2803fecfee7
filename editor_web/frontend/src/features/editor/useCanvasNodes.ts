/** The nodes that React Flow draws: given in batches, and selected as the editor has them selected. */
import { applyNodeChanges, useReactFlow, type NodeChange } from '@xyflow/react'
import { useCallback, useEffect, useMemo, useState } from 'react'
import { choose } from './actions'
import { drawInBatches } from './batchedDrawing'
import { setCanvasPositions } from './canvasPositions'
import { canvasNodes, type CanvasEdge, type CanvasNode, type KeptCards } from './elements'
import { editor, useEditor } from './store'
import type { Arranged } from './useArrangement'
import { useStableList } from './useStableList'

export interface CanvasNodes {
  /** All that are to be drawn. */
  readonly computed: readonly CanvasNode[]
  /** Those that React Flow has, with what it has measured. */
  readonly nodes: CanvasNode[]
  /** What React Flow was given last with all its nodes. */
  readonly given: Arranged | undefined
  readonly onNodesChange: (changes: NodeChange<CanvasNode>[]) => void
  /** Draw each node where it belongs again. */
  readonly putBack: () => void
}

export function useCanvasNodes(arranged: Arranged): CanvasNodes {
  const { getInternalNode } = useReactFlow<CanvasNode, CanvasEdge>()
  const selection = useEditor((s) => s.selection)
  const [kept] = useState((): KeptCards => new WeakMap())
  const computed = useStableList(useMemo(() => canvasNodes(arranged, kept), [arranged, kept]))
  const [nodes, setNodes] = useState<CanvasNode[]>([...computed])
  const [given, setGiven] = useState<Arranged>()

  useEffect(() => {
    setCanvasPositions(arranged.arrangement)
    const chosen = new Set(selection)
    const all = computed.map((node) => (chosen.has(node.id) ? { ...node, selected: true } : node))
    const isThere = (id: string) => getInternalNode(id) !== undefined
    return drawInBatches(all, { isThere, give: setNodes, done: () => setGiven(arranged) })
  }, [arranged, computed, selection, getInternalNode])

  const onNodesChange = useCallback((changes: NodeChange<CanvasNode>[]) => {
    const picks = changes.filter((change) => change.type === 'select')
    if (picks.length > 0) {
      const now = new Set(editor().selection)
      for (const pick of picks) {
        if (pick.selected) now.add(pick.id)
        else now.delete(pick.id)
      }
      choose([...now])
    }
    const others = changes.filter((change) => change.type !== 'select')
    if (others.length > 0) setNodes((before) => applyNodeChanges(others, before))
  }, [])

  return { computed, nodes, given, onNodesChange, putBack: () => setNodes([...computed]) }
}
