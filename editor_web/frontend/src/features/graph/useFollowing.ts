/** The view of a graph goes with the run until somebody moves it; then it stays, until it is asked to follow again. */
import { useCallbackRef, useReducedMotion } from '@mantine/hooks'
import { useReactFlow } from '@xyflow/react'
import { useEffect, useMemo, useRef, useState } from 'react'
import { useLive } from '../../api/live'
import { useHolds } from '../../api/liveParts'
import type { GraphNode } from '../../api/types'
import { lookup } from '../../document/dict'
import { placeOf, viewThatShows } from '../../document/following'
import type { Size } from '../../document/geometry'
import { pathsTo } from '../../document/path'
import { flatten, isContainer } from '../../document/tree'
import type { LaidOut } from './useLayout'

export interface Following {
  /** Does the view go with the run? */
  readonly isOn: boolean
  /** The paths of the active leaves and of what waits at a gate; in a paused run, where it stands. In one string, so that it changes only when they do. */
  readonly targets: string
  readonly resume: () => void
  /** Somebody moves the view: it stays where they put it. */
  readonly pause: () => void
}

export function useFollowing(root: GraphNode): Following {
  const run = useLive((s) => s.run)
  const [isOn, setOn] = useState(true)
  const [target, setTarget] = useState(run)
  const leaves = useMemo(
    () =>
      flatten(root)
        .filter((node) => !isContainer(node))
        .map((node) => node.path),
    [root],
  )
  const active = useLive((s) => leaves.filter((path) => lookup(s.nodes, path)?.status === 'active').join('\n'))
  const waiting = useHolds((control) => control?.waiting.map((each) => each.path).join('\n') ?? '')
  // At a breakpoint only the node that has stopped the run is looked at: what else is active is paused too, and may be far from it.
  const stopped = useHolds(
    (control) =>
      control?.waiting
        .filter((each) => each.reasons.includes('pause'))
        .map((each) => each.path)
        .join('\n') ?? '',
  )
  // What one has looked at before a run says nothing about that run.
  if (run !== target) {
    setTarget(run)
    setOn(true)
  }
  return {
    isOn,
    targets: stopped || [...new Set(`${active}\n${waiting}`.split('\n').filter(Boolean))].join('\n'),
    resume: () => setOn(true),
    pause: () => setOn(false),
  }
}

/** Move the view: to all of it at first, then to what is followed. Returns what is to be told when somebody moves it. */
export function useFollowView(laidOut: LaidOut, pane: Size, { isOn, targets, pause }: Following, showAll: () => void): () => void {
  const { getViewport, setViewport } = useReactFlow()
  const isStill = useReducedMotion() ?? false
  const isFitted = useRef(false)
  const isMoved = useRef(false)
  const { width, height } = pane

  useEffect(() => {
    const frame = requestAnimationFrame(() => {
      // While nothing has moved it, all of it is seen, whatever becomes of the pane.
      if (!isFitted.current || (!isMoved.current && targets === '')) showAll()
      isFitted.current = true
      if (!isOn || targets === '') return
      const { layout } = laidOut
      // What is inside of a collapsed container is seen where that is.
      const drawn = targets.split('\n').flatMap((path) => pathsTo(path).findLast((each) => layout.boxes.has(each)) ?? [])
      const view = viewThatShows(
        drawn.flatMap((path) => placeOf(path, layout) ?? []),
        getViewport(),
        { width, height },
      )
      if (view) void setViewport(view, { duration: isStill ? 0 : 300 })
      isMoved.current = true
    })
    return () => cancelAnimationFrame(frame)
  }, [laidOut, width, height, isOn, targets, isStill, getViewport, setViewport, showAll])

  return useCallbackRef(() => {
    isMoved.current = true
    if (targets !== '') pause()
  })
}
