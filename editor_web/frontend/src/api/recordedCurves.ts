/** Curves of recorded runs. */
import { call } from './client'
import type { RecordedCurves, RecordedFields } from './types'

export const recordedApi = {
  /** What can be drawn of a run or a recording, by its address below `/api/v1`. */
  fields: (address: string) => call<RecordedFields>(`${address}/fields`),
  curves: (address: string, fields: readonly string[], fromS: number, untilS: number, cells: number) => {
    const range = [
      ['from_s', String(fromS)],
      ['until_s', String(untilS)],
      ['cells', String(cells)],
    ]
    return call<RecordedCurves>(`${address}/curves?${String(new URLSearchParams([...fields.map((field) => ['field', field]), ...range]))}`)
  },
}
