// Made by `python -m editor_web.schema`; edit the Python models instead.

import type { Dict } from '../document/dict'

/** One activation of a node, or `count` of them that lie close together; `end_s` is null while it is active. `status` is active, done, failed or stopped, the worst one of several; `seq` and `end_seq` are the events that began and ended it. */
export interface ActivationInterval {
  readonly start_s: number
  readonly end_s: number | null
  readonly status: string
  readonly outcome: string
  readonly visit: number
  readonly seq: number
  readonly end_seq: number
  readonly count: number
}

/** Insert a new node into a container; its name is generated if none is given. `kind` is a key of documents: state, behavior, machine, concurrency, priority, tree, foreach, and inside trees sequence, selector, inverter, and so on. `runs` is what a state, behavior or behaviour runs. With `yaml`, nodes as `copy` returns them are the content instead. `after` connects the open success outcomes of a sibling (its path) to the new node; `on_edge` inserts it into a transition. `index` is its position among the children. */
export interface AddNode {
  readonly edit: "add_node"
  readonly parent: string
  readonly kind?: string
  readonly runs?: string
  readonly parameters?: Dict<unknown>
  readonly name?: string | null
  readonly yaml?: string
  readonly index?: number | null
  readonly position?: readonly [number, number] | null
  readonly after?: string | null
  readonly on_edge?: TransitionRef | null
}

/** What an arm is: its joints with their limits (rad, rad/s), its tool, and the names of what it can do. */
export interface ArmInfo {
  readonly name: string
  readonly model: string
  readonly joint_names: readonly string[]
  readonly lower_rad: readonly number[]
  readonly upper_rad: readonly number[]
  readonly velocity_rad_s: readonly number[]
  readonly tool: string
  readonly skills: readonly string[]
}

/** First frame: the arms and frames of the cell; `can_push` where bodies can be pushed at, as in a simulation. */
export interface ArmInfoFrame {
  readonly k: "arms"
  readonly arms: readonly ArmInfo[]
  readonly can_push: boolean
  readonly frames: readonly string[]
}

/** What an arm does and where it is: joints in radians, `tool_pose` x y z (m), quaternion x y z w, in the world. */
export interface ArmLive {
  readonly mode: string
  readonly activity: string
  readonly error: string
  readonly joints: readonly number[]
  readonly tool_pose: readonly number[]
  readonly tool: ToolLive | null
}

/** The arms that are another than when told last, at most ten times a second. */
export interface ArmsLiveFrame {
  readonly k: "now"
  readonly arms: Dict<ArmLive>
}

/** Connect the open outcomes of nodes to their evident targets; for a machine, those of all children. */
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
  readonly view: Dict<readonly [number, number]>
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

/** A new value of a parameter. */
export interface BusParameterBody {
  readonly name: string
  readonly value: unknown
}

/** From the page: a button of a keyboard or gamepad, to be told on `buttons/<source>/<button>`. */
export interface ButtonInput {
  readonly k: "button"
  readonly source: string
  readonly button: string
  readonly value: boolean
}

/** One capture in the buffer: its time, trigger, robot and kind. `form` is the default kind of entry to save it as. `samples` and `duration_s` are 0 for a single configuration; `length_rad` is the path length of all joints together, `peak_rad_s` the greatest speed of a joint. `saved_as` names the entries saved from it. */
export interface CaptureSummary {
  readonly id: number
  readonly taken_at_s: number
  readonly trigger: string
  readonly robot: string
  readonly form: "cart_dmp" | "dmp" | "gripper" | "joints" | "pose" | "trajectory"
  readonly samples: number
  readonly duration_s: number
  readonly length_rad: number
  readonly peak_rad_s: number
  readonly saved_as: readonly string[]
  readonly remark: string
}

/** The error of a learned Cartesian DMP against its recording: RMS, maximum, and at the goal. */
export interface CartFit {
  readonly kernels: number
  readonly rms_m: number
  readonly max_m: number
  readonly end_m: number
  readonly rms_rad: number
  readonly max_rad: number
  readonly end_rad: number
  readonly cut: TrimInterval
}

