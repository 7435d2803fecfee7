/** Keeps React Flow from placing anew, with each frame of a drag, everything that is drawn in the dragged container. */
import { useStoreApi, type ReactFlowState } from '@xyflow/react'
import { useEffect, useMemo, useState, type RefObject } from 'react'
import type { CanvasEdge, CanvasNode } from './elements'
import { draggedFrames, elementsInside, shiftOfFrame, withAnchors, type DraggedFrame } from './frameDrag'

export interface FrameDrag {
  /** What React Flow is to draw. */
  readonly nodes: CanvasNode[]
  readonly begin: (dragged: readonly CanvasNode[]) => void
  readonly end: () => void
}

const NONE: readonly DraggedFrame[] = []

/** Not where only what is in view is drawn: React Flow looks for that at places that it knows. */
export function useFrameDrag(canvas: RefObject<HTMLElement | null>, nodes: CanvasNode[], drawsAll: boolean): FrameDrag {
  const store = useStoreApi<CanvasNode, CanvasEdge>()
  const [frames, setFrames] = useState(NONE)

  useEffect(() => {
    if (frames.length === 0) return
    const follow = frames.map((frame) => followerOf(frame, canvas))
    const each = (state = store.getState()): void => follow.forEach(({ move }) => move(state))
    each()
    const stop = store.subscribe(each)
    return () => {
      stop()
      follow.forEach(({ end }) => end())
    }
  }, [frames, store, canvas])

  return {
    nodes: useMemo(() => (frames.length > 0 ? withAnchors(nodes, frames) : nodes), [nodes, frames]),
    begin: (dragged) => setFrames(drawsAll ? draggedFrames(dragged) : NONE),
    end: () => setFrames(NONE),
  }
}

type FlowState = Pick<ReactFlowState<CanvasNode, CanvasEdge>, 'nodeLookup' | 'edges'>

/** Moves the drawing of what is in one frame with it, in the same turn in which React Flow moves the frame. */
function followerOf({ path, anchor }: DraggedFrame, canvas: RefObject<HTMLElement | null>) {
  let [edges, size]: [FlowState['edges'] | undefined, number] = [undefined, 0]
  let inside: ReturnType<typeof elementsInside> = []
  const shift = (by: string): void => inside.forEach((each) => (each.style.translate = by))
  return {
    move: (state: FlowState): void => {
      const [from, to] = [state.nodeLookup.get(anchor.id)?.internals, state.nodeLookup.get(path)?.internals]
      if (!canvas.current || !from || !to) return
      // What the server answers meanwhile is drawn too.
      if (state.edges !== edges || state.nodeLookup.size !== size) inside = elementsInside(canvas.current, path)
      ;[edges, size] = [state.edges, state.nodeLookup.size]
      shift(shiftOfFrame(to.positionAbsolute, from.positionAbsolute))
    },
    end: () => shift(''),
  }
}
