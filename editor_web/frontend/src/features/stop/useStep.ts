/** One command of a step at a time: what is under way, and why the last one failed. */
import { useEffect, useRef, useState } from 'react'
import { wordsOf } from '../../api/client'
import type { CellStop } from '../../api/types'

/** What each step is shown with. */
export interface StepProps {
  readonly stop: CellStop
  readonly mayOperate: boolean
}

export interface StepCommand {
  /** What is under way, in the words of who began it; empty for nothing. */
  readonly busy: string
  readonly problem: string
  readonly send: (what: string, work: (signal: AbortSignal) => Promise<void>) => void
  /** End what is under way; an arm comes to rest. */
  readonly stop: () => void
}

export function useStep(): StepCommand {
  const [busy, setBusy] = useState('')
  const [problem, setProblem] = useState('')
  const under = useRef<AbortController>(undefined)

  function send(what: string, work: (signal: AbortSignal) => Promise<void>): void {
    if (under.current) return
    const control = new AbortController()
    under.current = control
    setBusy(what)
    setProblem('')
    work(control.signal)
      .catch((error: unknown) => setProblem(control.signal.aborted ? 'Stopped by you' : wordsOf(error)))
      .finally(() => {
        under.current = undefined
        setBusy('')
      })
  }

  // A motion that nobody sees any more ends.
  useEffect(() => () => under.current?.abort(), [])
  return { busy, problem, send, stop: () => under.current?.abort() }
}
