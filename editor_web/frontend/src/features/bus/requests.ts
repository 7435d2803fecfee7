/** Requests to services and actions, from sending to answer, refusal or end; they go on while another entry is looked at. */
import { lookup, type Dict } from '../../document/dict'
import { bus, sendGoal } from '../../api/bus'
import { wordsOf } from '../../api/client'
import type { SkillInfo } from '../../api/types'
import { pageStore } from '../../api/pageStore'

export interface RequestProgress {
  readonly status: string
  readonly feedback: unknown
  readonly answer: unknown
  /** Why it did not succeed, or was not even taken. */
  readonly cause: string
  /** By which it is cancelled. */
  readonly goal: string
}

const SENT: RequestProgress = { status: 'sent', feedback: undefined, answer: undefined, cause: '', goal: '' }
const ACTIVE: ReadonlySet<string> = new Set(['sent', 'pending', 'active', 'held', 'canceling'])

/** The newest request to each address. */
interface Requests {
  readonly courses: Dict<RequestProgress>
  /** Aborted when nobody watches them any more. */
  readonly watching: AbortController
}

export const useRequests = pageStore<Requests>(
  () => ({ courses: {}, watching: new AbortController() }),
  ({ watching }) => watching.abort(),
)

/** Has it ended? */
export function isOver(course: RequestProgress): boolean {
  return !ACTIVE.has(course.status)
}

/** Ask a service, or send a goal and follow it. */
export async function send(facts: SkillInfo, request: Dict<unknown>): Promise<void> {
  const { signal } = useRequests.getState().watching
  put(facts.name, SENT)
  try {
    await (facts.kind === 'service' ? ask(facts.name, request) : follow(facts.name, request, signal))
  } catch (error) {
    if (!signal.aborted) put(facts.name, { ...SENT, status: 'refused', cause: wordsOf(error) })
  }
}

/** Ask for the stop of a goal; its course tells when the device rests. */
export async function cancel(address: string): Promise<void> {
  const course = lookup(useRequests.getState().courses, address)
  try {
    if (course?.goal) await bus.cancel(course.goal)
  } catch (error) {
    const latest = lookup(useRequests.getState().courses, address)
    if (latest) put(address, { ...latest, cause: wordsOf(error) })
  }
}

/** Let the server cancel every goal that was sent from here. */
export function leave(): void {
  useRequests.getState().watching.abort()
  useRequests.setState({ courses: {}, watching: new AbortController() })
}

async function ask(address: string, request: Dict<unknown>): Promise<void> {
  put(address, { ...SENT, status: 'answered', answer: await bus.call(address, request) })
}

async function follow(address: string, request: Dict<unknown>, signal: AbortSignal): Promise<void> {
  let latest = SENT
  await sendGoal(
    address,
    request,
    (line) => {
      if (line.k === 'sent') latest = { ...latest, goal: line.goal }
      else if (line.k === 'course') latest = { ...latest, status: line.status, feedback: line.feedback }
      else latest = { ...latest, status: line.end.status, answer: line.end.result, cause: line.end.cause?.message ?? '' }
      if (!signal.aborted) put(address, latest)
    },
    signal,
  )
  if (!isOver(latest)) throw new Error('the connection was lost; the server cancels the goal')
}

function put(address: string, course: RequestProgress): void {
  useRequests.setState(({ courses }) => ({ courses: { ...courses, [address]: course } }))
}
