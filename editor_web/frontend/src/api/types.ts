// Made by `python -m editor_web.schema`; edit the Python models instead.

/** Put a new node into a container; its name is made up where none is given. `kind` is a key of documents: state, behavior, machine, concurrency, priority, tree, foreach, and inside trees sequence, selector, inverter, and so on. `runs` is what a state, behavior or behaviour runs. With `yaml`, nodes as `copy` gives them, the content is that instead. `after` leads the open good outcomes of a sibling (its path) to the new node; `on_edge` puts it into an arrow. `index` is its place among the children. */
export interface AddNode {
  readonly edit: "add_node"
  readonly parent: string
  readonly kind?: string
  readonly runs?: string
  readonly parameters?: Readonly<Record<string, unknown>>
  readonly name?: string | null
  readonly yaml?: string
  readonly index?: number | null
  readonly position?: readonly [number, number] | null
  readonly after?: string | null
  readonly on_edge?: Edge | null
}

/** An interrupted run cannot go on before these questions are answered. */
export interface AskBody {
  readonly message: string
  readonly where: string
  readonly hint: string
  readonly questions: readonly QuestionBody[]
}

/** Lead the open outcomes of nodes where they obviously go; of all children for a machine. */
export interface AutoConnect {
  readonly edit: "auto_connect"
  readonly paths: readonly string[]
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

/** Everything that can be put into a behavior. */
export interface CatalogueBody {
  readonly states: readonly StateBody[]
  readonly containers: readonly ContainerBody[]
  readonly behaviors: readonly ReferableBody[]
  readonly entries: readonly EntryBody[]
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

/** Take the value of a parameter back; its default holds. */
export interface ClearParameter {
  readonly edit: "clear_parameter"
  readonly path: string
  readonly name: string
}

/** Lead an outcome of a node nowhere. */
export interface ClearTransition {
  readonly edit: "clear_transition"
  readonly path: string
  readonly outcome: string
}

/** The document has changed on disk; `merged` has both changes, and is null where they contradict each other. */
export interface ConflictBody {
  readonly message: string
  readonly where: string
  readonly hint: string
  readonly theirs: string
  readonly theirs_hash: string
  readonly merged: string | null
  readonly conflicts: readonly MergeConflictBody[]
}

/** A kind of node that holds others; `only_in_tree` says where it may stand. */
export interface ContainerBody {
  readonly kind: string
  readonly title: string
  readonly doc: string
  readonly only_in_tree: boolean
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

/** Nodes as YAML, to be pasted anywhere. */
export interface CopiedBody {
  readonly yaml: string
}

/** A text and the nodes to copy from it. */
export interface CopyBody {
  readonly text: string
  readonly paths: readonly string[]
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

/** What differs between two versions; `layout_only` when nothing but positions on the canvas does. */
export interface DifferenceBody {
  readonly changes: readonly NodeChangeBody[]
  readonly layout_only: boolean
}

/** A document as it is on disk; `saved_at` is the time of its last change, seconds since 1970. */
export interface DocumentBody {
  readonly hash: string
  readonly graph: DocumentNodeBody | null
  readonly document: DocumentInfoBody | null
  readonly findings: readonly FindingBody[]
  readonly id: string
  readonly text: string
  readonly saved_at: number
}

/** What the document itself declares, as written. */
export interface DocumentInfoBody {
  readonly name: string
  readonly description: string
  readonly cell: string | null
  readonly parameters: Readonly<Record<string, Readonly<Record<string, unknown>>>>
  readonly userdata: Readonly<Record<string, unknown>>
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
}

/** One node as written: beside what a run shows, all that a form edits, raw; lines and columns count from 1. `targets` are its own transitions, outcome to target; `exits` the outcomes that lead nowhere yet. `settings` are the remaining keys of its kind, such as `memory` or `times`. `document` is the id of the behavior it refers to. */
export interface DocumentNodeBody {
  readonly path: string
  readonly name: string
  readonly kind: string
  readonly title: string
  readonly outcomes: readonly string[]
  readonly children: readonly DocumentNodeBody[]
  readonly transitions: readonly TransitionBody[]
  readonly initial: string | null
  readonly conditions: readonly string[]
  readonly label: string
  readonly description: string
  readonly line: number
  readonly column: number
  readonly end_line: number
  readonly state: string | null
  readonly reference: string | null
  readonly document: string | null
  readonly parameters: Readonly<Record<string, unknown>>
  readonly inputs: Readonly<Record<string, string>>
  readonly outputs: Readonly<Record<string, string>>
  readonly targets: Readonly<Record<string, string>>
  readonly exits: readonly string[]
  readonly autonomy: Readonly<Record<string, string>>
  readonly timeout: Readonly<Record<string, unknown>> | null
  readonly retry: Readonly<Record<string, unknown>> | null
  readonly guard: Readonly<Record<string, unknown>> | null
  readonly on_error: string | null
  readonly resume: string | null
  readonly success: readonly string[]
  readonly every: unknown
  readonly notes: string
  readonly position: readonly [number, number] | null
  readonly rules: readonly RuleBody[]
  readonly otherwise: string | null
  readonly userdata: Readonly<Record<string, unknown>>
  readonly settings: Readonly<Record<string, unknown>>
}

/** Documents that have changed on disk, by id: their hash now, null where they are gone. */
export interface DocumentsChanged {
  readonly k: "documents"
  readonly changed: Readonly<Record<string, string | null>>
}

/** What a text draws, and what is wrong with it; `graph` and `document` are null where it cannot be read. */
export interface DraftedBody {
  readonly hash: string
  readonly graph: DocumentNodeBody | null
  readonly document: DocumentInfoBody | null
  readonly findings: readonly FindingBody[]
}

/** Put copies of nodes beside them; transitions among them lead to the copies. */
export interface Duplicate {
  readonly edit: "duplicate"
  readonly paths: readonly string[]
}

/** An arrow of a machine: a child of it (its path), and one of its outcomes. */
export interface Edge {
  readonly from: string
  readonly outcome: string
}

/** The text after the edits, and the nodes that they made or changed; the text as it was where refused. */
export interface EditedBody {
  readonly hash: string
  readonly graph: DocumentNodeBody | null
  readonly document: DocumentInfoBody | null
  readonly findings: readonly FindingBody[]
  readonly text: string
  readonly changed: readonly string[]
  readonly refused: RefusalBody | null
}

/** A text and the edits to make in it, all or none; they are those of `engine.editing.edit`. */
export interface EditsBody {
  readonly text: string
  readonly edits: readonly (Readonly<Record<string, unknown>>)[]
}

/** A named entry of the cell's store. */
export interface EntryBody {
  readonly kind: string
  readonly name: string
  readonly tags: readonly string[]
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

/** One thing that differs; null where it was not, or is no longer, there. */
export interface FieldChangeBody {
  readonly field: string
  readonly before: unknown
  readonly after: unknown
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

/** Put siblings into a new container in their place; what leads out of them becomes its outcomes. */
export interface Group {
  readonly edit: "group"
  readonly paths: readonly string[]
  readonly kind: "concurrency" | "machine" | "parallel" | "priority" | "selector" | "sequence"
  readonly name?: string | null
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

/** A parameter or userdata key, with its JSON Schema. */
export interface KeyBody {
  readonly name: string
  readonly required: boolean
  readonly default: unknown
  readonly schema: Readonly<Record<string, unknown>>
}

/** One key with all that write and read it. */
export interface KeyFlowBody {
  readonly key: string
  readonly writers: readonly KeyWriterBody[]
  readonly readers: readonly KeyReaderBody[]
}

/** A node that reads a key: `defined` is always, maybe (`way` says how it is not), never, or unreachable. */
export interface KeyReaderBody {
  readonly path: string
  readonly by: string
  readonly name: string
  readonly required: boolean
  readonly defined: string
  readonly sources: readonly string[]
  readonly way: string
}

/** A node that writes a key, or a container that declares it; the path is empty for the document itself. */
export interface KeyWriterBody {
  readonly path: string
  readonly origin: string
  readonly name: string
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

/** Lines that both sides changed differently; `line` is where they stand in the text that was to be saved. */
export interface MergeConflictBody {
  readonly line: number
  readonly base: string
  readonly ours: string
  readonly theirs: string
}

/** An event of a run in the journal to begin at; at the state entered last unless `path` says otherwise. */
export interface MomentBody {
  readonly run: string
  readonly seq: number
  readonly path?: string | null
}

/** Put nodes into another container, or elsewhere among their siblings; transitions among them stay. */
export interface MoveNodes {
  readonly edit: "move_nodes"
  readonly paths: readonly string[]
  readonly parent: string
  readonly index?: number | null
}

/** A document to make from a template: machine, sequence or concurrency. */
export interface NewDocumentBody {
  readonly id: string
  readonly name?: string
  readonly template?: string
}

/** Where a document is put, or its copy. */
export interface NewIdBody {
  readonly id: string
}

/** The node that a command is about. */
export interface NodeBody {
  readonly path: string
}

/** A node that was added, removed, changed or moved between two versions; the path `document` is the document. */
export interface NodeChangeBody {
  readonly path: string
  readonly change: string
  readonly before_path: string | null
  readonly fields: readonly FieldChangeBody[]
}

/** One node: idle, active, done, failed or stopped. `visits` counts activations, so a visit shorter than a frame is still seen. Times are on the run's clock; `duration_s` is of the last finished visit. `followed` is the arrow that a machine took last, as `source|outcome`. `plan` is the way that this visit has planned last. */
export interface NodeLive {
  readonly status: string
  readonly visits: number
  readonly outcome: string
  readonly entered_s: number
  readonly duration_s: number
  readonly cause: string
  readonly followed: string
  readonly plan: PlanLive | null
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

/** Put nodes as `copy` gives them into a container. */
export interface Paste {
  readonly edit: "paste"
  readonly parent: string
  readonly yaml: string
  readonly position?: readonly [number, number] | null
  readonly index?: number | null
}

/** Nothing happened; the connection lives. */
export interface Ping {
  readonly k: "ping"
  readonly server_time_s: number
}

/** A way that a node has planned: for which arm, how long it takes and is, who found it, and in what time. */
export interface PlanLive {
  readonly robot: string
  readonly duration_s: number
  readonly length_m: number
  readonly found_by: string
  readonly planning_s: number
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

/** A behavior that another may refer to. */
export interface ReferableBody {
  readonly id: string
  readonly name: string
  readonly description: string
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
  readonly parameters: readonly KeyBody[]
}

/** Why no edit was made: `index` says which of them could not be. */
export interface RefusalBody {
  readonly message: string
  readonly hint: string
  readonly index: number
}

/** Take nodes out, with the transitions and conditions that name them; other references show as findings. */
export interface RemoveNodes {
  readonly edit: "remove_nodes"
  readonly paths: readonly string[]
}

/** Give a node another name; whatever refers to it follows. */
export interface RenameNode {
  readonly edit: "rename_node"
  readonly path: string
  readonly name: string
}

/** A request to go on with an interrupted run: `answers` by path are `rerun` or an outcome. */
export interface ResumeBody {
  readonly answers?: Readonly<Record<string, string>>
  readonly changed?: boolean
}

/** One arm: what it does, why it stopped by itself, and the share of their own speed that motions run at. `way` is the way that is planned for it, which the 3D view shows. */
export interface RobotLine {
  readonly name: string
  readonly mode: string
  readonly activity: string
  readonly error: string
  readonly speed_override: number
  readonly controller: string
  readonly way: WayLine | null
}

/** One condition of a concurrency container: the outcome, and which child must have ended how. */
export interface RuleBody {
  readonly outcome: string
  readonly when: Readonly<Record<string, string>>
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

/** A text to write, and the hash of the one it was made from. */
export interface SaveBody {
  readonly text: string
  readonly base_hash: string
}

/** What is on disk now. */
export interface SavedBody {
  readonly hash: string
  readonly saved_at: number
}

/** Who is logged in, and what this server has. */
export interface SessionBody {
  readonly role: string
  readonly cell_name: string
  readonly has_cell_view: boolean
  readonly epoch: string
}

/** Change what the document declares; null takes a key away. The other keys stay. Keys: name, description, cell, parameters, userdata, outcomes, success. */
export interface SetDocument {
  readonly edit: "set_document"
  readonly changes: Readonly<Record<string, unknown>>
}

/** Set one thing of a node; null takes it away. For every node: description, timeout, retry, guard, on_error, autonomy, resume, in, out, success, every, notes, and what it runs (state, behavior, behaviour). For containers the keys of their kind: initial, conditions, otherwise, userdata, items, times, as, index, next, collect, memory, policy, synchronise, after, status, running, failure; and `order`, the names of all children in their new order. */
export interface SetField {
  readonly edit: "set_field"
  readonly path: string
  readonly field: string
  readonly value?: unknown
}

/** Let a machine begin with a child. */
export interface SetInitial {
  readonly edit: "set_initial"
  readonly path: string
  readonly child: string
}

/** Give a state or behavior a value for a parameter. */
export interface SetParameter {
  readonly edit: "set_parameter"
  readonly path: string
  readonly name: string
  readonly value: unknown
}

/** Place nodes on the canvas, in pixels relative to their container; null forgets a position. */
export interface SetPositions {
  readonly edit: "set_positions"
  readonly positions: Readonly<Record<string, readonly [number, number] | null>>
}

/** Lead an outcome of a node to a sibling, or to an outcome of the machine around it. */
export interface SetTransition {
  readonly edit: "set_transition"
  readonly path: string
  readonly outcome: string
  readonly target: string
}

/** From the client: the 3D view under `/cell/<page>/` shows these groups from now on, and no others. */
export interface Show {
  readonly k: "show"
  readonly page: string
  readonly groups: readonly ("cameras" | "frames" | "obstacles" | "people" | "voxels" | "ways")[]
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

/** A state that can be put into a behavior. */
export interface StateBody {
  readonly name: string
  readonly group: string
  readonly summary: string
  readonly doc: string
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
  readonly parameters: readonly KeyBody[]
  readonly inputs: readonly KeyBody[]
  readonly outputs: readonly KeyBody[]
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

/** A text that is being edited. */
export interface TextBody {
  readonly text: string
}

/** An arrow inside a machine. */
export interface TransitionBody {
  readonly source: string
  readonly outcome: string
  readonly target: string
}

/** Put the children of a container in its place. */
export interface Ungroup {
  readonly edit: "ungroup"
  readonly path: string
}

/** One version of a document; `saved_at` is when it was first seen. */
export interface VersionBody {
  readonly hash: string
  readonly saved_at: number
  readonly current: boolean
}

/** A version with its text. */
export interface VersionTextBody {
  readonly hash: string
  readonly saved_at: number
  readonly current: boolean
  readonly text: string
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

/** The planned way of an arm: `proposed`, `moving` or `blocked`, by what, and since when (of the server's clock). `length_m` is that of the tool's path. */
export interface WayLine {
  readonly state: string
  readonly reason: string
  readonly length_m: number
  readonly since_s: number
}

export type Frame = Hello | Snapshot | Delta | DocumentsChanged | Ping

export type Edit = AddNode | RemoveNodes | RenameNode | MoveNodes | SetTransition | ClearTransition | SetInitial | SetParameter | ClearParameter | SetField | SetPositions | Group | Ungroup | Duplicate | Paste | SetDocument | AutoConnect
