/** Which containers of a graph are folded: those that a person has folded, or those with nothing active in them. */
import { useCallback, useMemo, useState } from 'react'
import { useLive } from '../../api/live'
import type { GraphNode } from '../../api/types'
import { lookup } from '../../document/dict'
import { drawnAt, folded, inactive, toggled, unfoldedTo, type Folded } from '../../document/folding'

export interface Folding {
  /** The behavior as it is drawn. */
  readonly drawn: GraphNode
  readonly hasFolded: boolean
  /** Whether containers fold and unfold by themselves, as the run goes on. */
  readonly hidesInactive: boolean
  readonly toggle: (path: string) => void
  readonly toggleInactive: () => void
  readonly expandAll: () => void
}

const NONE: Folded = new Set()

/** What is around `shown`, a node that was asked for, is unfolded, and what is around the `targets` to follow. */
export function useFolding(root: GraphNode, shown: { readonly path: string } | undefined, targets: string): Folding {
  const [byHand, setByHand] = useState(NONE)
  const [hidesInactive, setHidesInactive] = useState(false)
  // In one string, so that it changes only when a container becomes active or is left.
  const inactivePaths = useLive((s) =>
    hidesInactive ? inactive(root, (path) => lookup(s.nodes, path)?.status === 'active').join('\n') : '',
  )
  const paths = useMemo(
    () => (hidesInactive ? new Set(inactivePaths.split('\n').filter(Boolean)) : byHand),
    [hidesInactive, inactivePaths, byHand],
  )
  const drawn = useMemo(() => folded(root, paths), [root, paths])

  const [answered, setAnswered] = useState(shown)
  if (shown !== answered) {
    setAnswered(shown)
    if (shown && drawnAt(shown.path, paths) !== shown.path) {
      setByHand(unfoldedTo(shown.path, paths))
      setHidesInactive(false)
    }
  }

  const [open, setOpen] = useState('')
  if (targets !== open) {
    setOpen(targets)
    const around = targets.split('\n').reduce<Folded>((left, path) => unfoldedTo(path, left), byHand)
    if (around.size !== byHand.size) setByHand(around)
  }

  const toggle = useCallback(
    (path: string) => {
      // What was folded by itself stays as it is, from now on by hand.
      setByHand(toggled(path, paths))
      setHidesInactive(false)
    },
    [paths],
  )
  return {
    drawn,
    hasFolded: paths.size > 0,
    hidesInactive,
    toggle,
    toggleInactive: () => {
      setByHand(NONE)
      setHidesInactive(!hidesInactive)
    },
    expandAll: () => {
      setByHand(NONE)
      setHidesInactive(false)
    },
  }
}
