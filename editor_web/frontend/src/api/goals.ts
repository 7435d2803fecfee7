/** How far the goals of the shown run are, by the node that sent them. */
import type { Dict } from '../document/dict'
import { useEffect, useSyncExternalStore } from 'react'
import { useData } from './data'
import type { GoalProgress } from './types'
import { pageStore } from './pageStore'

export const useGoals = pageStore<{ readonly goals: Dict<GoalProgress> }>(() => ({ goals: {} }))

/** Follow the goals of a run while it is under way and the page can be seen; undefined follows none. */
export function useGoalsOf(run: string | undefined): void {
  const isVisible = useSyncExternalStore(onVisibility, () => document.visibilityState === 'visible')
  useData(run && isVisible ? { goals: run } : undefined, (frame) => {
    if (frame.k === 'goals') useGoals.setState({ goals: frame.goals })
  })
  useEffect(() => () => useGoals.setState({ goals: {} }), [run])
}

function onVisibility(listener: () => void): () => void {
  document.addEventListener('visibilitychange', listener)
  return () => document.removeEventListener('visibilitychange', listener)
}
