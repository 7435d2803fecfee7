/** The arrows and lines that React Flow draws, the selected one among them. */
import { useMemo } from 'react'
import { canvasEdges, type CanvasEdge } from './elements'
import { useEditor } from './store'
import type { Arranged } from './useArrangement'
import { useStableList } from './useStableList'

export function useCanvasEdges(arranged: Arranged): readonly CanvasEdge[] {
  const selection = useEditor((s) => s.selection)
  const arrow = useEditor((s) => s.arrow)
  return useStableList(
    useMemo(
      () => canvasEdges(arranged, selection).map((edge) => (edge.id === arrow ? { ...edge, selected: true } : edge)),
      [arranged, selection, arrow],
    ),
  )
}
