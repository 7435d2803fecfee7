/** Goals that end by themselves: sent one at a time, stopped by Escape or when the page goes. */
import { useCallback, useEffect, useRef, useState } from 'react'
import { wordsOf } from '../../api/client'
import { teach } from '../../api/teaching'

export interface Steps {
  readonly isBusy: boolean
  readonly problem: string
  readonly send: (address: string, request: unknown) => void
  readonly stop: () => void
}

export function useSteps(): Steps {
  const [isBusy, setBusy] = useState(false)
  const [problem, setProblem] = useState('')
  const under = useRef<AbortController>(undefined)

  const stop = useCallback(() => under.current?.abort(), [])

  function send(address: string, request: unknown): void {
    if (under.current) return
    const control = new AbortController()
    under.current = control
    setBusy(true)
    setProblem('')
    teach
      .goal(address, request, control.signal)
      .then(
        (end) => setProblem(end.status === 'succeeded' ? '' : causeOf(end.cause) || end.status),
        (error: unknown) => setProblem(control.signal.aborted ? 'Stopped' : wordsOf(error)),
      )
      .finally(() => {
        under.current = undefined
        setBusy(false)
      })
  }

  useEffect(() => {
    const onKey = (event: KeyboardEvent) => event.key === 'Escape' && stop()
    addEventListener('keydown', onKey)
    return () => {
      removeEventListener('keydown', onKey)
      stop()
    }
  }, [stop])

  return { isBusy, problem, send, stop }
}

/** The words of a cause: what was measured first, then what followed from it. */
function causeOf(cause: unknown): string {
  if (typeof cause !== 'object' || cause === null) return ''
  const { message, because } = cause as { readonly message?: unknown; readonly because?: unknown }
  return [causeOf(because), typeof message === 'string' ? message : ''].filter(Boolean).join(', so ')
}
