/** What can be drawn of recorded runs, and the curves that are chosen, asked for anew for each part of the time. */
import { useEffect, useState } from 'react'
import { wordsOf } from '../../api/client'
import { recordedApi } from '../../api/recordedCurves'
import type { TopicFields } from '../../api/types'
import { Curves } from '../../document/curves'
import type { View } from '../../document/timeline'
import { common, joined, type RecordedSource } from './recorded'

const PATIENCE_MS = 120

export function useRecordedFields(
  sources: readonly RecordedSource[],
  isShown: boolean,
): { readonly topics: readonly TopicFields[] | undefined; readonly problem: string } {
  const [state, setState] = useState<{ readonly key: string; readonly topics?: readonly TopicFields[]; readonly problem: string }>({
    key: '',
    problem: '',
  })
  const key = JSON.stringify(sources.map((source) => source.address))
  useEffect(() => {
    if (!isShown) return
    let isCurrent = true
    Promise.all((JSON.parse(key) as string[]).map(recordedApi.fields)).then(
      (found) => isCurrent && setState({ key, topics: common(found.map((each) => each.topics)), problem: '' }),
      (error: unknown) => isCurrent && setState({ key, problem: wordsOf(error) }),
    )
    return () => {
      isCurrent = false
    }
  }, [key, isShown])
  return state.key === key ? { topics: state.topics, problem: state.problem } : { topics: undefined, problem: '' }
}

const NONE = new Curves(1)

/** Undefined fields until the first answer; what was drawn stays until the next one has come. */
export function useRecordedCurves(
  sources: readonly RecordedSource[],
  chosen: readonly string[],
  view: View,
  cells: number,
): { readonly curves: Curves; readonly problem: string } {
  const [state, setState] = useState({ curves: NONE, problem: '' })
  const key = JSON.stringify({ sources, chosen, fromS: view.fromS, untilS: view.untilS, cells })
  useEffect(() => {
    const asked = JSON.parse(key) as { sources: RecordedSource[]; chosen: string[]; fromS: number; untilS: number; cells: number }
    if (asked.chosen.length === 0 || asked.cells < 1) return
    let isCurrent = true
    const timer = setTimeout(() => {
      Promise.all(
        asked.sources.map(({ address, startS }) =>
          recordedApi.curves(address, asked.chosen, startS + asked.fromS, startS + asked.untilS, asked.cells),
        ),
      ).then(
        (found) => isCurrent && setState({ curves: joined(asked.sources, found), problem: '' }),
        (error: unknown) => isCurrent && setState((before) => ({ ...before, problem: wordsOf(error) })),
      )
    }, PATIENCE_MS)
    return () => {
      isCurrent = false
      clearTimeout(timer)
    }
  }, [key])
  return state
}
