// Made by `python -m editor_web.schema`; edit the Python models instead.

/** An interrupted run cannot go on before these questions are answered. */
export interface AskBody {
  readonly message: string
  readonly where: string
  readonly hint: string
  readonly questions: readonly QuestionBody[]
}

/** Outcomes that require less than `level` pass by themselves. */
export interface AutonomyBody {
  readonly level: "off" | "low" | "high" | "full"
}

/** One behavior with its form, findings and graph. */
export interface BehaviorBody {
  readonly id: string
  readonly name: string
  readonly description: string
  readonly errors: number
  readonly warnings: number
  readonly parameters: readonly ParameterBody[]
  readonly findings: readonly FindingBody[]
  readonly graph: GraphNodeBody | null
  readonly view: Readonly<Record<string, readonly [number, number]>>
  readonly success: readonly string[]
}

/** One line of the list of behaviors. */
export interface BehaviorSummaryBody {
  readonly id: string
  readonly name: string
  readonly description: string
  readonly errors: number
  readonly warnings: number
}

/** Where a run pauses by itself; `path` may hold `*` and `?`, `condition` is an expression over userdata. */
export interface BreakpointBody {
  readonly path: string
  readonly when?: "before" | "after"
  readonly condition?: string | null
  readonly hits?: number
  readonly outcomes?: readonly string[]
  readonly enabled?: boolean
}

/** A breakpoint of the run, as it is sent to `control/breakpoints`. */
export interface BreakpointLive {
  readonly path: string
  readonly when: "after" | "before"
  readonly condition: string | null
  readonly hits: number
  readonly outcomes: readonly string[]
  readonly enabled: boolean
}

/** All breakpoints of a run, or of a behavior; they replace those before. */
export interface BreakpointsBody {
  readonly breakpoints: readonly BreakpointBody[]
}

/** One link of a cause chain, outermost first. */
export interface CauseLine {
  readonly message: string
  readonly where: string
  readonly kind: string
}

/** What a hot change did, a line for each difference. */
export interface ChangeBody {
  readonly changes: readonly string[]
}

/** What an operator sees of a run; `confirmed` once everything that was to be held is at rest. */
export interface ControlBody {
  readonly paused: boolean
  readonly confirmed: boolean
  readonly cannot: readonly string[]
  readonly waiting: readonly WaitingBody[]
  readonly locks: readonly string[]
  readonly breakpoints: readonly BreakpointBody[]
  readonly autonomy: "off" | "low" | "high" | "full"
  readonly operator: string
  readonly active: readonly string[]
  readonly stepping: boolean
  readonly demanded: boolean
  readonly loss_policy: "hold" | "continue" | "stop"
  readonly loss_timeout_s: number
}

/** The control of a run that is under way. `confirmed` once everything that was to be held is at rest; `operator` is none, attached, detached or lost; `loss_policy` is what happens `loss_timeout_s` after a loss. */
export interface ControlLive {
  readonly paused: boolean
  readonly confirmed: boolean
  readonly stepping: boolean
  readonly cannot: readonly string[]
  readonly waiting: readonly WaitingLive[]
  readonly locks: readonly LockLive[]
  readonly breakpoints: readonly BreakpointLive[]
  readonly autonomy: "full" | "high" | "low" | "off"
  readonly operator: string
  readonly demanded: boolean
  readonly loss_policy: string
  readonly loss_timeout_s: number
}

/** What changed in the watched run since `after`, the runs and arms that changed, and the run's present control. `dropped` log lines are missing. */
export interface Delta {
  readonly k: "delta"
  readonly run: string
  readonly after: number
  readonly seq: number
  readonly now_s: number
  readonly ticking: boolean
  readonly runs: readonly RunLine[]
  readonly nodes: Readonly<Record<string, NodeLive>>
  readonly log: readonly LogLine[]
  readonly dropped: number
  readonly control: ControlLive | null
  readonly robots: Readonly<Record<string, RobotLine>>
}

/** Why a request failed: what, where (a parameter's name, a file, a node path), what to do. */
export interface ErrorBody {
  readonly message: string
  readonly where: string
  readonly hint: string
}

/** A page of a run's events as the journal holds them; ask again with `after=last`. */
export interface EventsBody {
  readonly events: readonly (Readonly<Record<string, unknown>>)[]
  readonly last: number
}

/** One problem of a document. */
export interface FindingBody {
  readonly severity: string
  readonly code: string
  readonly message: string
  readonly path: string
  readonly line: number
  readonly column: number
  readonly hint: string
}

/** End an active or waiting node with an outcome. */
export interface ForceBody {
  readonly path: string
  readonly outcome: string
}

/** One node of the behavior with everything inside it. */
export interface GraphNodeBody {
  readonly path: string
  readonly name: string
  readonly kind: string
  readonly title: string
  readonly outcomes: readonly string[]
  readonly children: readonly GraphNodeBody[]
  readonly transitions: readonly TransitionBody[]
  readonly initial: string | null
  readonly conditions: readonly string[]
}

/** First frame; another `epoch` than before means that the server was restarted. */
export interface Hello {
  readonly k: "hello"
  readonly version: number
  readonly epoch: string
  readonly role: string
  readonly server_time_s: number
}

/** A run of the journal whose engine died; `behavior` is the name of what it executed. */
export interface InterruptedBody {
  readonly id: string
  readonly behavior: string
  readonly started_at_s: number
  readonly last_seq: number
}

/** Hold the outcome of a node; `reason` goes into the event log. */
export interface LockBody {
  readonly path: string
  readonly reason: string
}

