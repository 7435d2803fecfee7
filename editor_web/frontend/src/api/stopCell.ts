/** STOP of the cell: by the stop process, which needs no engine, and by the engine, both at the same time. */
import { isAcknowledged, isAtRest, newStop, type StopPath, type StopProgress } from '../document/stopReport'
import { api, reach, wordsOf } from './client'
import { lastHeard } from './live'
import { useSession } from './session'
import { useStop } from './stopStore'
import type { StopEndpoint, StopStatus } from './types'

const REASON = 'the cell was stopped in the dashboard'
const POLL_MS = 100
const SLOW_POLL_MS = 1000
/** From here on a stop that nobody has acknowledged is told as one that has failed. */
const UNANSWERED_MS = 1500
const REST_MS = 5000
/** A path that fails is tried again, for as long as nobody has acknowledged the stop. */
const RETRY_MS = 1000
const TRIES = 10

/** Stop every arm and every run. Works while the engine is blocked or dead, and as often as it is pressed. */
export function stopCell(): void {
  const number = useStop.getState().count + 1
  const channel = useSession.getState().session?.stop ?? undefined
  useStop.setState({ stop: newStop(number, channel !== undefined, lastHeard()), count: number })
  if (channel) void throughProcess(number, channel)
  void throughEngine(number)
  setTimeout(() => change(number, (stop) => ({ isUnanswered: !isAcknowledged(stop) })), UNANSWERED_MS)
  setTimeout(() => change(number, (stop) => ({ isSlow: !isAtRest(stop) })), REST_MS)
}

/** Take the words about the last stop away. */
export function forgetStop(): void {
  useStop.setState({ stop: undefined })
}

async function throughProcess(number: number, channel: StopEndpoint, tries = TRIES): Promise<void> {
  const endMs = performance.now() + REST_MS
  const isShown = () => useStop.getState().stop?.number === number
  try {
    let answer = await askedBeforeClosing(channel)
    change(number, () => ({ process: ANSWERED, answer }))
    while (!answer.devices.every((device) => device.at_rest) && isShown()) {
      const pauseMs = performance.now() < endMs ? POLL_MS : SLOW_POLL_MS
      await new Promise((resolve) => setTimeout(resolve, pauseMs))
      answer = await asked(`${channel.url}/status`, channel.token)
      change(number, () => ({ answer }))
    }
  } catch (error) {
    change(number, () => ({ process: failed(error) }))
    tryAgain(number, tries, () => void throughProcess(number, channel, tries - 1))
  }
}

async function throughEngine(number: number, tries = TRIES): Promise<void> {
  try {
    await api.stopCell(REASON)
    change(number, () => ({ engine: ANSWERED }))
  } catch (error) {
    change(number, () => ({ engine: failed(error) }))
    tryAgain(number, tries, () => void throughEngine(number, tries - 1))
  }
}

/** Try a path once more, unless the stop has been acknowledged meanwhile, was put away, or another one was given. */
function tryAgain(number: number, tries: number, again: () => void): void {
  if (tries <= 1) return
  setTimeout(() => {
    const { stop } = useStop.getState()
    if (stop?.number === number && !isAcknowledged(stop)) again()
  }, RETRY_MS)
}

/**
 * Give STOP; a page that is closed before the answer gives it once more, by what outlives pages. As the first request
 * that takes up to 0.5 s on a busy machine: browsers lead it through one more process.
 */
async function askedBeforeClosing(channel: StopEndpoint): Promise<StopStatus> {
  const giveAgain = () => navigator.sendBeacon(channel.url, bodyWith(channel.token))
  window.addEventListener('pagehide', giveAgain)
  try {
    return await asked(channel.url, channel.token)
  } finally {
    window.removeEventListener('pagehide', giveAgain)
  }
}

function bodyWith(token: string): string {
  return JSON.stringify({ token, reason: REASON })
}

/** A request that browsers send to another port without asking there first. */
async function asked(url: string, token: string): Promise<StopStatus> {
  const response = await reach(url, {
    method: 'POST',
    mode: 'cors',
    credentials: 'omit',
    headers: { 'Content-Type': 'text/plain' },
    body: bodyWith(token),
    signal: AbortSignal.timeout(REST_MS),
  })
  if (!response.ok) throw new Error(`${response.status} ${response.statusText}`)
  return (await response.json()) as StopStatus
}

const ANSWERED: StopPath = { status: 'answered', problem: '' }

function failed(error: unknown): StopPath {
  return { status: 'failed', problem: wordsOf(error) }
}

/** What a later stop has replaced changes nothing any more. */
function change(number: number, changes: (stop: StopProgress) => Partial<StopProgress>): void {
  const { stop } = useStop.getState()
  if (stop?.number === number) useStop.setState({ stop: { ...stop, ...changes(stop) } })
}
