/** The live connection: one websocket, reopened when it is lost, folded into one store. */
import { EMPTY, fold, type LiveState } from '../document/live'
import { isActive } from '../document/runState'
import { atMoment, type ShownMoment } from '../document/timelineMoment'
import { wallTime } from '../document/time'
import { api } from './client'
import { keepConnected, type LiveConnection } from './connection'
import { OPERATED, useLive } from './liveStore'
import { useSession } from './session'
import { PAGE, useShownLayers } from './layerGroups'
import { usePathScrub } from './pathScrub'
import { afterStop } from './stopStore'
import type { CellStop, Frame } from './types'

export { useLive } from './liveStore'

/** What the stream has told, also while the past is shown. */
let streamed: LiveState = EMPTY

/** Show a moment of the past from now on; undefined shows what is live again. */
export function showMoment(past: ShownMoment | undefined): void {
  useLive.setState({ ...(past ? atMoment(streamed, past) : streamed), past })
}

/** The last event of the watched run that the stream has told of. */
export function streamedSeq(): number {
  return streamed.seq
}

/** Take what was asked about the latest stop of the cell, as the stream would tell it. */
export function takeStop(stop: CellStop | null): void {
  streamed = { ...streamed, stop }
  useLive.setState({ stop })
}

let heardS = 0

/** When the server has told anything last, as a time of day; empty before it has. */
export function lastHeard(): string {
  return heardS > 0 ? wallTime(heardS) : ''
}

let connection: LiveConnection | undefined
let watched = ''

/** Show this run from now on; empty for none. */
export function watch(run: string): void {
  if (run === watched) return
  watched = run
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
  const opened = keepConnected({
    onOpen: () => {
      // Another server process has another stop process.
      api.session().catch(() => undefined)
      sendShow()
      if (watched) sendWatch()
      if (useLive.getState().operated) sendOperate()
    },
    onFrame: (frame) => {
      heardS = Date.now() / 1000
      receive(frame)
    },
    onLost: () => {
      streamed = { ...streamed, ticking: false }
      useLive.setState({ connection: 'lost', ticking: false })
    },
    onDenied: () => useLive.setState({ connection: 'denied' }),
  })
  connection = opened
  const unsubscribe = useShownLayers.subscribe(sendShow)
  const forgetScrub = usePathScrub.subscribe(sendScrub)
  const forgetSession = useSession.subscribe((now, before) => {
    // What was asked for meanwhile was refused.
    if (before.isLoggedOut && !now.isLoggedOut) useLive.setState((live) => ({ generation: live.generation + 1 }))
  })
  return () => {
    unsubscribe()
    forgetScrub()
    forgetSession()
    opened.close()
  }
}

const receive = afterStop(show)

function show(frame: Frame): void {
  const before = useLive.getState()
  const next = fold(streamed, frame, performance.now())
  if (next === 'gap') {
    sendWatch()
    return
  }
  const restarted = before.epoch !== '' && before.epoch !== next.epoch
  streamed = next
  const picture = before.past ? atMoment(next, before.past) : next
  const knowsRuns = frame.k === 'snapshot' || (before.knowsRuns && !restarted)
  useLive.setState({ ...picture, connection: 'live', generation: before.generation + (restarted ? 1 : 0), knowsRuns })
  // A run that is over, or of another server, has no operator any more.
  const operated = next.runs.find((run) => run.id === before.operated)
  if (before.operated && (restarted || (operated && !isActive(operated)))) operate('')
}

function sendOperate(): void {
  connection?.send({ k: 'operate', run: useLive.getState().operated })
}

function sendShow(): void {
  const { groups } = useShownLayers.getState()
  // The ghost of the scrubbed path has the line of the path as well.
  const shown = usePathScrub.getState().robot ? groups.filter((group) => group !== 'paths') : groups
  connection?.send({ k: 'show', page: PAGE, groups: shown })
}

function sendScrub(now: { readonly robot: string; readonly share: number }, before: { readonly robot: string }): void {
  if (now.robot) connection?.send({ k: 'scrub', page: PAGE, robot: now.robot, share: now.share })
  else connection?.send({ k: 'scrub', page: PAGE, robot: before.robot, share: null })
  if (now.robot !== before.robot) sendShow()
}

/** Turn the camera of the 3D view to the first of these parts, frames or arms that the cell has. */
export function lookAt(names: readonly string[]): void {
  connection?.send({ k: 'look', page: PAGE, names })
}

function sendWatch(): void {
  connection?.send({ k: 'watch', run: watched })
}
