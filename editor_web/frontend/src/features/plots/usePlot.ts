/** The curves that are chosen, their samples, and the part of time that is shown. */
import { useCallback, useEffect, useRef, useState } from 'react'
import { useData } from '../../api/data'
import { Curves } from '../../document/curves'
import { keepFields, keptFields, MOST_CURVES } from './keptFields'

/** Two minutes at twenty rows a second. */
const ROWS = 2400
export const SPANS_S = [10, 30, 120] as const

export interface Plot {
  readonly chosen: readonly string[]
  readonly choose: (fields: readonly string[]) => void
  /** What is drawn: the live samples, or those at the moment of the pause. */
  readonly curves: Curves
  /** The end of what is drawn while it is paused. */
  readonly pausedS: number | undefined
  readonly pause: () => void
  readonly goOn: () => void
  readonly panTo: (endS: number) => void
  readonly spanS: number
  readonly zoom: (spanS: number) => void
  /** Counts what has come, so that it is drawn. */
  readonly revision: number
  /** Rows that were left out, as the page did not take them in time. */
  readonly dropped: number
}

export function usePlot(isShown: boolean): Plot {
  const [chosen, setChosen] = useState<readonly string[]>(keptFields)
  const [live] = useState(() => new Curves(ROWS))
  const [frozen, setFrozen] = useState<{ readonly curves: Curves; readonly endS: number }>()
  const [spanS, setSpanS] = useState<number>(30)
  const [revision, setRevision] = useState(0)
  const [dropped, setDropped] = useState(0)
  const number = useRef(0)
  const [asked, setAsked] = useState({ number: 0, fields: chosen })
  const choose = useCallback((fields: readonly string[]) => setChosen(fields.slice(0, MOST_CURVES)), [])

  useEffect(() => {
    number.current += 1
    live.choose(chosen)
    setAsked({ number: number.current, fields: chosen })
    keepFields(chosen)
  }, [chosen, live])

  useData(isShown && asked.number > 0 && asked.fields.length > 0 ? asked : undefined, (frame) => {
    if (frame.k !== 'samples' || frame.number !== number.current) return
    frame.times_s.forEach((at, index) => live.push(at, frame.rows[index] ?? []))
    if (frame.dropped > 0) setDropped((before) => before + frame.dropped)
    setRevision((before) => before + 1)
  })

  function freeze(): { curves: Curves; endS: number } {
    return frozen ?? { curves: live.copy(), endS: live.length > 0 ? live.time(live.length - 1) : 0 }
  }

  return {
    chosen,
    choose,
    curves: frozen?.curves ?? live,
    pausedS: frozen?.endS,
    pause: () => setFrozen(freeze()),
    goOn: () => setFrozen(undefined),
    panTo: (endS) => {
      const { curves } = freeze()
      const latest = curves.length > 0 ? curves.time(curves.length - 1) : endS
      const oldest = curves.length > 0 ? curves.time(0) : endS
      setFrozen({ curves, endS: Math.min(latest, Math.max(oldest + Math.min(spanS, latest - oldest), endS)) })
    },
    spanS,
    zoom: (chosenS) => setSpanS(Math.min(120, Math.max(1, chosenS))),
    revision,
    dropped,
  }
}
