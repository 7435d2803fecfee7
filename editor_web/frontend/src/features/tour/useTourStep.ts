/** Follows what the page shows while the tour is on: where its step is done, and when it was. */
import { useEffect, useState } from 'react'
import { useLive } from '../../api/live'
import { setTour, useTour } from '../../api/tour'
import { isActive } from '../../document/runState'
import type { Box } from './place'
import { STEPS, targetOf, type Facts } from './steps'

// The elements belong to other parts of the page, which do not tell when they move.
const LOOK_MS = 120
/** A step counts when it was seen done this often in a row: the check of a document comes a moment after the edit. */
const SEEN = 4

export interface Seen {
  readonly target: HTMLElement | undefined
  readonly box: Box | undefined
  /** What has to stay free. */
  readonly clear: readonly Box[]
  /** The open dialog, on top of which the tour has to be. */
  readonly dialog: HTMLElement | undefined
}

export function useTourStep(page: string, id: string): Seen {
  const [seen, setSeen] = useState<Seen>({ target: undefined, box: undefined, clear: [], dialog: undefined })
  useEffect(() => {
    let times = 0
    let last = ''
    function look(): void {
      const { step: at, document: made } = useTour.getState()
      const step = STEPS[at]
      times = step?.isDone(factsOf(page, made)) ? times + 1 : 0
      if (step && times >= SEEN) {
        times = 0
        // The document that is made in it is known once its editor is open.
        setTour({ step: at + 1, document: page === 'edit' && made === '' ? id : made })
        // At once: the words of a step beside what the one before was about would cover what is to be done.
        look()
        return
      }
      const target = step && targetOf(step)
      const dialog = document.querySelector<HTMLElement>('dialog[open]') ?? undefined
      const box = target && boxOf(target)
      const clear = step?.clear ? [...document.querySelectorAll<HTMLElement>(step.clear)].map(boxOf) : []
      const now = JSON.stringify([at, box, clear, dialog !== undefined])
      if (now !== last) setSeen({ target, box, clear, dialog })
      last = now
    }
    look()
    const timer = setInterval(look, LOOK_MS)
    return () => clearInterval(timer)
  }, [page, id])
  return seen
}

function factsOf(page: string, made: string): Facts {
  const run = useLive.getState().runs.find((each) => each.behavior === made)
  return { page, document: made, run: run && (isActive(run) ? 'active' : 'over') }
}

function boxOf(element: HTMLElement): Box {
  const { left, top, width, height } = element.getBoundingClientRect()
  return { left, top, width, height }
}