/** Everything that can be put into a behavior. `names` are those of the open cell by kind, which the JSON Schema of a parameter calls `cell_name`: robots, parts, cameras, frames. Those of a tool, link, output or label begin with the name of what has it: `left/panda_hand`. */
export interface CatalogueBody {
  readonly states: readonly StateBody[]
  readonly containers: readonly ContainerBody[]
  readonly behaviors: readonly ReferableBehaviorBody[]
  readonly entries: readonly EntryBody[]
  readonly names: Dict<readonly string[]>
}

/** One link of a cause chain: first what was measured, then what followed from it. */
export interface CauseLine {
  readonly message: string
  readonly where: string
  readonly kind: string
}

/** Remove the value of a parameter; its default applies. */
export interface ClearParameter {
  readonly edit: "clear_parameter"
  readonly path: string
  readonly name: string
}

/** Remove the transition of an outcome of a node. */
export interface ClearTransition {
  readonly edit: "clear_transition"
  readonly path: string
  readonly outcome: string
}

/** Two texts of a document to be compared. */
export interface CompareBody {
  readonly before: string
  readonly after: string
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

/** A request to connect again what is lost of the cell. */
export interface ConnectBody {
}

/** Whether every device of the cell is connected; `reason` says which is lost and why. */
export interface ConnectionBody {
  readonly connected: boolean
  readonly reason: string
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
  readonly waiting: readonly WaitingNodeBody[]
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
  readonly waiting: readonly WaitingNodeLive[]
  readonly locks: readonly LockLive[]
  readonly breakpoints: readonly BreakpointLive[]
  readonly autonomy: "full" | "high" | "low" | "off"
  readonly operator: string
  readonly demanded: boolean
  readonly loss_policy: string
  readonly loss_timeout_s: number
}

/** A text and the nodes to copy from it. */
export interface CopyBody {
  readonly text: string
  readonly paths: readonly string[]
}

/** Nodes as YAML, to be pasted anywhere. */
export interface CopyResultBody {
  readonly yaml: string
}

/** A document that has gone and can be restored; `saved_at` is when its last text was first seen. */
export interface DeletedDocumentBody {
  readonly id: string
  readonly saved_at: number
}

/** What a behavior is to be proposed from; with `id` it is also written there, as a new document. */
export interface DemonstrationBody {
  readonly steps: readonly DemonstrationStepBody[]
  readonly arm?: string
  readonly tool?: "gripper" | "hand" | "magnet" | null
  readonly speed?: number
  readonly line_speed_m_s?: number
  readonly approach_m?: number
  readonly width_m?: number | null
  readonly id?: string
}

/** An entry in its place, or an action `open` or `close` of the tool; without a role it is guessed. */
export interface DemonstrationStepBody {
  readonly kind: "joints" | "pose" | "trajectory" | "dmp" | "cart_dmp" | "gripper" | "action"
  readonly name: string
  readonly role?: "via" | "approach" | "grasp" | "release" | "depart" | "follow" | "open" | "close" | null
  readonly part?: string | null
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
  readonly checked: boolean
  readonly id: string
  readonly text: string
  readonly saved_at: number
}

/** What the document itself declares, as written. */
export interface DocumentInfoBody {
  readonly name: string
  readonly description: string
  readonly cell: string | null
  readonly parameters: Dict<Dict<unknown>>
  readonly userdata: Dict<unknown>
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
}

/** One node as written: beside what a run shows, all that a form edits, raw; lines and columns count from 1. `targets` are its own transitions, outcome to target; `exits` the outcomes that lead nowhere yet. `settings` are the remaining keys of its kind, such as `memory` or `times`. `document` is the id of the behavior it refers to. `role` is the key by which the part around it knows it, such as `then`. */
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
  readonly role: string
  readonly description: string
  readonly line: number
  readonly column: number
  readonly end_line: number
  readonly state: string | null
  readonly reference: string | null
  readonly document: string | null
  readonly parameters: Dict<unknown>
  readonly inputs: Dict<string>
  readonly outputs: Dict<string>
  readonly targets: Dict<string>
  readonly exits: readonly string[]
  readonly autonomy: Dict<string>
  readonly timeout: Dict<unknown> | null
  readonly retry: Dict<unknown> | null
  readonly guard: Dict<unknown> | null
  readonly post: Dict<unknown> | null
  readonly on_error: string | null
  readonly resume: string | null
  readonly success: readonly string[]
  readonly every: unknown
  readonly notes: string
  readonly position: readonly [number, number] | null
  readonly rules: readonly RuleBody[]
  readonly otherwise: string | null
  readonly userdata: Dict<unknown>
  readonly settings: Dict<unknown>
}

