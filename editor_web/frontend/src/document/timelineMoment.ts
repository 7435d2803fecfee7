/** The page's picture of a run as it was at a moment of it, in the place of the live one. Pure. */
import { lookup, type Dict } from './dict'
import type { LogLine, PastRunState, NodeLive } from '../api/types'
import type { LiveState } from './live'

/** What is shown of a run while its past is looked at. */
export interface ShownMoment {
  readonly seq: number
  /** The time that was asked for, of the run's clock; the last event before it may be older. */
  readonly timeS: number
  readonly nodes: Dict<NodeLive>
  readonly log: readonly LogLine[]
  readonly dropped: number
}

/** The live picture with the nodes, the log and the clock of a moment; what can be commanded stays that of now. */
export function atMoment(live: LiveState, moment: ShownMoment): LiveState {
  const { nodes, log, dropped, timeS } = moment
  return { ...live, nodes, log, dropped, nowS: timeS, ticking: false }
}

/** A moment as the server told it, with the objects of the one before where they say the same: they are not drawn again. */
export function nextMoment(before: ShownMoment | undefined, state: PastRunState, timeS: number): ShownMoment {
  const known = new Map(before?.log.map((line) => [line.seq, line]))
  return {
    seq: state.seq,
    timeS,
    nodes: before ? withKept(before.nodes, state.nodes) : state.nodes,
    log: state.log.map((line) => known.get(line.seq) ?? line),
    dropped: state.dropped,
  }
}

function withKept(before: Dict<NodeLive>, state: Dict<NodeLive>): Dict<NodeLive> {
  return Object.fromEntries(
    Object.entries(state).map(([path, node]) => {
      const old = lookup(before, path)
      return [path, old && isSame(old, node) ? old : node]
    }),
  )
}

function isSame(one: NodeLive, other: NodeLive): boolean {
  return (Object.keys(other) as (keyof NodeLive)[]).every((key) =>
    typeof other[key] === 'object' ? JSON.stringify(one[key]) === JSON.stringify(other[key]) : one[key] === other[key],
  )
}
