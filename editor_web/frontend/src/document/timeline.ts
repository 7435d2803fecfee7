/** The timeline of a run: its rows, what part of the time is seen, and going from mark to mark. Pure. */
import type { ActivationInterval, MeasuredMarker, TimelineMarker, Timeline } from '../api/types'
import { depthOf, nameOfPath, parentPath, pathsTo } from './path'

/** Everything that is known of one run up to event `seq`. */
export interface LoadedTimeline {
  readonly run: string
  readonly seq: number
  readonly durationS: number
  readonly ended: boolean
  /** Spans that lie close together are one; a part of the time can be had exactly. */
  readonly merged: boolean
  readonly leftOut: number
  readonly rows: ReadonlyMap<string, readonly ActivationInterval[]>
  readonly marks: readonly TimelineMarker[]
}

/** Take what the server has told: all of it, or what is new after `course`. */
export function withTimeline(course: LoadedTimeline | undefined, loaded: Timeline): LoadedTimeline {
  const isWhole = course === undefined || loaded.merged || course.merged || course.run !== loaded.run
  const rows = new Map(isWhole ? [] : course.rows)
  for (const { path, spans } of loaded.rows) {
    // A span that was open when it came last comes again when it is over.
    const fresh = new Set(spans.map((span) => span.seq))
    const kept = (rows.get(path) ?? []).filter((span) => !fresh.has(span.seq))
    rows.set(path, [...kept, ...spans])
  }
  const marks = isWhole ? loaded.marks : [...course.marks, ...loaded.marks]
  const { run, seq, ended, merged } = loaded
  return { run, seq, durationS: loaded.duration_s, ended, merged, leftOut: loaded.left_out, rows, marks }
}

export interface ShownRow {
  readonly path: string
  readonly name: string
  readonly depth: number
  readonly hasChildren: boolean
  readonly isOpen: boolean
}

/** The rows in the order of the graph, then what the graph does not have; without what is inside of closed ones. */
export function rowsOf(paths: Iterable<string>, order: readonly string[], closed: ReadonlySet<string>): readonly ShownRow[] {
  const known = new Set(withParents(paths))
  const inGraph = new Set(order)
  const others = [...known].filter((path) => !inGraph.has(path)).toSorted()
  const all = [...order.filter((path) => known.has(path)), ...others]
  const parents = new Set(all.map(parentPath))
  return all
    .filter((path) => !ancestorsOf(path).some((above) => closed.has(above)))
    .map((path) => ({
      path,
      name: nameOfPath(path),
      depth: depthOf(path),
      hasChildren: parents.has(path),
      isOpen: !closed.has(path),
    }))
}

function withParents(paths: Iterable<string>): readonly string[] {
  return [...paths].flatMap((path) => [...ancestorsOf(path), path])
}

function ancestorsOf(path: string): readonly string[] {
  return pathsTo(path).slice(0, -1)
}

/** The part of the time that is seen, seconds of the run's clock. */
export interface View {
  readonly fromS: number
  readonly untilS: number
}

/** The axis of time that lanes and curves have in common, with its one cursor. */
export interface SharedAxis {
  readonly view: View
  /** From 0 to here. */
  readonly durationS: number
  /** Where it begins, from the left edge; what stands before it are names and numbers. */
  readonly leftPx: number
  readonly cursorS: number
  /** Does the run still go on? Its end is then later at every look. */
  readonly isGoingOn: boolean
  readonly onGo: (timeS: number) => void
  readonly onZoom: (factor: number, aroundS: number) => void
  readonly onPan: (byS: number) => void
}

const SHORTEST_S = 0.005

/** The whole run, never of no length. */
export function wholeView(durationS: number): View {
  return { fromS: 0, untilS: Math.max(durationS, SHORTEST_S) }
}

/** Closer for a factor below 1, so that `aroundS` stays where it is; never more than the whole. */
export function zoomed(view: View, factor: number, aroundS: number, durationS: number): View {
  const whole = wholeView(durationS)
  const length = Math.min(Math.max((view.untilS - view.fromS) * factor, SHORTEST_S), whole.untilS)
  const share = (aroundS - view.fromS) / (view.untilS - view.fromS)
  return inside({ fromS: aroundS - share * length, untilS: aroundS + (1 - share) * length }, durationS)
}

/** Moved, and kept inside the run. */
export function panned(view: View, byS: number, durationS: number): View {
  return inside({ fromS: view.fromS + byS, untilS: view.untilS + byS }, durationS)
}

/** Moved no further than it takes to see a time. */
export function revealing(view: View, timeS: number, durationS: number): View {
  if (timeS < view.fromS) return panned(view, timeS - view.fromS, durationS)
  return timeS > view.untilS ? panned(view, timeS - view.untilS, durationS) : view
}