/** Documents that have changed on disk, by id: their hash now, null where they are gone. */
export interface DocumentsChanged {
  readonly k: "documents"
  readonly changed: Dict<string | null>
}

/** A text to draw; without `check` the answer comes sooner, and without findings. */
export interface DraftBody {
  readonly text: string
  readonly check: boolean
}

/** What a text draws, and what is wrong with it; `graph` and `document` are null where it cannot be read. `checked` is false where it was not asked for findings, which may follow from `findings`. */
export interface DraftResultBody {
  readonly hash: string
  readonly graph: DocumentNodeBody | null
  readonly document: DocumentInfoBody | null
  readonly findings: readonly FindingBody[]
  readonly checked: boolean
}

/** Insert copies of nodes next to them; transitions among them connect the copies. */
export interface DuplicateNodes {
  readonly edit: "duplicate"
  readonly paths: readonly string[]
}

/** Why no edit was made: `index` says which of them could not be. */
export interface EditRefusalBody {
  readonly message: string
  readonly hint: string
  readonly index: number
}

/** The text after the edits, and the nodes that they made or changed; the text as it was where refused. */
export interface EditResultBody {
  readonly hash: string
  readonly graph: DocumentNodeBody | null
  readonly document: DocumentInfoBody | null
  readonly findings: readonly FindingBody[]
  readonly checked: boolean
  readonly text: string
  readonly changed: readonly string[]
  readonly refused: EditRefusalBody | null
}

/** A text and the edits to make in it, all or none; they are those of `engine.editing.edit`. */
export interface EditsBody {
  readonly text: string
  readonly check: boolean
  readonly edits: readonly Dict<unknown>[]
}

/** Entries of the store have changed. */
export interface EntriesChanged {
  readonly k: "entries"
}

/** A named entry of the cell's store. */
export interface EntryBody {
  readonly kind: string
  readonly name: string
  readonly tags: readonly string[]
}

/** The first entries that matched, and how many did. */
export interface EntryPage {
  readonly entries: readonly EntryRow[]
  readonly total: number
}

/** A named entry and its last change: by whom, why, and when (milliseconds since 1970). */
export interface EntryRow {
  readonly kind: string
  readonly name: string
  readonly revision: number
  readonly tags: readonly string[]
  readonly by: string
  readonly reason: string
  readonly changed_unix_ms: number
}

/** Why a request failed: what, where (a parameter's name, a file, a node path), what to do. */
export interface ErrorBody {
  readonly message: string
  readonly where: string
  readonly hint: string
}

/** A page of a run's events as the journal holds them; ask again with `after=last`. */
export interface EventsBody {
  readonly events: readonly Dict<unknown>[]
  readonly last: number
}

/** One link of the chain of causes, what was measured first; `hint` says what to do about it, may be empty. */
export interface FailureLink {
  readonly message: string
  readonly where: string
  readonly kind: string
  readonly hint: string
}

