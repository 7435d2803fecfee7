/** Looking at the past of a run: its timeline, its moments one after the other, its failure; past runs and recordings. */
import type { Dict } from '../document/dict'
import { queryOptions } from '@tanstack/react-query'
import { nextMoment } from '../document/timelineMoment'
import { withTimeline, type LoadedTimeline } from '../document/timeline'
import { addressOf } from '../document/path'
import { call, wordsOf } from './client'
import { showMoment, useLive } from './live'
import { showCellAt } from './past'
import { queryKeys } from './queryKeys'
import type {
  MeasuredMarkers,
  OpenRunBody,
  PastRunState,
  PastRunsBody,
  RecordingFile,
  RunFailure,
  PastUserdata,
  Timeline,
  Watch,
} from './types'
import { pageStore } from './pageStore'

/** What is looked at: a run of the server or of its journal, or a recording with the run that it holds. */
export interface Subject {
  /** Below `/api/v1`. */
  readonly address: string
  readonly run: string
  /** Layers of the 3D view it from: the run, or the path of its recording. */
  readonly recorded: string
  /** There is no present to go back to. */
  readonly isPast: boolean
}

export function runSubject(run: string, isPast = false): Subject {
  return { address: `/runs/${encodeURIComponent(run)}`, run, recorded: run, isPast }
}

export function recordingSubject(path: string, run: string): Subject {
  return { address: `/recordings/${addressOf(path)}`, run, recorded: path, isPast: true }
}

export interface PastQuery {
  readonly text: string
  readonly kind: string
  /** Of the wall clock, seconds since 1970. */
  readonly sinceS: number | undefined
  readonly untilS: number | undefined
  readonly limit: number
}

export const pastApi = {
  runs: ({ text, kind, sinceS, untilS, limit }: PastQuery) =>
    call<PastRunsBody>(`/past-runs?${query({ text, kind, since_s: sinceS, until_s: untilS, limit })}`),
  recordings: () => call<readonly RecordingFile[]>('/recordings'),
  openRun: (run: string) => call<OpenRunBody>(`/runs/${encodeURIComponent(run)}/past`),
  openRecording: (path: string) => call<OpenRunBody>(`/recordings/${addressOf(path)}`),
  timeline: (subject: Subject, after: number, fromS?: number, untilS?: number) =>
    call<Timeline>(`${subject.address}/timeline?${query({ after, from_s: fromS, until_s: untilS })}`),
  userdata: (subject: Subject, seq: number, watches: readonly Watch[]) =>
    call<PastUserdata>(`${subject.address}/userdata?${query({ seq, watches: watches.length > 0 ? JSON.stringify(watches) : '' })}`),
  measured: (subject: Subject) => call<MeasuredMarkers>(`${subject.address}/measured`),
  failure: (subject: Subject) => call<RunFailure | null>(`${subject.address}/failure`),
}

export const pastQueries = {
  runs: (looked: PastQuery) => queryOptions({ queryKey: queryKeys.foundRuns(looked), queryFn: () => pastApi.runs(looked) }),
  recordings: () => queryOptions({ queryKey: queryKeys.recordings, queryFn: pastApi.recordings }),
  opened: (id: string, isRecording: boolean) =>
    queryOptions({
      queryKey: queryKeys.opened(id, isRecording),
      queryFn: () => (isRecording ? pastApi.openRecording(id) : pastApi.openRun(id)),
    }),
  part: (subject: Subject, fromS: number, untilS: number, seq: number) =>
    queryOptions({
      queryKey: queryKeys.timelinePart(subject, fromS, untilS, seq),
      queryFn: () => pastApi.timeline(subject, 0, fromS, untilS),
    }),
  userdata: (subject: Subject, seq: number, watches: readonly Watch[] = []) =>
    queryOptions({
      queryKey: queryKeys.userdata(subject, seq, watches),
      queryFn: () => pastApi.userdata(subject, seq, watches),
    }),
  measured: (subject: Subject, hasEnded: boolean) =>
    queryOptions({ queryKey: queryKeys.measured(subject, hasEnded), queryFn: () => pastApi.measured(subject) }),
  failure: (subject: Subject) => queryOptions({ queryKey: queryKeys.failure(subject), queryFn: () => pastApi.failure(subject) }),
}

function query(values: Dict<string | number | undefined>): string {
  return new URLSearchParams(
    Object.entries(values).flatMap(([key, value]) => (value === undefined || value === '' ? [] : [[key, String(value)]])),
  ).toString()
}

interface TimelineStore {
  /** What is looked at, where it is not simply the run that the page shows. */
  readonly opened: Subject | undefined
  readonly course: LoadedTimeline | undefined
  readonly problem: string
  /** Where the cursor is; undefined at the present. */
  readonly timeS: number | undefined
  readonly isPlaying: boolean
  /** Times as fast as the run was. */
  readonly speed: number
}

