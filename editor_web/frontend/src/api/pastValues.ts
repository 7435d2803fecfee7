/** The userdata of the moment of the past that is shown. */
import { useEffect, useState } from 'react'
import { wordsOf } from './client'
import { useLive } from './live'
import { pastApi, runSubject, useTimeline } from './timeline'
import type { PastUserdata } from './types'

/** Undefined while the present is shown; kept up with the cursor, one request at a time. */
export function usePastValues(run: string | undefined, isShown: boolean): PastUserdata | undefined {
  const seq = useLive((s) => s.past?.seq)
  const opened = useTimeline((s) => s.opened)
  const [values, setValues] = useState<PastUserdata>()
  const [isAsking, setAsking] = useState(false)
  useEffect(() => setValues(undefined), [run, opened])
  useEffect(() => {
    const subject = opened ?? (run ? runSubject(run) : undefined)
    if (!isShown || seq === undefined || !subject || isAsking || values?.seq === seq) return
    setAsking(true)
    pastApi
      .userdata(subject, seq)
      .then(setValues, (error: unknown) => setValues({ seq, scopes: {}, problem: wordsOf(error) }))
      .finally(() => setAsking(false))
  }, [run, opened, seq, isShown, isAsking, values])
  // Of another run or time than what was told last, until that has come.
  return seq === undefined ? undefined : (values ?? { seq, scopes: {}, problem: '' })
}
