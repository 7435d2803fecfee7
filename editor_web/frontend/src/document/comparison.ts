/** Two runs beside one another: what differs of a visit, and how the address names it. Pure. */
import type { AlignedVisit, DataDifference, Visit } from '../api/types'

export type Side = 'left' | 'right'

/** Is it missing in one of the runs, or did it end otherwise? */
export function isDifferent({ left, right }: AlignedVisit): boolean {
  return left === null || right === null || left.status !== right.status || left.outcome !== right.outcome
}

/** How long a visit took; undefined for none, and for one that had not ended. */
export function durationOf(visit: Visit | null): number | undefined {
  if (visit === null) return undefined
  return visit.end_s === null ? undefined : visit.end_s - visit.start_s
}

/** Right minus left; undefined where one of them is missing. */
export function differenceS(left: number | undefined, right: number | undefined): number | undefined {
  return left === undefined || right === undefined ? undefined : right - left
}

/** `+0.25 s`; nothing where it rounds to nothing. */
export function signed(seconds: number | undefined): string {
  if (seconds === undefined || Math.abs(seconds) < 0.005) return ''
  return `${seconds > 0 ? '+' : '−'}${Math.abs(seconds).toFixed(2)} s`
}

/** How a visit ended, in one word or two. */
export function endWords(visit: Visit | null): string {
  if (visit === null) return 'not entered'
  if (visit.status === 'active') return 'not ended'
  return visit.outcome || visit.status
}

/** How the address names a visit: `root/grasp@2`, and `root/grasp@r2` where only the right run has it. */
export function placeOf({ path, left, right }: AlignedVisit): string {
  return left ? `${path}@${left.visit}` : `${path}@r${right?.visit ?? 1}`
}

/** The visit that an address names; undefined where there is none. */
export function indexAt(visits: readonly AlignedVisit[], place: string): number | undefined {
  const index = place ? visits.findIndex((each) => placeOf(each) === place) : -1
  return index < 0 ? undefined : index
}

/** What a visit read and wrote that differs. */
export function dataOf(data: readonly DataDifference[], index: number): readonly DataDifference[] {
  return data.filter((each) => each.index === index)
}

/** Where two runs are at the same time since the start of a visit: the left one solid, the right one as a ghost. */
export function alignedMoment(
  left: string,
  right: string,
  visit: AlignedVisit | undefined,
  offsetS: number,
): { readonly solid: readonly [run: string, timeS: number]; readonly ghost: readonly [run: string, timeS: number] | undefined } {
  const leftS = visit ? visit.left?.start_s : 0
  const rightS = visit ? visit.right?.start_s : 0
  // A visit that only the right run has is shown of that one.
  if (leftS === undefined) return { solid: [right, (rightS ?? 0) + offsetS], ghost: undefined }
  return { solid: [left, leftS + offsetS], ghost: rightS === undefined ? undefined : [right, rightS + offsetS] }
}
