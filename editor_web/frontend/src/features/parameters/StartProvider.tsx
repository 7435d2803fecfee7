/** What the Start button of a page and its form share: the button starts a run also while the form is not in the document. */
import { createContext, useContext, useMemo, type ReactNode } from 'react'
import type { BehaviorView } from '../../api/types'
import { fieldOf } from '../../document/schema'
import { useStart } from './useStart'

interface SharedStart extends ReturnType<typeof useStart> {
  /** Why the form cannot be shown; undefined where it can. */
  readonly damage: Error | undefined
}

const Shared = createContext<SharedStart | undefined>(undefined)

export interface StartProviderProps {
  readonly behavior: BehaviorView
  readonly onStarted: () => void
  readonly children: ReactNode
}

/** Parameters that cannot be read take no more of the page with them than the form. */
export function StartProvider({ behavior, onStarted, children }: StartProviderProps) {
  const damage = useMemo(() => damageOf(behavior), [behavior])
  const sound = useMemo(() => (damage ? { ...behavior, parameters: [] } : behavior), [behavior, damage])
  const start = useStart(sound, onStarted)
  const shared = useMemo(() => ({ ...start, damage }), [start, damage])
  return <Shared.Provider value={shared}>{children}</Shared.Provider>
}

export function useSharedStart(): SharedStart {
  const start = useContext(Shared)
  if (!start) throw new Error('there is no StartProvider around this')
  return start
}

function damageOf({ parameters }: BehaviorView): Error | undefined {
  try {
    parameters.forEach(fieldOf)
    return undefined
  } catch (error) {
    return error instanceof Error ? error : new Error(String(error))
  }
}
