/** A part of the page under test: drawn with the look of the page, fed by what a server tells. */
import { MantineProvider } from '@mantine/core'
import type { QueryClient } from '@tanstack/react-query'
import { act, render } from '@testing-library/react'
import userEvent, { type UserEvent } from '@testing-library/user-event'
import type { ReactNode } from 'react'
import { connect } from '../src/api/live.ts'
import { beginPage } from '../src/api/pageStore.ts'
import { newQueryClient } from '../src/api/queryClient.ts'
import type {
  ArmInfo,
  ControlView,
  GateWait,
  GraphNode,
  LiveSnapshot,
  NodeLive,
  RobotLive,
  RunView,
  SessionBody,
} from '../src/api/types.ts'
import { ServerAnswers } from '../src/app/ServerAnswers.tsx'
import { theme } from '../src/app/theme.ts'
import { FakeServer, type FakeSocket } from './server.ts'

let current: FakeServer | undefined
let disconnect: (() => void) | undefined
let started = 0
const clients: QueryClient[] = []

/** Begin with a server that knows nothing yet. */
export function newServer(): void {
  current = new FakeServer()
  started += 1
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
  const client = newQueryClient()
  clients.push(client)
  render(part, { wrapper: ({ children }) => <Look client={client}>{children}</Look> })
  return user
}

function Look({ client, children }: { readonly client: QueryClient; readonly children: ReactNode }) {
  return (
    <MantineProvider theme={theme} env="test">
      <ServerAnswers client={client}>{children}</ServerAnswers>
    </MantineProvider>
  )
}

/** Connect the page to what is live, and tell it this; returns the websocket for what comes later. */
export function live(told: Partial<LiveSnapshot> = {}, role = 'operator'): FakeSocket {
  disconnect?.()
  disconnect = connect()
  const socket = server().socket('/live')
  socket.accept()
  socket.tell({ k: 'hello', version: 1, epoch: `e${started}`, role, server_time_s: 1000 })
  socket.tell(snapshot(told))
  return socket
}

/** Take everything away that a test has left in the stores of the page. */
export function forgetPage(): void {
  for (const client of clients.splice(0)) client.clear()
  localStorage.clear()
  sessionStorage.clear()
  act(() => {
    disconnect?.()
    disconnect = undefined
    beginPage()
  })
}

export function session(told: Partial<SessionBody> = {}): SessionBody {
  return {
    role: 'operator',
    cell_name: 'bench',
    cell_view_port: null,
    epoch: `e${started}`,
    cell: { connected: true, reason: '' },
    devices: [],
    opening_problem: '',
    stop: null,
    ...told,
  }
}

export function snapshot(told: Partial<LiveSnapshot> = {}): LiveSnapshot {
  return {
    k: 'snapshot',
    run: '',
    seq: 1,
    now_s: 0,
    ticking: false,
    runs: [],
    nodes: {},
    log: [],
    control: null,
    lock_reasons: {},
    robots: {},
    stop: null,
    ...told,
  }
}

export function run(told: Partial<RunView> = {}): RunView {
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
    ticking: false,
    ...told,
  }
}

export function control(told: Partial<ControlView> = {}): ControlView {
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
    active: [],
    demanded: false,
    loss_policy: 'hold',
    loss_timeout_s: 5,
    ...told,
  }
}

export function node(told: Partial<NodeLive> = {}): NodeLive {
  return {
    status: 'active',
    visits: 1,
    outcome: '',
    entered_s: 0,
    duration_s: 0,
    cause: '',
    last_transition: '',
    taken: {},
    plan: null,
    ...told,
  }
}

export function robot(told: Partial<RobotLive> = {}): RobotLive {
  return { name: 'left', mode: 'idle', activity: '', error: '', speed_override: 1, controller: '', path: null, separation: '', ...told }
}

/** What a node waits for at its end: the answer to its outcome. */
export function asks(path: string, told: Partial<GateWait> = {}): GateWait {
  return { path, visit: 1, point: 'after', outcome: 'a', reasons: ['autonomy'], required: 'high', ...told }
}

/** A state of the graph, or with its children whatever it is told to be. */
export function graphNode(path: string, told: Partial<GraphNode> = {}): GraphNode {
  return {
    path,
    name: path.split('/').at(-1) ?? path,
    kind: 'state',
    icon: 'state',
    title: 'test.Give',
    description: '',
    outcomes: ['a', 'b'],
    children: [],
    transitions: [],
    initial: null,
    conditions: [],
    disabled: false,
    ...told,
  }
}

/** An arm of two joints. */
export function armInfo(told: Partial<ArmInfo> = {}): ArmInfo {
  return {
    name: 'left',
    model: 'panda',
    urdf: '',
    joint_names: ['j1', 'j2'],
    lower_rad: [-2.9, -1.76],
    upper_rad: [2.9, 1.76],
    velocity_rad_s: [2, 2],
    acceleration_rad_s2: [10, 10],
    base: { xyz: [0, 0, 0], xyzw: [0, 0, 0, 1], frame: 'world' },
    tool_frame: 'left/tool',
    licence: '',
    effort_nm: [80, 80],
    jerk_rad_s3: [100, 100],
    tool: '',
    tool_kind: '',
    tool_licence: '',
    calibration: '',
    skills: [],
    ...told,
  }
}
