/** Hold-to-run: an arm goes as long as something is held, and the server hears of it all the while. */
import { useCallback, useEffect, useRef, useState } from 'react'
import { forgetJogWords, sendToServer, useTeach } from '../../api/teaching'
import type { Frame, Space } from '../../document/teaching'

/** Two of these may be lost before the arm's own watchdog brings it to rest. */
const REPEAT_MS = 40

export interface Jog {
  /** What is held, in the words of the one who holds it; empty for nothing. */
  readonly held: string
  /** `velocity` is asked for each time that it is told; nothing lets go. */
  readonly hold: (what: string, velocity: () => readonly number[] | undefined) => void
  readonly letGo: () => void
}

/** Jog an arm; leaving the page, another window, a lost connection and a taken-away panel all let go. */
export function useJog(arm: string, space: Space, frame: Frame): Jog {
  const [held, setHeld] = useState('')
  const timer = useRef<ReturnType<typeof setInterval>>(undefined)
  const isOpen = useTeach((s) => s.isOpen)

  const letGo = useCallback(() => {
    if (timer.current === undefined) return
    clearInterval(timer.current)
    timer.current = undefined
    sendToServer({ k: 'rest' })
    setHeld('')
  }, [])

  const hold = useCallback(
    (what: string, velocity: () => readonly number[] | undefined) => {
      letGo()
      forgetJogWords()
      sendToServer({ k: 'jog', arm, space, frame })
      const go = () => {
        const now = velocity()
        if (now) sendToServer({ k: 'go', velocity: now })
        else letGo()
      }
      timer.current = setInterval(go, REPEAT_MS)
      setHeld(what)
      go()
    },
    [arm, space, frame, letGo],
  )

  useEffect(() => {
    const onHidden = () => document.hidden && letGo()
    const ends = ['pointerup', 'pointercancel', 'blur', 'pagehide'] as const
    ends.forEach((each) => addEventListener(each, letGo))
    document.addEventListener('visibilitychange', onHidden)
    return () => {
      ends.forEach((each) => removeEventListener(each, letGo))
      document.removeEventListener('visibilitychange', onHidden)
      letGo()
    }
  }, [letGo])

  useEffect(() => {
    if (!isOpen) letGo()
  }, [isOpen, letGo])

  // The server may have refused, or have ended it: nothing is held against that.
  const refusal = useTeach((s) => s.refused.jog)
  useEffect(() => {
    if (refusal) letGo()
  }, [refusal, letGo])

  return { held, hold, letGo }
}
