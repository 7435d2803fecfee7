/** The page's picture of the watched run, folded from the frames of the live stream. Pure. */
import { lookup, type Dict } from './dict'
import type {
  CellStop,
  ControlView,
  LiveDelta,
  Frame,
  LogLine,
  NodeLive,
  Presence,
  RobotLive,
  RunView,
  LiveSnapshot,
  SweepLive,
} from '../api/types'

/** Log lines kept in the page; older ones are in the journal. */
export const LOG_LINES = 2000

export interface LiveState {
  readonly epoch: string
  readonly role: string
  /** The server's clock, seconds since 1970, when the page's own steady clock was at 0. */
  readonly serverZeroS: number
  readonly run: string
  readonly seq: number
  /** The run's clock at `atMs` of the page's own steady clock; it goes on from there while `ticking`. */
  readonly nowS: number
  readonly atMs: number
  readonly ticking: boolean
  readonly runs: readonly RunView[]
  /** When the duration of each run was received, by the page's own steady clock. */
  readonly runsAtMs: Dict<number>
  readonly nodes: Dict<NodeLive>
  readonly log: readonly LogLine[]
  readonly dropped: number
  /** What can be done with the watched run; null when it is over. */
  readonly control: ControlView | null
  /** What the operator gave as the reason of a lock, by the path of the locked node. */
  readonly lockReasons: Dict<string>
  readonly robots: Dict<RobotLive>
  /** The hash on disk of documents that have changed since the page was loaded; null where they are gone. */
  readonly documents: Dict<string | null>
  /** How often modules of the project's own states were loaded anew, as far as this page was told. */
  readonly statesRevision: number
  /** Sweeps that are being executed, or have ended since the page was loaded. */
  readonly sweeps: Dict<SweepLive>
  /** The latest stop of the cell, until it is closed. */
  readonly stop: CellStop | null
  /** All open pages, and the number of this one among them. */
  readonly present: readonly Presence[]
  readonly page: number
}

/** Was the file of this document deleted while the page was open? */
export function isGone({ documents }: Pick<LiveState, 'documents'>, id: string): boolean {
  return lookup(documents, id) === null
}

export const EMPTY: LiveState = {
  epoch: '',
  role: '',
  serverZeroS: 0,
  run: '',
  seq: 0,
  nowS: 0,
  atMs: 0,
  ticking: false,
  runs: [],
  runsAtMs: {},
  nodes: {},
  log: [],
  dropped: 0,
  control: null,
  lockReasons: {},
  robots: {},
  documents: {},
  statesRevision: 0,
  sweeps: {},
  stop: null,
  present: [],
  page: 0,
}

/** Fold one frame in; `gap` means that something was missed and a snapshot must be asked for. */
export function fold(state: LiveState, frame: Frame, atMs: number): LiveState | 'gap' {
  switch (frame.k) {
    case 'hello':
      return {
        ...(state.epoch === frame.epoch ? state : EMPTY),
        epoch: frame.epoch,
        role: frame.role,
        serverZeroS: frame.server_time_s - atMs / 1000,
      }
    case 'snapshot':
      return fromSnapshot(state, frame, atMs)
    case 'delta':
      return frame.run !== state.run || frame.after !== state.seq ? 'gap' : withDelta(state, frame, atMs)
    case 'documents':
      return { ...state, documents: { ...state.documents, ...frame.changed } }
    case 'states':
      return { ...state, statesRevision: frame.revision }
    case 'sweeps':
      return { ...state, sweeps: { ...state.sweeps, ...frame.changed } }
    case 'stop':
      return { ...state, stop: frame.stop }
    case 'presence':
      return { ...state, page: frame.page, present: frame.present }
    case 'ping':
      return state
  }
}

function fromSnapshot(state: LiveState, frame: LiveSnapshot, atMs: number): LiveState {
  const { run, seq, runs, nodes, log, ticking } = frame
  const dropped = log.length > 0 ? (log[0]?.seq ?? 1) - 1 : 0
  const { robots, stop } = frame
  const control = unchanged(state.control, frame.control)
  return {
    ...state,
    run,
    seq,
    nowS: frame.now_s,
    atMs,
    ticking,
    runs,
    runsAtMs: receivedAt(runs, atMs),
    nodes,
    log,
    dropped,
    control,
    lockReasons: frame.lock_reasons,
    robots,
    stop: unchanged(state.stop, stop),
  }
}

function withDelta(state: LiveState, frame: LiveDelta, atMs: number): LiveState {
  const log = frame.log.length > 0 ? [...state.log, ...frame.log] : state.log
  const over = Math.max(0, log.length - LOG_LINES)
  return {
    ...state,
    seq: frame.seq,
    nowS: frame.now_s,
    atMs,
    ticking: frame.ticking,
    runs: mergeRuns(state.runs, frame.runs),
    runsAtMs: frame.runs.length > 0 ? { ...state.runsAtMs, ...receivedAt(frame.runs, atMs) } : state.runsAtMs,
    nodes: Object.keys(frame.nodes).length > 0 ? { ...state.nodes, ...frame.nodes } : state.nodes,
    log: over > 0 ? log.slice(over) : log,
    dropped: state.dropped + frame.dropped + over,
    control: unchanged(state.control, frame.control),
    lockReasons: unchanged(state.lockReasons, frame.lock_reasons),
    robots: Object.keys(frame.robots).length > 0 ? { ...state.robots, ...frame.robots } : state.robots,
  }
}

/** The old object where the new one says the same, so that nothing is drawn again. */
function unchanged<T>(old: T, fresh: T): T {
  return JSON.stringify(old) === JSON.stringify(fresh) ? old : fresh
}

function receivedAt(runs: readonly RunView[], atMs: number): Dict<number> {
  return Object.fromEntries(runs.map((run) => [run.id, atMs]))
}

function mergeRuns(runs: readonly RunView[], changed: readonly RunView[]): readonly RunView[] {
  if (changed.length === 0) return runs
  const byId = new Map(changed.map((run) => [run.id, run]))
  const kept = runs.map((run) => byId.get(run.id) ?? run)
  const known = new Set(runs.map((run) => run.id))
  const added = changed.filter((run) => !known.has(run.id))
  return [...added, ...kept].toSorted((a, b) => b.started_at_s - a.started_at_s)
}
