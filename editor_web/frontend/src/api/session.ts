/** Who this page is to the server, and where its stop process listens: kept in memory alone, also while nobody answers. */
import type { SessionBody } from './types'
import { pageStore } from './pageStore'

interface SessionStore {
  /** What the server has said last. */
  readonly session: SessionBody | undefined
  /** The server has refused the session of this page since then. */
  readonly isLoggedOut: boolean
}

export const useSession = pageStore<SessionStore>(() => ({ session: undefined, isLoggedOut: false }))

/** Whether the server draws the cell in 3D. */
export function hasCellView(session: SessionBody | undefined): boolean {
  return typeof session?.cell_view_port === 'number'
}

/** The server knows this page. */
export function keepSession(session: SessionBody): void {
  const before = useSession.getState().session
  const isSame = JSON.stringify(before) === JSON.stringify(session)
  useSession.setState({ session: isSame ? before : session, isLoggedOut: false })
}

/** The server does not know this page any more; role and stop channel stay, so that STOP still works. */
export function loseSession(): void {
  useSession.setState({ isLoggedOut: true })
}