export const SPEEDS = [0.25, 0.5, 1, 2, 4, 8] as const

export const useTimeline = pageStore<TimelineStore>(() => ({
  opened: undefined,
  course: undefined,
  problem: '',
  timeS: undefined,
  isPlaying: false,
  speed: 1,
}))

/** Look at a past run or a recording until this is undone. */
export function openSubject(opened: Subject): () => void {
  leave(opened)
  useTimeline.setState({ opened })
  void lookAt(opened, { seq: undefined, timeS: undefined })
  return () => {
    leave(opened)
    useTimeline.setState({ opened: undefined })
  }
}

/** Ask for what is new of the timeline. */
export async function refresh(subject: Subject): Promise<void> {
  const before = useTimeline.getState().course
  const known = before?.run === subject.run ? before : undefined
  try {
    const answer = await pastApi.timeline(subject, known && !known.merged ? known.seq : 0)
    useTimeline.setState(({ course }) => ({ course: course === before ? withTimeline(known, answer) : course, problem: '' }))
  } catch (error) {
    useTimeline.setState({ problem: wordsOf(error) })
  }
}

/** Forget the timeline of another run. */
export function forget(): void {
  useTimeline.setState({ course: undefined, problem: '' })
}

/** At most that often a moment is asked for, and one at a time: the newest wish counts. */
const APART_MS = 50

interface Wish {
  readonly timeS: number | undefined
  readonly seq: number | undefined
}

/** Goes to moments of the past, one after the other. */
class Cursor {
  /** Whether this server has a 3D view that can show the past. */
  servesCell = false
  private wish: Wish | undefined
  private of: Subject | undefined
  private isAsking = false

  async lookAt(subject: Subject, wish: Wish): Promise<void> {
    this.wish = wish
    this.of = subject
    if (this.isAsking) return
    this.isAsking = true
    while (this.wish !== undefined) {
      const [next, of]: [Wish, Subject] = [this.wish, this.of]
      this.wish = undefined
      const pause = new Promise((resolve) => setTimeout(resolve, APART_MS))
      await this.show(of, next)
      if (this.wish !== undefined) await pause
    }
    this.isAsking = false
  }

  /** Go nowhere any more, also not where it is on its way to. */
  stop(): void {
    this.wish = undefined
    this.of = undefined
  }

  private async show(subject: Subject, { timeS, seq }: Wish): Promise<void> {
    const before = useLive.getState().past
    try {
      const answer = await call<PastRunState | undefined>(`${subject.address}/at?${query({ time_s: timeS, seq, known: before?.seq })}`)
      // Meanwhile somebody may have gone back to the present, or to another run.
      if (this.of?.address !== subject.address) return
      const at = timeS ?? answer?.time_s ?? before?.timeS ?? 0
      const moment = answer ? nextMoment(before, answer, at) : before && { ...before, timeS: at }
      showMoment(moment)
      if (this.servesCell) showCellAt(subject.recorded, at)
    } catch (error) {
      if (this.of?.address === subject.address) useTimeline.setState({ problem: wordsOf(error) })
    }
  }
}

const cursor = pageStore(
  () => new Cursor(),
  (ended) => ended.stop(),
)

/** Whether this server has a 3D view that can show the past. */
export function servesCell(isServed: boolean): void {
  cursor.getState().servesCell = isServed
}

/** Go to a time of the run's clock. */
export function seek(subject: Subject, timeS: number): void {
  useTimeline.setState({ timeS })
  void lookAt(subject, { timeS, seq: undefined })
}

/** Go to the moment right after an event. */
export function seekEvent(subject: Subject, event: { readonly seq: number; readonly time_s: number }): void {
  useTimeline.setState({ timeS: event.time_s, isPlaying: false })
  void lookAt(subject, { timeS: undefined, seq: event.seq })
}

/** Show the present again; of a past run, its end. */
export function backToPresent(subject: Subject): void {
  if (!subject.isPast) {
    leave(subject)
    return
  }
  useTimeline.setState({ timeS: undefined, isPlaying: false })
  void lookAt(subject, { timeS: undefined, seq: undefined })
}

/** Show no past any more. */
export function leave(subject: Subject): void {
  cursor.getState().stop()
  useTimeline.setState({ timeS: undefined, isPlaying: false })
  showMoment(undefined)
  if (cursor.getState().servesCell) showCellAt(subject.recorded, null)
}

function lookAt(subject: Subject, wish: Wish): Promise<void> {
  return cursor.getState().lookAt(subject, wish)
}
