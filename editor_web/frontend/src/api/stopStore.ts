/** The STOP that the page has asked for last, and what waits for its acknowledgement. */
import { isAcknowledged, type StopProgress } from '../document/stopReport'
import { pageStore } from './pageStore'

interface StopStore {
  readonly stop: StopProgress | undefined
  /** How many stops this page has given. */
  readonly count: number
}

export const useStop = pageStore<StopStore>(() => ({ stop: undefined, count: 0 }))

export interface Taker<T> {
  readonly take: (item: T) => void
  /** Take nothing any more. */
  readonly end: () => void
}

/** Give what takes items one after the other, and lets them wait while a STOP does: showing them takes the time of its words. */
export function afterStop<T>(take: (item: T) => void): Taker<T> {
  let waiting: T[] = []
  const takeWaiting = () => {
    if (isAwaited()) return
    const due = waiting
    waiting = []
    for (const item of due) take(item)
  }
  // In a task of its own: what is told of the STOP is on the screen by then.
  const unsubscribe = useStop.subscribe(() => waiting.length > 0 && !isAwaited() && setTimeout(takeWaiting))
  return {
    take: (item) => {
      if (isAwaited() || waiting.length > 0) waiting.push(item)
      else take(item)
    },
    end: () => {
      unsubscribe()
      waiting = []
    },
  }
}

/** Whether a STOP may still be acknowledged; one that is told as failed keeps nothing waiting. */
function isAwaited(): boolean {
  const { stop } = useStop.getState()
  if (stop === undefined || isAcknowledged(stop) || stop.isUnanswered) return false
  return stop.process.status === 'asked' || stop.engine.status === 'asked'
}
