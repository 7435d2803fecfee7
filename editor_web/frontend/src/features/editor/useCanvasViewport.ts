/** What part of the canvas is seen: all of what fills it, until somebody has chosen otherwise. */
import { useCallbackRef } from '@mantine/hooks'
import { useReactFlow, useStore } from '@xyflow/react'
import { useEffect, useLayoutEffect, useRef, useState } from 'react'
import type { Size } from '../../document/geometry'
import { LARGE_GRAPH_NODES, LOW_DETAIL_ZOOM, setLowDetail } from './LowDetail'
import type { Arranged } from './useArrangement'
import { isAllSeen, viewportFor } from './viewport'
import { trackMotionNextFrame } from './viewportMotion'

export interface CanvasViewport {
  /** Has the view been put where it belongs? */
  readonly isInPlace: boolean
  readonly onMoveStart: (event: unknown) => void
}

export function useCanvasViewport(arranged: Arranged, { width, height }: Size): CanvasViewport {
  const { getViewport, setViewport } = useReactFlow()
  const [isInPlace, setInPlace] = useState(false)
  const isFitted = useRef(false)

  useEffect(() => {
    return trackMotionNextFrame(() => {
      isFitted.current = true
      return setViewport(viewportFor(arranged.arrangement, { width, height })).then(() => setInPlace(true))
    })
    // oxlint-disable-next-line react/exhaustive-deps -- what is edited does not move the view
  }, [arranged.view, width, height, setViewport])

  // What an edit pushes out of sight is brought back, unless somebody has chosen what to see.
  useEffect(() => {
    if (isFitted.current && !isAllSeen(arranged.arrangement, getViewport(), { width, height })) {
      void setViewport(viewportFor(arranged.arrangement, { width, height }))
    }
    // oxlint-disable-next-line react/exhaustive-deps -- a change of the pane has its own effect
  }, [arranged, getViewport, setViewport])

  const onMoveStart = useCallbackRef((event: unknown) => {
    // Without an event it is the page that moves it.
    if (event) isFitted.current = false
  })
  return { isInPlace, onMoveStart }
}

/** Draw plain boxes where many nodes are seen from far away. */
export function useLevelOfDetail(scope: string, count: number): { readonly hasMany: boolean; readonly isFar: boolean } {
  const hasMany = count > LARGE_GRAPH_NODES
  const isFar = useStore((s) => s.transform[2] < LOW_DETAIL_ZOOM) && hasMany
  useLayoutEffect(() => setLowDetail(isFar ? scope : undefined), [isFar, scope])
  useEffect(() => () => setLowDetail(undefined), [])
  return { hasMany, isFar }
}
