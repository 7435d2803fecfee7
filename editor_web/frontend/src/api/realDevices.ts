/** Real devices: a person is asked once before this page lets them move, and again when the cell was opened anew. */
import { realDevices } from '../document/devices'
import { bus } from './bus'
import { post } from './client'
import { useLive } from './liveStore'
import { pageStore } from './pageStore'
import { useSession } from './session'

interface RealDevicesStore {
  /** Waits for the answer of the person; undefined while nothing is asked. */
  readonly answer: ((mayMove: boolean) => void) | undefined
  /** The opening of the cell for which the person has said that its devices may move. */
  readonly confirmed: string
}

export const useRealDevices = pageStore<RealDevicesStore>(
  () => ({ answer: undefined, confirmed: '' }),
  ({ answer }) => answer?.(false),
)

/** Whether devices may move already. */
export function useMayMove(): boolean {
  const session = useSession((s) => s.session)
  const confirmed = useRealDevices((s) => s.confirmed)
  return realDevices(session).length === 0 || confirmed === session?.epoch
}

/** Whether devices may move: at once where all are simulated, else after a person has been asked. */
export function mayMoveDevices(): Promise<boolean> {
  const { session } = useSession.getState()
  const { answer, confirmed } = useRealDevices.getState()
  if (realDevices(session).length === 0 || confirmed === session?.epoch) return Promise.resolve(true)
  answer?.(false)
  return new Promise((resolve) => useRealDevices.setState({ answer: resolve }))
}

/** The person has answered. */
export function answerRealDevices(mayMove: boolean): void {
  const { answer } = useRealDevices.getState()
  const epoch = useSession.getState().session?.epoch ?? ''
  useRealDevices.setState({ answer: undefined, ...(mayMove && { confirmed: epoch }) })
  answer?.(mayMove)
}

/** Open the cell anew with these devices simulated and all others real; a refusal is a ServerError. */
export function switchSimulation(simulated: readonly string[]): Promise<unknown> {
  return post<unknown>('/cell/simulation', { simulated })
}

/** Permit motion of a device, by its address on the bus, in the name of whoever uses this page; a refusal is a ServerError. */
export async function enableDevice(address: string, reason: string): Promise<void> {
  const { present, page } = useLive.getState()
  const by = present.find((each) => each.page === page)?.name ?? ''
  await bus.call(`${address}/enable_device`, { reason, by })
}