/** A locked node and why, in the words of whoever locked it. */
export interface LockLive {
  readonly path: string
  readonly reason: string
}

/** One line of the event log; `level` is debug, info, warning or error, `kind` the event's tag. */
export interface LogLine {
  readonly seq: number
  readonly time_s: number
  readonly kind: string
  readonly level: string
  readonly path: string
  readonly text: string
  readonly causes: readonly CauseLine[]
}

/** An event of a run in the journal to begin at; at the state entered last unless `path` says otherwise. */
export interface MomentBody {
  readonly run: string
  readonly seq: number
  readonly path?: string | null
}

/** The node that a command is about. */
export interface NodeBody {
  readonly path: string
}

/** One node: idle, active, done, failed or stopped. `visits` counts activations, so a visit shorter than a frame is still seen. Times are on the run's clock; `duration_s` is of the last finished visit. `followed` is the arrow that a machine took last, as `source|outcome`. */
export interface NodeLive {
  readonly status: string
  readonly visits: number
  readonly outcome: string
  readonly entered_s: number
  readonly duration_s: number
  readonly cause: string
  readonly followed: string
}

/** From the client: I operate this run from now on (empty: none); losing the connection is losing the operator. */
export interface Operate {
  readonly k: "operate"
  readonly run?: string
}

/** One value that is set per run, with the JSON Schema of its field. */
export interface ParameterBody {
  readonly name: string
  readonly schema: Readonly<Record<string, unknown>>
  readonly required: boolean
}

/** Nothing happened; the connection lives. */
export interface Ping {
  readonly k: "ping"
  readonly server_time_s: number
}

/** From the client: answer to a ping. */
export interface Pong {
  readonly k: "pong"
}

/** A state that a crash found in mid-work: what became of it is for a person to say. */
export interface QuestionBody {
  readonly path: string
  readonly outcomes: readonly string[]
}

/** A request to go on with an interrupted run: `answers` by path are `rerun` or an outcome. */
export interface ResumeBody {
  readonly answers?: Readonly<Record<string, string>>
  readonly changed?: boolean
}

/** One arm: what it does, why it stopped by itself, and the share of their own speed that motions run at. */
export interface RobotLine {
  readonly name: string
  readonly mode: string
  readonly activity: string
  readonly error: string
  readonly speed_override: number
  readonly controller: string
}

/** One run, under way or over. */
export interface RunBody {
  readonly id: string
  readonly behavior: string
  readonly status: string
  readonly outcome: string | null
  readonly success: boolean
  readonly cause: string
  readonly started_at_s: number
  readonly duration_s: number
}

/** One run in the list of runs; `waits` is asks, paused or locked while it waits for somebody. */
export interface RunLine {
  readonly id: string
  readonly behavior: string
  readonly status: string
  readonly outcome: string | null
  readonly success: boolean
  readonly cause: string
  readonly started_at_s: number
  readonly duration_s: number
  readonly waits: string
}

/** Who is logged in, and what this server has. */
export interface SessionBody {
  readonly role: string
  readonly cell_name: string
  readonly has_cell_view: boolean
  readonly epoch: string
}

/** Everything of the watched run (empty when none is), all runs, newest first, and all arms. `now_s` is the run's clock at sending; it goes on with wall time while `ticking`. `control` is there while the run is under way. */
export interface Snapshot {
  readonly k: "snapshot"
  readonly run: string
  readonly seq: number
  readonly now_s: number
  readonly ticking: boolean
  readonly runs: readonly RunLine[]
  readonly nodes: Readonly<Record<string, NodeLive>>
  readonly log: readonly LogLine[]
  readonly control: ControlLive | null
  readonly robots: Readonly<Record<string, RobotLine>>
}

/** A request to start a run; without a seed the server draws one. */
export interface StartBody {
  readonly behavior: string
  readonly parameters?: Readonly<Record<string, unknown>>
  readonly inputs?: Readonly<Record<string, unknown>>
  readonly seed?: number | null
  readonly supervision?: SupervisionBody
  readonly begin?: MomentBody | null
}

/** The run that was started. */
export interface StartedBody {
  readonly run: string
}

/** One step of a paused run, in the branch of `path` where one is given. */
export interface StepBody {
  readonly mode?: "into" | "over" | "out"
  readonly path?: string
}

/** A request to stop a run; `reason` goes into its event log. */
export interface StopBody {
  readonly reason?: string
}

/** How a run is watched over; see `flexcell run --help` for the same options. */
export interface SupervisionBody {
  readonly autonomy?: "off" | "low" | "high" | "full"
  readonly demand_operator?: boolean
  readonly breakpoints?: boolean
  readonly start_paused?: boolean
  readonly loss_policy?: "hold" | "continue" | "stop"
  readonly loss_timeout_s?: number
}

/** An arrow inside a machine. */
export interface TransitionBody {
  readonly source: string
  readonly outcome: string
  readonly target: string
}

/** A node that waits at the gate: `before` its entry or `after` its outcome, and for what. */
export interface WaitingBody {
  readonly path: string
  readonly visit: number
  readonly point: "before" | "after"
  readonly outcome: string
  readonly required: string
  readonly reasons: readonly string[]
}

/** A node that waits `before` its entry or `after` its outcome; `reasons` are pause, lock, autonomy. */
export interface WaitingLive {
  readonly path: string
  readonly point: "after" | "before"
  readonly outcome: string
  readonly required: string
  readonly reasons: readonly string[]
}

/** From the client: show this run from now on (empty: the list of runs only); answered by a snapshot. */
export interface Watch {
  readonly k: "watch"
  readonly run?: string
}

export type Frame = Hello | Snapshot | Delta | Ping