/** How a node on the way from the root to the origin ended, after event `seq`. */
export interface FailureStep {
  readonly path: string
  readonly seq: number
  readonly time_s: number
  readonly text: string
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

/** What would mend a finding: the edits to send, and what they do in words. */
export interface FixBody {
  readonly title: string
  readonly edits: readonly Dict<unknown>[]
}

/** The fixes of one finding of a text; `code`, `path`, `line` and `message` say of which. */
export interface FixesBody {
  readonly code: string
  readonly path: string
  readonly line: number
  readonly message: string
  readonly fixes: readonly FixBody[]
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

/** Group siblings in a new container in their place; transitions that leave them become its outcomes. */
export interface GroupNodes {
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

/** What the Helping Hand does; null where there is none. */
export interface HelpingHandFrame {
  readonly k: "hand"
  readonly status: TeachStatus | null
}

/** A request for a hot change; with `preempt`, what is active and cannot go on as it is is preempted. */
export interface HotChangeBody {
  readonly preempt: boolean
}

/** What a hot change did, a line for each difference. */
export interface HotChangeResultBody {
  readonly changes: readonly string[]
}

/** A run of the journal whose engine died; `behavior` is the name of what it executed. */
export interface InterruptedRunBody {
  readonly id: string
  readonly behavior: string
  readonly started_at_s: number
  readonly last_seq: number
}

/** Which arm this page jogs now, empty for none, and what holds it back, in words. */
export interface JogStatus {
  readonly k: "jogging"
  readonly arm: string
  readonly held_by: string
}

/** From the page, ten times a second or more while a key is down: go at this velocity, m/s and rad/s. */
export interface JogVelocity {
  readonly k: "go"
  readonly velocity: readonly number[]
}

/** The error of a learned joint DMP against its recording: RMS, maximum, and at the goal. `joint` is the index of the joint with the greatest error, from 0. `rms_m` and `max_m` are the resulting errors of the tool centre point, None when the arm is unknown. */
export interface JointFit {
  readonly kernels: number
  readonly rms_rad: number
  readonly max_rad: number
  readonly end_rad: number
  readonly joint: number
  readonly cut: TrimInterval
  readonly rms_m: number | null
  readonly max_m: number | null
}

/** A parameter or userdata key, with its JSON Schema. */
export interface KeyBody {
  readonly name: string
  readonly required: boolean
  readonly default: unknown
  readonly schema: Dict<unknown>
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

/** What changed in the watched run since `after`, the runs and arms that changed, and the run's present control. `dropped` log lines are missing. */
export interface LiveDelta {
  readonly k: "delta"
  readonly run: string
  readonly after: number
  readonly seq: number
  readonly now_s: number
  readonly ticking: boolean
  readonly runs: readonly RunOverview[]
  readonly nodes: Dict<NodeLive>
  readonly log: readonly LogLine[]
  readonly dropped: number
  readonly control: ControlLive | null
  readonly robots: Dict<RobotLive>
}

/** Everything of the watched run (empty when none is), all runs, newest first, and all arms. `now_s` is the run's clock at sending; it goes on with wall time while `ticking`. `control` is there while the run is under way. */
export interface LiveSnapshot {
  readonly k: "snapshot"
  readonly run: string
  readonly seq: number
  readonly now_s: number
  readonly ticking: boolean
  readonly runs: readonly RunOverview[]
  readonly nodes: Dict<NodeLive>
  readonly log: readonly LogLine[]
  readonly control: ControlLive | null
  readonly robots: Dict<RobotLive>
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

/** A token that logs a browser in once, at `/login?t=<token>`. */
export interface LoginLinkBody {
  readonly token: string
  readonly expires_in_s: number
}

/** Whose log-in link is wanted. */
export interface LoginLinkRequest {
  readonly role: "operator" | "viewer"
}

/** Lines that both sides changed differently; `line` is where they stand in the text that was to be saved. */
export interface MergeConflictBody {
  readonly line: number
  readonly base: string
  readonly ours: string
  readonly theirs: string
}

/** Where a document goes; with `follow`, references to it are written anew. */
export interface MoveBody {
  readonly id: string
  readonly follow: boolean
}

/** Move nodes to another container, or to another position among their siblings; transitions among them are kept. */
export interface MoveNodes {
  readonly edit: "move_nodes"
  readonly paths: readonly string[]
  readonly parent: string
  readonly index?: number | null
}

/** A document at its new place: whose references follow, and whose could not. */
export interface MoveResultBody {
  readonly document: DocumentBody
  readonly followed: readonly string[]
  readonly left: readonly string[]
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

/** A node that was added, removed, changed or moved between two versions; the path `document` is the document. */
export interface NodeChangeBody {
  readonly path: string
  readonly change: string
  readonly before_path: string | null
  readonly fields: readonly FieldChangeBody[]
}

/** The node that a command is about. */
export interface NodeCommandBody {
  readonly path: string
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

/** A past run or a recording that is opened: what it was, and the behavior as it was when the run began. */
export interface OpenRunBody {
  readonly run: PastRunBody
  readonly behavior: BehaviorBody
}

/** From the client: I operate this run from now on (empty: none); losing the connection is losing the operator. */
export interface OperateRun {
  readonly k: "operate"
  readonly run?: string
}

/** One value that is set per run, with the JSON Schema of its field. */
export interface ParameterBody {
  readonly name: string
  readonly schema: Dict<unknown>
  readonly required: boolean
}

/** One run of the journal. `running` without an end: it is under way somewhere, or its engine died. `recording` is the path of its recording, empty where there is none; `here` says that it is a run of this server. */
export interface PastRunBody {
  readonly id: string
  readonly behavior: string
  readonly status: string
  readonly outcome: string | null
  readonly success: boolean
  readonly failed: boolean
  readonly cause: string
  readonly started_at_s: number
  readonly duration_s: number
  readonly events: number
  readonly recording: string
  readonly here: boolean
}

/** A run after event `seq`: its nodes, and the last lines of its log; `dropped` lines came before. */
export interface PastRunState {
  readonly seq: number
  readonly time_s: number
  readonly nodes: Dict<NodeLive>
  readonly log: readonly LogLine[]
  readonly dropped: number
}

/** A page of past runs, newest first, and how many there are of each kind that match the other filters. */
export interface PastRunsBody {
  readonly runs: readonly PastRunBody[]
  readonly total: number
  readonly counts: Dict<number>
}

/** Insert nodes, in the form that `copy` returns, into a container. */
export interface PasteNodes {
  readonly edit: "paste"
  readonly parent: string
  readonly yaml: string
  readonly position?: readonly [number, number] | null
  readonly index?: number | null
}

/** The planned way of an arm: `proposed`, `moving` or `blocked`, by what, and since when (of the server's clock). `length_m` is that of the tool's path. */
export interface PathLive {
  readonly state: string
  readonly reason: string
  readonly length_m: number
  readonly since_s: number
}

/** The connection lives; a page that does not answer with `Pong` for a while counts as gone. */
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

/** Carry out an entry (`kind`, `name`) or a capture with an arm, at `speed`: a share of its own, a half at most. */
export interface PlayBody {
  readonly arm: string
  readonly speed: number
  readonly kind: string
  readonly name: string
  readonly capture: number
  readonly revision: number
}

/** How it ended: `succeeded`, `preempted`, `rejected` or `failed`, and why. */
export interface PlaybackResult {
  readonly status: string
  readonly cause: string
}

/** From the client: answer to a ping. */
export interface Pong {
  readonly k: "pong"
}

/** From the page: show where this arm is along an entry (`kind`, `name`) or a capture; nothing without an arm. `revision` means what the entry was after that change, 0 what it is now. With `place` 0 it takes the place of all that is shown; 1 to 4 are beside that, each in its colour. */
export interface PreviewTaught {
  readonly k: "look"
  readonly arm: string
  readonly kind: string
  readonly name: string
  readonly capture: number
  readonly revision: number
  readonly place: number
}

/** A recording and the primitive learned from it, as the arm would carry them out, and how far they are apart. */
export interface PrimitiveComparison {
  readonly demonstration: Trace | null
  readonly primitive: Trace | null
  readonly joint_fit: JointFit | null
  readonly cart_fit: CartFit | null
}

/** The behavior as YAML, what it does in words, and what was decided; `id` is where it was written. */
export interface ProposalBody {
  readonly text: string
  readonly steps: readonly ProposedStepBody[]
  readonly words: readonly string[]
  readonly remarks: readonly string[]
  readonly arm: string
  readonly tool: string
  readonly arms: readonly string[]
  readonly parts: readonly string[]
  readonly findings: readonly FindingBody[]
  readonly id: string
}

/** A step with its role, and what a grasp takes: a part, or an empty name for one that nobody named. */
export interface ProposedStepBody {
  readonly kind: "joints" | "pose" | "trajectory" | "dmp" | "cart_dmp" | "gripper" | "action"
  readonly name: string
  readonly role: "via" | "approach" | "grasp" | "release" | "depart" | "follow" | "open" | "close"
  readonly part: string | null
}

/** Push at the tool of a simulated arm, along the axes of the world. */
export interface PushToolBody {
  readonly arm: string
  readonly force_n: readonly [number, number, number]
  readonly duration_s: number
}

/** A state that a crash found in mid-work: what became of it is for a person to say. */
export interface QuestionBody {
  readonly path: string
  readonly outcomes: readonly string[]
}

/** One recording of the project; `problem` says why it cannot be opened, empty where it can. */
export interface RecordingBody {
  readonly path: string
  readonly run: string
  readonly behavior: string
  readonly started_at_s: number
  readonly size_bytes: number
  readonly changed_at_s: number
  readonly problem: string
}

/** A behavior that another may refer to. */
export interface ReferableBehaviorBody {
  readonly id: string
  readonly name: string
  readonly description: string
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
  readonly parameters: readonly KeyBody[]
}

/** A behavior that refers to another one, and the nodes that do. */
export interface ReferrerBody {
  readonly id: string
  readonly name: string
  readonly paths: readonly string[]
}

/** Something that the page sent was not done; `what` is which. */
export interface RefusedFrame {
  readonly k: "refused"
  readonly what: "button" | "jog" | "look"
  readonly message: string
  readonly hint: string
}

/** Remove nodes, with the transitions and conditions that name them; other references become findings. */
export interface RemoveNodes {
  readonly edit: "remove_nodes"
  readonly paths: readonly string[]
}

/** Rename a node; all references to it are updated. */
export interface RenameNode {
  readonly edit: "rename_node"
  readonly path: string
  readonly name: string
}

/** A request to go on with an interrupted run: `answers` by path are `rerun` or an outcome. */
export interface ResumeBody {
  readonly answers?: Dict<string>
  readonly changed?: boolean
}

/** An interrupted run cannot go on before these questions are answered. */
export interface ResumeQuestionsBody {
  readonly message: string
  readonly where: string
  readonly hint: string
  readonly questions: readonly QuestionBody[]
}

/** One arm: what it does, why it stopped by itself, and the share of their own speed that motions run at. `way` is the way that is planned for it, which the 3D view shows. */
export interface RobotLive {
  readonly name: string
  readonly mode: string
  readonly activity: string
  readonly error: string
  readonly speed_override: number
  readonly controller: string
  readonly way: PathLive | null
}

/** One condition of a concurrency container: the outcome, and which child must have ended how, all or `at_least`. One that preempts some children has no outcome. */
export interface RuleBody {
  readonly outcome: string
  readonly when: Dict<string>
  readonly at_least: number | null
  readonly preempt: readonly string[]
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

/** A run that failed: it began at event `seq`, at node `path` (empty where no node did it). `steps` are the nodes from the root down to there, `around` what that node asked, was told and wrote. */
export interface RunFailure {
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly text: string
  readonly hint: string
  readonly links: readonly FailureLink[]
  readonly steps: readonly FailureStep[]
  readonly around: readonly LogLine[]
}

/** One run in the list of runs; `waits` is asks, paused or locked while it waits for somebody. */
export interface RunOverview {
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

/** An event of a run in the journal to begin at; at the state entered last unless `path` says otherwise. */
export interface RunPositionBody {
  readonly run: string
  readonly seq: number
  readonly path?: string | null
}

/** A text to write, and the hash of the one it was made from. */
export interface SaveBody {
  readonly text: string
  readonly base_hash: string
}

/** What is on disk now. */
export interface SaveResultBody {
  readonly hash: string
  readonly saved_at: number
}

/** Who is logged in, and what this server has; `stop` is for operators. The 3D view is at `http://<host>:<cell_view_port>/cell/<page>/`, an origin of its own; null where there is none. */
export interface SessionBody {
  readonly role: string
  readonly cell_name: string
  readonly cell_view_port: number | null
  readonly epoch: string
  readonly cell: ConnectionBody
  readonly stop: StopEndpointBody | null
}

/** Change declarations of the document; null removes a key. Other keys are unchanged. Keys: name, description, cell, parameters, userdata, outcomes, success. */
export interface SetDocument {
  readonly edit: "set_document"
  readonly changes: Dict<unknown>
}

/** Set one field of a node; null removes it. For every node: description, timeout, retry, guard, on_error, autonomy, resume, in, out, success, every, post, notes, and what it runs (state, behavior, behaviour). For containers the keys of their kind: initial, conditions, otherwise, userdata, shared, items, times, as, index, next, collect, memory, policy, synchronise, success_count, failure_count, after, status, running, failure; and `order`, the names of all children in their new order. */
export interface SetField {
  readonly edit: "set_field"
  readonly path: string
  readonly field: string
  readonly value?: unknown
}

/** Set the initial child of a machine. */
export interface SetInitial {
  readonly edit: "set_initial"
  readonly path: string
  readonly child: string
}

/** Set a parameter of a state or behavior. */
export interface SetParameter {
  readonly edit: "set_parameter"
  readonly path: string
  readonly name: string
  readonly value: unknown
}

/** Set the canvas positions of nodes, in pixels relative to their container; null removes a position. */
export interface SetPositions {
  readonly edit: "set_positions"
  readonly positions: Dict<readonly [number, number] | null>
}

/** Connect an outcome of a node to a sibling, or to an outcome of the surrounding machine. */
export interface SetTransition {
  readonly edit: "set_transition"
  readonly path: string
  readonly outcome: string
  readonly target: string
}

/** From the client: the 3D view under `/cell/<page>/` shows these groups from now on, and no others. */
export interface ShowLayers {
  readonly k: "show"
  readonly page: string
  readonly groups: readonly ("cameras" | "detections" | "frames" | "obstacles" | "people" | "voxels" | "ways")[]
}

/** A request to start a run; without a seed the server draws one. */
export interface StartBody {
  readonly behavior: string
  readonly parameters?: Dict<unknown>
  readonly inputs?: Dict<unknown>
  readonly seed?: number | null
  readonly supervision?: SupervisionBody
  readonly begin?: RunPositionBody | null
}

/** From the page: make ready to jog this arm, until `rest`. */
export interface StartJog {
  readonly k: "jog"
  readonly arm: string
  readonly space: "joints" | "tool"
  readonly frame: "base" | "tool" | "world"
}

/** The run that was started. */
export interface StartResultBody {
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

/** One step back of a paused run, in the branch of `path` where one is given. */
export interface StepBackBody {
  readonly path: string
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

/** Where STOP is taken whatever this server does: POST `{"token": …, "reason": …}` as plain text to `url`. */
export interface StopEndpointBody {
  readonly url: string
  readonly token: string
}

/** From the page: the key is up. */
export interface StopJog {
  readonly k: "rest"
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

/** The tags that an entry is to have; `revision` is the one that they were seen on. */
export interface TagsBody {
  readonly kind: string
  readonly name: string
  readonly tags: readonly string[]
  readonly revision: number
}

/** The targets that an arm of the document's cell cannot be at. `dropped` where the page has sent a newer text; `problem` says why they are not known otherwise. */
export interface TargetFindingsBody {
  readonly findings: readonly FindingBody[]
  readonly problem: string
  readonly dropped: boolean
}

/** A text whose targets are looked at; a newer one of the same page takes the place of those that still wait. */
export interface TargetsBody {
  readonly text: string
  readonly page: string
}

/** The status of the Helping Hand, also the latest value of `teach/status`. `recording` and `guided` are names of robots; `said` is its last message, such as why a capture was refused. */
export interface TeachStatus {
  readonly triggers: readonly TriggerStatus[]
  readonly captures: readonly CaptureSummary[]
  readonly recording: readonly string[]
  readonly guided: readonly string[]
  readonly said: string
}

/** A text that is being edited. */
export interface TextBody {
  readonly text: string
}

/** A run up to event `seq`, or what of it was begun or ended after the event that was asked for. `merge_intervals` says that spans which lie close together became one: ask for a part of the time to see it exactly. `left_out` marks are not in it. */
export interface Timeline {
  readonly run: string
  readonly seq: number
  readonly duration_s: number
  readonly ended: boolean
  readonly merged: boolean
  readonly rows: readonly TimelineRow[]
  readonly marks: readonly TimelineMarker[]
  readonly left_out: number
}

/** One marked event; `kind` is failure, command, gate, goal, change, fault or warning. */
export interface TimelineMarker {
  readonly seq: number
  readonly time_s: number
  readonly kind: string
  readonly path: string
  readonly text: string
}

/** The spans of one node, in order; its depth is in its path. */
export interface TimelineRow {
  readonly path: string
  readonly spans: readonly ActivationInterval[]
}

/** What the tool measures: opening of a gripper (m) or how far a hand is closed (0 to 100), and what it holds. */
export interface ToolLive {
  readonly width_m: number | null
  readonly closed_percent: number | null
  readonly held: boolean
}

/** The motion of an arm along an entry, one row per time. `joints` are radians in the order of `joint_names`, empty when the arm cannot follow; `poses` are x y z (m) and a unit quaternion x y z w of the tool centre point in the world. `times_s` is 0 for a single configuration. `remark` is the reason for missing joints. */
export interface Trace {
  readonly times_s: readonly number[]
  readonly joint_names: readonly string[]
  readonly joints: readonly (readonly number[])[]
  readonly poses: readonly (readonly number[])[]
  readonly remark: string
}

/** An arrow inside a machine. */
export interface TransitionBody {
  readonly source: string
  readonly outcome: string
  readonly target: string
}

/** A transition of a machine: a child (its path), and one of its outcomes. */
export interface TransitionRef {
  readonly from: string
  readonly outcome: string
}

/** A trigger with its callback and robot; the fields of RCY figure 12. The topic's field `field` (when empty, the only boolean one, or `value` or `data`) is compared with `trig_value`: `rising_edge` fires when they become equal, `falling_edge` when they become unequal, `hold` is active while they are equal. `joint_dmp_N` is the number of kernels of the primitive, 0 selects it by the fit. `tf_save` captures the pose of `source_frame` in `target_frame`, `gripper_save` the opening of the gripper and whether it holds a part. */
export interface Trigger {
  readonly trig_name: string
  readonly robot_ns: string
  readonly trig_topic: string
  readonly trig_type: "falling_edge" | "hold" | "rising_edge"
  readonly trig_callback: "cart_dmp_save" | "grav_comp" | "gripper_save" | "joint_dmp_save" | "joint_save" | "pose_save" | "tf_save"
  readonly trig_value: boolean | number | number | string
  readonly field: string
  readonly joint_dmp_N: number
  readonly source_frame: string
  readonly target_frame: string
}

/** A trigger, the type of its topic's messages, and whether its button is pressed. `fault` is the reason why it cannot fire, such as a missing field of the messages; empty when it can. */
export interface TriggerStatus {
  readonly trigger: Trigger
  readonly message_type: string
  readonly pressed: boolean
  readonly fault: string
}

/** The used interval of a recording: from `start_s` to `end_s` after its first sample. */
export interface TrimInterval {
  readonly start_s: number
  readonly end_s: number
}

/** Replace a container with its children. */
export interface UngroupNode {
  readonly edit: "ungroup"
  readonly path: string
}

/** One version of a document: when it was first seen; `by` is `editor`, or `file` where it was found there. */
export interface VersionBody {
  readonly hash: string
  readonly saved_at: number
  readonly by: string
  readonly current: boolean
}

/** A version with its text. */
export interface VersionTextBody {
  readonly hash: string
  readonly saved_at: number
  readonly by: string
  readonly current: boolean
  readonly text: string
}

/** A node that waits at the gate: `before` its entry or `after` its outcome, and for what. */
export interface WaitingNodeBody {
  readonly path: string
  readonly visit: number
  readonly point: "before" | "after"
  readonly outcome: string
  readonly required: string
  readonly reasons: readonly string[]
}

/** A node that waits `before` its entry or `after` its outcome; `reasons` are pause, lock, autonomy. */
export interface WaitingNodeLive {
  readonly path: string
  readonly point: "after" | "before"
  readonly outcome: string
  readonly required: string
  readonly reasons: readonly string[]
}

/** From the client: show this run from now on (empty: the list of runs only); answered by a snapshot. */
export interface WatchRun {
  readonly k: "watch"
  readonly run?: string
}

export type Frame = Hello | LiveSnapshot | LiveDelta | DocumentsChanged | Ping

export type Edit = AddNode | RemoveNodes | RenameNode | MoveNodes | SetTransition | ClearTransition | SetInitial | SetParameter | ClearParameter | SetField | SetPositions | GroupNodes | UngroupNode | DuplicateNodes | PasteNodes | SetDocument | AutoConnect
