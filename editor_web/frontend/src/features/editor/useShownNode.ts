/** A node that is asked for is brought into view where it is not, and gets the keyboard. */
import { useReactFlow } from '@xyflow/react'
import { useEffect, useRef, useState, type RefObject } from 'react'
import { nodeOf } from '../../document/editing/model'
import { parentPath } from '../../document/path'
import type { CanvasEdge, CanvasNode } from './elements'
import { editor, rootOf, setEditor, useEditor } from './store'
import type { Arranged } from './useArrangement'
import type { CanvasNodes } from './useCanvasNodes'
import { trackMotionNextFrame } from './viewportMotion'

const READABLE_ZOOM = 0.4
const AROUND = { padding: 0.9, maxZoom: 1 }

export function useShownNode(element: RefObject<HTMLDivElement | null>, arranged: Arranged, { computed, given }: CanvasNodes): void {
  const { fitView, getZoom } = useReactFlow<CanvasNode, CanvasEdge>()
  const shown = useEditor((s) => s.shown)
  const [lookedFor, setLookedFor] = useState<typeof shown>()
  const handled = useRef<typeof shown>(undefined)

  useEffect(() => {
    if (!shown || handled.current === shown) return
    const { scope } = editor()
    const isDrawn = computed.some((node) => node.id === shown.path)
    const isCurrent = arranged.root === rootOf(editor()) && arranged.view === scope
    if (isCurrent && shown.path !== scope && nodeOf(arranged.root, shown.path) && !isDrawn) {
      // It is inside a container that is closed here: go there.
      setEditor({ scope: parentPath(shown.path) })
      return
    }
    if (given !== arranged) return
    return trackMotionNextFrame(() => {
      const target = element.current?.querySelector<HTMLElement>(`.react-flow__node[data-id="${CSS.escape(shown.path)}"]`)
      if (!target) {
        // Of many, only those in view are drawn: go there first.
        if (!isDrawn) return undefined
        return fitView({ nodes: [{ id: shown.path }], ...AROUND }).then(() => setLookedFor(shown))
      }
      handled.current = shown
      takeKeyboard(element.current, target)
      if (isWithin(element.current, target) && getZoom() >= READABLE_ZOOM) return undefined
      return fitView({ nodes: [{ id: shown.path }], ...AROUND, duration: 200 })
    })
  }, [element, shown, computed, arranged, given, fitView, getZoom, lookedFor])
}

/** Unless somebody writes elsewhere. */
function takeKeyboard(canvas: HTMLElement | null, target: HTMLElement): void {
  const { activeElement } = document
  if (!activeElement || activeElement === document.body || canvas?.contains(activeElement)) target.focus({ preventScroll: true })
}

function isWithin(canvas: HTMLElement | null, target: HTMLElement): boolean {
  const around = canvas?.getBoundingClientRect()
  const own = target.getBoundingClientRect()
  return (
    around !== undefined && own.left >= around.left && own.right <= around.right && own.top >= around.top && own.bottom <= around.bottom
  )
}