function inside(view: View, durationS: number): View {
  const whole = wholeView(durationS)
  const length = Math.min(view.untilS - view.fromS, whole.untilS)
  const fromS = Math.min(Math.max(view.fromS, 0), whole.untilS - length)
  return { fromS, untilS: fromS + length }
}

export function xOf(view: View, width: number, timeS: number): number {
  return ((timeS - view.fromS) / (view.untilS - view.fromS)) * width
}

export function timeAt(view: View, width: number, x: number): number {
  return view.fromS + (x / Math.max(width, 1)) * (view.untilS - view.fromS)
}

const STEPS = [1, 2, 5]

/** Round times about `apart` pixels from one another. */
export function ticks(view: View, width: number, apart = 90): readonly { readonly timeS: number; readonly label: string }[] {
  const length = view.untilS - view.fromS
  const interval = (length * apart) / Math.max(width, 1)
  const power = 10 ** Math.floor(Math.log10(interval))
  const step = (STEPS.find((each) => each * power >= interval) ?? 10) * power
  const digits = Math.max(0, -Math.floor(Math.log10(step)))
  const first = Math.ceil(view.fromS / step - 1e-9)
  const count = Math.floor(view.untilS / step + 1e-9) - first + 1
  return Array.from({ length: Math.max(0, Math.min(count, 400)) }, (_, index) => {
    const timeS = (first + index) * step
    return { timeS, label: timeLabel(timeS, digits) }
  })
}

function timeLabel(timeS: number, digits: number): string {
  if (timeS < 60) return `${timeS.toFixed(Math.min(digits, 3))} s`
  const minutes = Math.floor(timeS / 60)
  const rest = (timeS - minutes * 60).toFixed(Math.min(digits, 3))
  return `${minutes}:${rest.padStart(digits > 0 ? digits + 3 : 2, '0')}`
}

/** The last span that begins at or before a time, if the time is in it or no more than `nearS` from it. */
export function spanAt(spans: readonly ActivationInterval[], timeS: number, nearS: number): ActivationInterval | undefined {
  let [low, high] = [0, spans.length]
  while (low < high) {
    const middle = (low + high) >> 1
    if ((spans[middle]?.start_s ?? 0) <= timeS) low = middle + 1
    else high = middle
  }
  const [before, after] = [spans[low - 1], spans[low]]
  if (before && (before.end_s === null || before.end_s + nearS >= timeS)) return before
  return after && after.start_s - nearS <= timeS ? after : undefined
}

/** What was measured: of these the server tells apart from the events. */
export type MeasuredKind = MeasuredMarker['kind']
export type MarkKind = 'failure' | 'command' | 'gate' | 'goal' | 'change' | 'fault' | 'warning' | MeasuredKind

export const MARK_KINDS: readonly MarkKind[] = [
  'failure',
  'warning',
  'fault',
  'contact',
  'grasp',
  'force',
  'limit',
  'command',
  'gate',
  'change',
  'goal',
]

/** In words, for menus. */
export const MARK_WORDS: Readonly<Record<MarkKind, string>> = {
  failure: 'Failures',
  warning: 'Warnings',
  fault: 'Injected faults',
  contact: 'Contacts',
  grasp: 'Grasps',
  force: 'Forces',
  limit: 'Limits',
  command: 'Operator',
  gate: 'Waits and questions',
  change: 'Changed behavior',
  goal: 'Goals',
}

/** Where the run is looked at; `seq` tells moments of one time apart. */
export interface Place {
  readonly timeS: number
  readonly seq: number
}

/** The mark after (1) or before (-1) a place; what was measured lies between events, which have numbers. */
export function neighbor<M extends TimelineMarker>(marks: readonly M[], place: Place, direction: 1 | -1): M | undefined {
  const isBeyond = (mark: M) => ((mark.time_s - place.timeS) * direction || (mark.seq - place.seq) * direction) > 0
  return direction > 0 ? marks.find(isBeyond) : marks.findLast(isBeyond)
}

/** `12.40 s of 38.20 s`, for screen readers and labels. */
export function placeWords(timeS: number, durationS: number): string {
  return `${timeS.toFixed(2)} s of ${durationS.toFixed(2)} s`
}

/** Where one key press leads to on the slider; undefined for other keys. */
export function afterKey(key: string, isFar: boolean, timeS: number, view: View, durationS: number): number | undefined {
  const step = ((view.untilS - view.fromS) / 100) * (isFar ? 10 : 1)
  const targets: Record<string, number> = {
    ArrowRight: timeS + step,
    ArrowUp: timeS + step,
    ArrowLeft: timeS - step,
    ArrowDown: timeS - step,
    Home: 0,
    End: durationS,
  }
  const target = targets[key]
  return target === undefined ? undefined : Math.min(Math.max(target, 0), durationS)
}
