/** Curves of recorded runs. */
import { queryOptions } from '@tanstack/react-query'
import { call } from './client'
import { queryKeys } from './queryKeys'
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

/** Curves to be drawn: of each source the part of its own time. */
export interface AskedCurves {
  readonly sources: readonly { readonly address: string; readonly startS: number }[]
  readonly fields: readonly string[]
  readonly fromS: number
  readonly untilS: number
  readonly cells: number
}

export const recordedQueries = {
  fields: (addresses: readonly string[]) =>
    queryOptions({ queryKey: queryKeys.recordedFields(addresses), queryFn: () => Promise.all(addresses.map(recordedApi.fields)) }),
}

/** The curves of each source. */
export function curvesOfAll({ sources, fields, fromS, untilS, cells }: AskedCurves): Promise<readonly RecordedCurves[]> {
  return Promise.all(sources.map(({ address, startS }) => recordedApi.curves(address, fields, startS + fromS, startS + untilS, cells)))
}
