/** A part of the page under test: drawn with the look of the page, fed by what a server tells. */
import { MantineProvider } from '@mantine/core'
import { act, render } from '@testing-library/react'
import userEvent, { type UserEvent } from '@testing-library/user-event'
import type { ReactNode } from 'react'
import type { StoreApi } from 'zustand'
import { useSavedBreakpoints } from '../src/api/breakpoints.ts'
import { useCellConnection } from '../src/api/cellConnection.ts'
import { useShownLayers } from '../src/api/layerGroups.ts'
import { connect, operate, showMoment, useLive, watch } from '../src/api/live.ts'
import { newLiveStore } from '../src/api/liveStore.ts'
import { usePast } from '../src/api/past.ts'
import { clearRefusal } from '../src/api/refusal.ts'
import { useSession } from '../src/api/session.ts'
import { useStop } from '../src/api/stopStore.ts'
import type { ControlLive, LiveSnapshot, NodeLive, RobotLive, RunOverview, SessionBody } from '../src/api/types.ts'
import { theme } from '../src/app/theme.ts'
import { FakeServer, type FakeSocket } from './server.ts'

const BLANK = newLiveStore().getState()

let current: FakeServer | undefined
let disconnect: (() => void) | undefined

/** Begin with a server that knows nothing yet. */
export function newServer(): void {
  current = new FakeServer()
  current.on('GET /session', session())
}

/** The server of this test. */
export function server(): FakeServer {
  if (!current) throw new Error('no test is running')
  return current
}

/** Draw a part of the page, and give it a user. */
export function show(part: ReactNode): UserEvent {
  const user = userEvent.setup({ delay: null })
  render(part, { wrapper: Look })
  return user
}

function Look({ children }: { readonly children: ReactNode }) {
  return (
    <MantineProvider theme={theme} env="test">
      {children}
    </MantineProvider>
  )
}

/** Connect the page to what is live, and tell it this; returns the websocket for what comes later. */
export function live(told: Partial<LiveSnapshot> = {}, role = 'operator'): FakeSocket {
  disconnect?.()
  disconnect = connect()
  const socket = server().socket('/live')
  socket.accept()
  socket.tell({ k: 'hello', version: 1, epoch: 'e1', role, server_time_s: 1000 })
  socket.tell(snapshot(told))
  return socket
}

/** Take everything away that a test has left in the stores of the page. */
export function forgetPage(): void {
  act(() => {
    disconnect?.()
    disconnect = undefined
    watch('')
    operate('')
    showMoment(undefined)
    clearRefusal()
    useLive.setState(BLANK, true)
    forget(useSession)
    forget(useStop)
    forget(useSavedBreakpoints)
    forget(useCellConnection)
    forget(useShownLayers)
    forget(usePast)
  })
  localStorage.clear()
  sessionStorage.clear()
}

function forget<T>(store: StoreApi<T>): void {
  store.setState(store.getInitialState(), true)
}

export function session(told: Partial<SessionBody> = {}): SessionBody {
  return {
    role: 'operator',
    cell_name: 'bench',
    cell_view_port: null,
    epoch: 'e1',
    cell: { connected: true, reason: '' },
    stop: null,
    ...told,
  }
}

export function snapshot(told: Partial<LiveSnapshot> = {}): LiveSnapshot {
  return { k: 'snapshot', run: '', seq: 1, now_s: 0, ticking: false, runs: [], nodes: {}, log: [], control: null, robots: {}, ...told }
}

export function run(told: Partial<RunOverview> = {}): RunOverview {
  return {
    id: 'r1',
    behavior: 'behaviors/shift.yaml',
    status: 'running',
    outcome: null,
    success: false,
    cause: '',
    started_at_s: 1000,
    duration_s: 0,
    waits: '',
    ...told,
  }
}

export function control(told: Partial<ControlLive> = {}): ControlLive {
  return {
    paused: false,
    confirmed: false,
    stepping: false,
    cannot: [],
    waiting: [],
    locks: [],
    breakpoints: [],
    autonomy: 'full',
    operator: 'none',
    demanded: false,
    loss_policy: 'hold',
    loss_timeout_s: 5,
    ...told,
  }
}

export function node(told: Partial<NodeLive> = {}): NodeLive {
  return { status: 'active', visits: 1, outcome: '', entered_s: 0, duration_s: 0, cause: '', followed: '', plan: null, ...told }
}

export function robot(told: Partial<RobotLive> = {}): RobotLive {
  return { name: 'left', mode: 'idle', activity: '', error: '', speed_override: 1, controller: '', way: null, ...told }
}
