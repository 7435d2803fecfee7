/** The live connection: one websocket, reopened when it is lost, folded into one store. */
import { EMPTY, fold, type LiveState } from '../document/live'
import { isActive } from '../document/runState'
import { atMoment, type ShownMoment } from '../document/timelineMoment'
import { wallTime } from '../document/time'
import { api } from './client'
import { keepConnected, type LiveConnection } from './connection'
import { OPERATED, useLive } from './liveStore'
import { pageStore } from './pageStore'
import { useSession } from './session'
import { PAGE, useShownLayers } from './layerGroups'
import { usePathScrub } from './pathScrub'
import { useOwnPresence } from './presence'
import { afterStop } from './stopStore'
import type { CellStop, Frame } from './types'

export { useLive } from './liveStore'

/** The stream of this page. */
interface Stream {
  /** What it has told, also while the past is shown. */
  readonly streamed: LiveState
  /** When it has told anything last, seconds since 1970; 0 before it has. */
  readonly heardS: number
  readonly connection: LiveConnection | undefined
  /** The run that the page shows; empty for none. */
  readonly watched: string
}

const NO_STREAM: Stream = { streamed: EMPTY, heardS: 0, connection: undefined, watched: '' }
const stream = pageStore<Stream>(
  () => NO_STREAM,
  ({ connection }) => connection?.close(),
)

/** Show a moment of the past from now on; undefined shows what is live again. */
export function showMoment(past: ShownMoment | undefined): void {
  const { streamed } = stream.getState()
  useLive.setState({ ...(past ? atMoment(streamed, past) : streamed), past })
}

/** The last event of the watched run that the stream has told of. */
export function streamedSeq(): number {
  return stream.getState().streamed.seq
}

/** Take what was asked about the latest stop of the cell, as the stream would tell it. */
export function takeStop(stop: CellStop | null): void {
  stream.setState(({ streamed }) => ({ streamed: { ...streamed, stop } }))
  useLive.setState({ stop })
}

/** When the server has told anything last, as a time of day; empty before it has. */
export function lastHeard(): string {
  const { heardS } = stream.getState()
  return heardS > 0 ? wallTime(heardS) : ''
}

/** Show this run from now on; empty for none. */
export function watch(run: string): void {
  if (run === stream.getState().watched) return
  stream.setState({ watched: run })
  sendWatch()
}

/** Be the operator of this run from now on, until it is over or the page says so; empty leaves it. */
export function operate(run: string): void {
  if (run) sessionStorage.setItem(OPERATED, run)
  else sessionStorage.removeItem(OPERATED)
  useLive.setState({ operated: run })
  sendOperate()
}

/** Wait until the run that is shown has an operator. */
export function attached(run: string): Promise<void> {
  return new Promise((resolve) => {
    const isAttached = () => useLive.getState().run === run && useLive.getState().control?.operator === 'attached'
    const unsubscribe = useLive.subscribe(() => isAttached() && (unsubscribe(), resolve()))
    if (isAttached()) {
      unsubscribe()
      resolve()
    }
  })
}

/** The server's clock now, seconds since 1970. */
export function serverNow(): number {
  return useLive.getState().serverZeroS + performance.now() / 1000
}

/** Open the connection and keep it open; returns how to end it. */
export function connect(): () => void {
  const received = afterStop(show)
  const opened = keepConnected({
    onOpen: () => {
      // Another server process has another stop process.
      api.session().catch(() => undefined)
      sendShow()
      sendPresence()
      if (stream.getState().watched) sendWatch()
      if (useLive.getState().operated) sendOperate()
    },
    onFrame: (frame) => {
      stream.setState({ heardS: Date.now() / 1000 })
      received.take(frame)
    },
    onLost: () => {
      stream.setState(({ streamed }) => ({ streamed: { ...streamed, ticking: false } }))
      useLive.setState({ connection: 'lost', ticking: false })
    },
    onDenied: () => useLive.setState({ connection: 'denied' }),
  })
  stream.setState({ connection: opened })
  const unsubscribe = useShownLayers.subscribe(sendShow)
  const forgetScrub = usePathScrub.subscribe(sendScrub)
  const forgetPresence = useOwnPresence.subscribe(sendPresence)
  const forgetSession = useSession.subscribe((now, before) => {
    // What was asked for meanwhile was refused.
    if (before.isLoggedOut && !now.isLoggedOut) useLive.setState((live) => ({ generation: live.generation + 1 }))
  })
  return () => {
    unsubscribe()
    forgetScrub()
    forgetPresence()
    forgetSession()
    received.end()
    opened.close()
  }
}

function show(frame: Frame): void {
  const before = useLive.getState()
  const next = fold(stream.getState().streamed, frame, performance.now())
  if (next === 'gap') {
    sendWatch()
    return
  }
  const restarted = before.epoch !== '' && before.epoch !== next.epoch
  stream.setState({ streamed: next })
  const picture = before.past ? atMoment(next, before.past) : next
  const knowsRuns = frame.k === 'snapshot' || (before.knowsRuns && !restarted)
  useLive.setState({ ...picture, connection: 'live', generation: before.generation + (restarted ? 1 : 0), knowsRuns })
  // A run that is over, or of another server, has no operator any more.
  const operated = next.runs.find((run) => run.id === before.operated)
  if (before.operated && (restarted || (operated && !isActive(operated)))) operate('')
}

function sendOperate(): void {
  send({ k: 'operate', run: useLive.getState().operated })
}

function sendPresence(): void {
  send({ k: 'present', ...useOwnPresence.getState() })
}

function sendShow(): void {
  const { groups } = useShownLayers.getState()
  // The ghost of the scrubbed path has the line of the path as well.
  const shown = usePathScrub.getState().robot ? groups.filter((group) => group !== 'paths') : groups
  send({ k: 'show', page: PAGE, groups: shown })
}

function sendScrub(now: { readonly robot: string; readonly share: number }, before: { readonly robot: string }): void {
  if (now.robot) send({ k: 'scrub', page: PAGE, robot: now.robot, share: now.share })
  else send({ k: 'scrub', page: PAGE, robot: before.robot, share: null })
  if (now.robot !== before.robot) sendShow()
}

/** Turn the camera of the 3D view to the first of these parts, frames or arms that the cell has. */
export function lookAt(names: readonly string[]): void {
  send({ k: 'look', page: PAGE, names })
}

function sendWatch(): void {
  send({ k: 'watch', run: stream.getState().watched })
}

function send(request: Parameters<LiveConnection['send']>[0]): void {
  stream.getState().connection?.send(request)
}
