// Made by `python -m editor_web.schema`; edit the Python models instead.

import type { Dict } from '../document/dict'

/** One activation of a node, or `count` adjacent ones; `end_s` is null while it is active. `status` is active, done, failed or stopped, the worst of several; `seq` and `end_seq` are the events that started and ended it. */
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

/** Description of an arm: its joints with their limits (rad, rad/s), its tool, and the names of its skills. */
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

/** First frame: the arms and frames of the cell; `can_push` is true if bodies can be pushed, as in a simulation. */
export interface ArmInfoFrame {
  readonly k: "arms"
  readonly arms: readonly ArmInfo[]
  readonly can_push: boolean
  readonly frames: readonly string[]
}

/** Status of an arm: joints in radians, `tool_pose` x y z (m), quaternion x y z w, in the world. */
export interface ArmLive {
  readonly mode: string
  readonly activity: string
  readonly error: string
  readonly joints: readonly number[]
  readonly tool_pose: readonly number[]
  readonly tool: ToolLive | null
}

/** The arms whose status has changed, at most ten times a second. */
export interface ArmsLiveFrame {
  readonly k: "now"
  readonly arms: Dict<ArmLive>
}

/** Connect the open outcomes of nodes to their evident targets; for a machine, those of all children. */
export interface AutoConnect {
  readonly edit: "auto_connect"
  readonly paths: readonly string[]
}

/** The autonomy level; outcomes that require less than `level` pass without an answer. */
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

/** A breakpoint; `path` may contain `*` and `?`, `condition` is an expression over userdata. */
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

/** All breakpoints of a run or a behavior; they replace the previous ones. */
export interface BreakpointsBody {
  readonly breakpoints: readonly BreakpointBody[]
}

/** A new value of a parameter. */
export interface BusParameterBody {
  readonly name: string
  readonly value: unknown
}

/** From the page: a button of a keyboard or gamepad, to publish on `buttons/<source>/<button>`. */
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

/** Everything that a behavior can use. `names` are the names in the open cell by kind, the `cell_name` in the JSON Schema of a parameter: robots, parts, cameras, frames. A tool, link, output or label has the prefix of its owner: `left/panda_hand`. */
export interface CatalogueBody {
  readonly states: readonly StateBody[]
  readonly containers: readonly ContainerBody[]
  readonly behaviors: readonly ReferableBehaviorBody[]
  readonly entries: readonly EntryBody[]
  readonly names: Dict<readonly string[]>
}

/** One link of a cause chain; the first link is the root cause. */
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

/** Two texts of a document to compare. */
export interface CompareBody {
  readonly before: string
  readonly after: string
}

/** The document has changed on disk; `merged` has both changes, null if they conflict. */
export interface ConflictBody {
  readonly message: string
  readonly where: string
  readonly hint: string
  readonly theirs: string
  readonly theirs_hash: string
  readonly merged: string | null
  readonly conflicts: readonly MergeConflictBody[]
}

/** A request to reconnect the lost devices of the cell. */
export interface ConnectBody {
}

/** Whether every device of the cell is connected; `reason` names the lost device and why. */
export interface ConnectionBody {
  readonly connected: boolean
  readonly reason: string
}

/** A kind of container node; `only_in_tree` restricts it to behavior trees. */
export interface ContainerBody {
  readonly kind: string
  readonly title: string
  readonly doc: string
  readonly only_in_tree: boolean
}

/** The operator's view of a run; `confirmed` is true when everything that a pause holds is at rest. */
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

/** The control state of an active run. `confirmed` is true when everything that a pause holds is at rest; `operator` is none, attached, detached or lost; `loss_policy` applies `loss_timeout_s` after the loss of the operator. */
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

/** Nodes as YAML, ready to paste. */
export interface CopyResultBody {
  readonly yaml: string
}

/** A deleted document that can be restored; `saved_at` is when its last text was first seen. */
export interface DeletedDocumentBody {
  readonly id: string
  readonly saved_at: number
}

/** The input of a proposal; with `id` the behavior is also written as a new document. */
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

/** An entry, or an action `open` or `close` of the tool, in order; without a role, the role is inferred. */
export interface DemonstrationStepBody {
  readonly kind: "joints" | "pose" | "trajectory" | "dmp" | "cart_dmp" | "gripper" | "action"
  readonly name: string
  readonly role?: "via" | "approach" | "grasp" | "release" | "depart" | "follow" | "open" | "close" | null
  readonly part?: string | null
}

/** The differences of two versions; `layout_only` is true if only canvas positions differ. */
export interface DifferenceBody {
  readonly changes: readonly NodeChangeBody[]
  readonly layout_only: boolean
}

/** A document on disk; `saved_at` is the time of its last change, seconds since 1970. */
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

/** The declarations of the document itself, as written. */
export interface DocumentInfoBody {
  readonly name: string
  readonly description: string
  readonly cell: string | null
  readonly parameters: Dict<Dict<unknown>>
  readonly userdata: Dict<unknown>
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
}

/** One node as written: the fields of a run's graph and all raw fields of the form; lines and columns count from 1. `targets` are its own transitions, outcome to target; `exits` are the outcomes without a transition. `settings` are the remaining keys of its kind, such as `memory` or `times`. `document` is the id of the behavior it refers to. `role` is its key in the parent node, such as `then`. */
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

/** Documents that have changed on disk, by id: their new hash, null if deleted. */
export interface DocumentsChanged {
  readonly k: "documents"
  readonly changed: Dict<string | null>
}

/** A text to draw; without `check` the response is faster and has no findings. */
export interface DraftBody {
  readonly text: string
  readonly check: boolean
}

/** The graph and findings of a text; `graph` and `document` are null if the text cannot be read. `checked` is false if the request did not ask for findings; the route `findings` returns them. */
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

/** Why no edit was applied: `index` is the edit that failed. */
export interface EditRefusalBody {
  readonly message: string
  readonly hint: string
  readonly index: number
}

/** The text after the edits, and the nodes that they created or changed; the unchanged text if refused. With a `difference` there is no `graph`. */
export interface EditResultBody {
  readonly hash: string
  readonly graph: DocumentNodeBody | null
  readonly document: DocumentInfoBody | null
  readonly findings: readonly FindingBody[]
  readonly checked: boolean
  readonly text: string
  readonly changed: readonly string[]
  readonly refused: EditRefusalBody | null
  readonly difference: GraphDifferenceBody | null
}

/** A text and the edits to apply, all or none; the edits are those of `engine.editing.edit`. `graph` is the hash of the text whose graph the page has; the answer then has only the difference, if the server knows that graph too. */
export interface EditsBody {
  readonly text: string
  readonly check: boolean
  readonly edits: readonly Dict<unknown>[]
  readonly graph: string | null
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

/** The first matching entries, and the total number. */
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

/** Why a request failed: message, location (a parameter's name, a file, a node path) and hint. */
export interface ErrorBody {
  readonly message: string
  readonly where: string
  readonly hint: string
}

/** A page of a run's events from the journal; `after=last` requests the next page. */
export interface EventsBody {
  readonly events: readonly Dict<unknown>[]
  readonly last: number
}

/** One link of the cause chain, root cause first; `hint` tells how to fix it, may be empty. */
export interface FailureLink {
  readonly message: string
  readonly where: string
  readonly kind: string
  readonly hint: string
}

/** How a node between the root and the origin ended, after event `seq`. */
export interface FailureStep {
  readonly path: string
  readonly seq: number
  readonly time_s: number
  readonly text: string
}

/** One field that differs; null where the field is absent. */
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

/** A fix of a finding: the edits to send, and a title that describes them. */
export interface FixBody {
  readonly title: string
  readonly edits: readonly Dict<unknown>[]
}

/** The fixes of one finding of a text; `code`, `path`, `line` and `message` identify the finding. */
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

/** How the graph of the text with the hash `base` becomes another one; nodes are named by path. `nodes` are those that are new or say something else, without children, transitions and lines. `children` are the names of all children, in order, where these changed; a node that is no child any more is gone. `arrows` are the transitions between children of a node, by the child that they leave, where they changed. `shifts` are pairs of a line of the old graph and a number of lines by which everything from there on moved; `lines` are line, column and last line of all other nodes. */
export interface GraphDifferenceBody {
  readonly base: string
  readonly nodes: Dict<DocumentNodeBody>
  readonly children: Dict<readonly string[]>
  readonly arrows: Dict<Dict<readonly TransitionBody[]>>
  readonly shifts: readonly (readonly [number, number])[]
  readonly lines: Dict<readonly [number, number, number]>
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

/** First frame; a changed `epoch` means that the server was restarted. */
export interface Hello {
  readonly k: "hello"
  readonly version: number
  readonly epoch: string
  readonly role: string
  readonly server_time_s: number
}

/** Status of the Helping Hand; null if there is none. */
export interface HelpingHandFrame {
  readonly k: "hand"
  readonly status: TeachStatus | null
}

/** A request for a hot change; with `preempt`, active nodes that cannot continue are preempted. */
export interface HotChangeBody {
  readonly preempt: boolean
}

/** The result of a hot change, one line per difference. */
export interface HotChangeResultBody {
  readonly changes: readonly string[]
}

/** A run of the journal whose engine ended without ending the run; `behavior` is the name of its behavior. */
export interface InterruptedRunBody {
  readonly id: string
  readonly behavior: string
  readonly started_at_s: number
  readonly last_seq: number
}

/** The arm that this page jogs, empty for none, and what limits its motion, as text. */
export interface JogStatus {
  readonly k: "jogging"
  readonly arm: string
  readonly held_by: string
}

/** From the page, ten times a second or more while a key is down: move at this velocity, m/s and rad/s. */
export interface JogVelocity {
  readonly k: "go"
  readonly velocity: readonly number[]
}

/** The error of a learned joint DMP against its recording: RMS, maximum, and at the goal. `joint` is the index of the joint with the greatest error, from 0. `rms_m` and `max_m` are the resulting errors of the tool centre point, None when it is not known which arm. */
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

/** One key with all its writers and readers. */
export interface KeyFlowBody {
  readonly key: string
  readonly writers: readonly KeyWriterBody[]
  readonly readers: readonly KeyReaderBody[]
}

/** A node that reads a key: `defined` is always, maybe (`way` is a path without it), never, or unreachable. */
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

/** The changes of the watched run since `after`, the changed runs and arms, and the current control of the run. `dropped` is the number of missing log lines. */
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

/** The complete state of the watched run (empty if none), all runs, newest first, and all arms. `now_s` is the run's clock at sending; it advances with wall time while `ticking`. `control` is null unless the run is active. */
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

/** A locked node and the reason given by the operator. */
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

/** A single-use login token, for `/login?t=<token>`. */
export interface LoginLinkBody {
  readonly token: string
  readonly expires_in_s: number
}

/** The role of the requested login link. */
export interface LoginLinkRequest {
  readonly role: "operator" | "viewer"
}

/** Lines that both sides changed differently; `line` is their position in the text to save. */
export interface MergeConflictBody {
  readonly line: number
  readonly base: string
  readonly ours: string
  readonly theirs: string
}

/** The new id of a document; with `follow`, references to it are updated. */
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

/** A moved document: the ids whose references were updated, and those whose references were not. */
export interface MoveResultBody {
  readonly document: DocumentBody
  readonly followed: readonly string[]
  readonly left: readonly string[]
}

/** A document to create from a template: machine, sequence or concurrency. */
export interface NewDocumentBody {
  readonly id: string
  readonly name?: string
  readonly template?: string
}

/** The new id of a document or of its copy. */
export interface NewIdBody {
  readonly id: string
}

/** A node added, removed, changed or moved between two versions; the path `document` is the document itself. */
export interface NodeChangeBody {
  readonly path: string
  readonly change: string
  readonly before_path: string | null
  readonly fields: readonly FieldChangeBody[]
}

/** The node that a command addresses. */
export interface NodeCommandBody {
  readonly path: string
}

/** One node: idle, active, done, failed or stopped. `visits` counts activations, so that a visit shorter than a frame is visible. Times are on the run's clock; `duration_s` is that of the last finished visit. `followed` is the last transition of a machine, as `source|outcome`. `plan` is the last path that this visit planned. */
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

/** An open past run or recording, with the behavior as of the start of the run. */
export interface OpenRunBody {
  readonly run: PastRunBody
  readonly behavior: BehaviorBody
}

/** From the client: operate this run (empty: none); a lost connection is a lost operator. */
export interface OperateRun {
  readonly k: "operate"
  readonly run?: string
}

/** One parameter of a run, with the JSON Schema of its value. */
export interface ParameterBody {
  readonly name: string
  readonly schema: Dict<unknown>
  readonly required: boolean
}

/** One run of the journal. `running` means that it has no end: it is active, or its engine died. `recording` is the path of its recording, empty if there is none; `here` is true for a run of this server. */
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

/** A run after event `seq`: its nodes and the last lines of its log; `dropped` counts the earlier lines. */
export interface PastRunState {
  readonly seq: number
  readonly time_s: number
  readonly nodes: Dict<NodeLive>
  readonly log: readonly LogLine[]
  readonly dropped: number
}

/** A page of past runs, newest first, and the number of runs of each kind that match the other filters. */
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

/** The planned path of an arm: `proposed`, `moving` or `blocked`, the reason, and its start on the server's clock. `length_m` is the length of the tool's path. */
export interface PathLive {
  readonly state: string
  readonly reason: string
  readonly length_m: number
  readonly since_s: number
}

/** Keep-alive; a page that does not answer with `Pong` in time is disconnected. */
export interface Ping {
  readonly k: "ping"
  readonly server_time_s: number
}

/** A path that a node has planned: arm, duration, length, planner, and planning time. */
export interface PlanLive {
  readonly robot: string
  readonly duration_s: number
  readonly length_m: number
  readonly found_by: string
  readonly planning_s: number
}

/** Play back an entry (`kind`, `name`) or a capture with an arm; `speed` is a fraction of the taught speed. */
export interface PlayBody {
  readonly arm: string
  readonly speed: number
  readonly kind: string
  readonly name: string
  readonly capture: number
  readonly revision: number
}

/** The end of a playback: `succeeded`, `preempted`, `rejected` or `failed`, and the cause. */
export interface PlaybackResult {
  readonly status: string
  readonly cause: string
}

/** From the client: answer to a ping. */
export interface Pong {
  readonly k: "pong"
}

/** From the page: preview this arm along an entry (`kind`, `name`) or a capture; without an arm, clear the preview. `revision` selects a revision of the entry, 0 the current one. `place` 0 replaces all previews; places 1 to 4 are shown side by side, each in its colour. */
export interface PreviewTaught {
  readonly k: "look"
  readonly arm: string
  readonly kind: string
  readonly name: string
  readonly capture: number
  readonly revision: number
  readonly place: number
}

/** A recording and the primitive learned from it, as the arm would execute them, and their fit errors. */
export interface PrimitiveComparison {
  readonly demonstration: Trace | null
  readonly primitive: Trace | null
  readonly joint_fit: JointFit | null
  readonly cart_fit: CartFit | null
}

/** The behavior as YAML, its description as text, and the choices made; `id` is the document it was written to. */
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

/** A step with its role, and the part of a grasp; an empty name is an unnamed part. */
export interface ProposedStepBody {
  readonly kind: "joints" | "pose" | "trajectory" | "dmp" | "cart_dmp" | "gripper" | "action"
  readonly name: string
  readonly role: "via" | "approach" | "grasp" | "release" | "depart" | "follow" | "open" | "close"
  readonly part: string | null
}

/** Push the tool of a simulated arm, along the world axes. */
export interface PushToolBody {
  readonly arm: string
  readonly force_n: readonly [number, number, number]
  readonly duration_s: number
}

/** A state that was active when the engine crashed: a person must tell how it ended. */
export interface QuestionBody {
  readonly path: string
  readonly outcomes: readonly string[]
}

/** One recording of the project; `problem` tells why it cannot be opened, empty if it can. */
export interface RecordingBody {
  readonly path: string
  readonly run: string
  readonly behavior: string
  readonly started_at_s: number
  readonly size_bytes: number
  readonly changed_at_s: number
  readonly problem: string
}

/** A behavior that another behavior may refer to. */
export interface ReferableBehaviorBody {
  readonly id: string
  readonly name: string
  readonly description: string
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
  readonly parameters: readonly KeyBody[]
}

/** A behavior that refers to another one, and its referring nodes. */
export interface ReferrerBody {
  readonly id: string
  readonly name: string
  readonly paths: readonly string[]
}

/** A message of the page was refused; `what` is its kind. */
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

/** A request to resume an interrupted run: `answers` by path are `rerun` or an outcome. */
export interface ResumeBody {
  readonly answers?: Dict<string>
  readonly changed?: boolean
}

/** An interrupted run resumes only after these questions are answered. */
export interface ResumeQuestionsBody {
  readonly message: string
  readonly where: string
  readonly hint: string
  readonly questions: readonly QuestionBody[]
}

/** One arm: its mode, its activity, the error of a reflex stop, and its speed override. `way` is its planned path, which the 3D view shows. */
export interface RobotLive {
  readonly name: string
  readonly mode: string
  readonly activity: string
  readonly error: string
  readonly speed_override: number
  readonly controller: string
  readonly way: PathLive | null
}

/** One rule of a concurrency container: the outcome, and the outcomes of children that it needs, all or `at_least`. A rule that preempts some children has no outcome. */
export interface RuleBody {
  readonly outcome: string
  readonly when: Dict<string>
  readonly at_least: number | null
  readonly preempt: readonly string[]
}

/** One run, active or ended. */
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

/** A failed run: the failure originated at event `seq`, at node `path` (empty if in no node). `steps` are the nodes from the root to the origin, `around` the requests, answers and writes of the origin. */
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

/** One run in the list of runs; `waits` is asks, paused or locked while it waits for a person. */
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

/** The event of a journaled run to begin at, at the last entered state unless `path` is given. */
export interface RunPositionBody {
  readonly run: string
  readonly seq: number
  readonly path?: string | null
}

/** A text to write, and the hash of the version it is based on. */
export interface SaveBody {
  readonly text: string
  readonly base_hash: string
}

/** The version that is on disk now. */
export interface SaveResultBody {
  readonly hash: string
  readonly saved_at: number
}

/** The role of the session and the features of this server; `stop` is for operators. The 3D view is at `http://<host>:<cell_view_port>/cell/<page>/`, a separate origin; null without a 3D view. */
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

/** From the client: the 3D view under `/cell/<page>/` shows exactly these groups. */
export interface ShowLayers {
  readonly k: "show"
  readonly page: string
  readonly groups: readonly ("cameras" | "detections" | "frames" | "obstacles" | "people" | "voxels" | "ways")[]
}

/** A request to start a run; without a seed the server chooses one. */
export interface StartBody {
  readonly behavior: string
  readonly parameters?: Dict<unknown>
  readonly inputs?: Dict<unknown>
  readonly seed?: number | null
  readonly supervision?: SupervisionBody
  readonly begin?: RunPositionBody | null
}

/** From the page: prepare to jog this arm, until `rest`. */
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

/** A state that a behavior can use. */
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

/** One step back of a paused run, in the branch of `path` if given. */
export interface StepBackBody {
  readonly path: string
}

/** One step of a paused run, in the branch of `path` if given. */
export interface StepBody {
  readonly mode?: "into" | "over" | "out"
  readonly path?: string
}

/** A request to stop a run; `reason` goes into its event log. */
export interface StopBody {
  readonly reason?: string
}

/** The STOP endpoint, independent of this server: POST `{"token": …, "reason": …}` as plain text to `url`. */
export interface StopEndpointBody {
  readonly url: string
  readonly token: string
}

/** From the page: the key is up. */
export interface StopJog {
  readonly k: "rest"
}

/** Supervision options of a run; `flexcell run --help` explains the same options. */
export interface SupervisionBody {
  readonly autonomy?: "off" | "low" | "high" | "full"
  readonly demand_operator?: boolean
  readonly breakpoints?: boolean
  readonly start_paused?: boolean
  readonly loss_policy?: "hold" | "continue" | "stop"
  readonly loss_timeout_s?: number
}

/** New tags of an entry; `revision` is the revision that they are based on. */
export interface TagsBody {
  readonly kind: string
  readonly name: string
  readonly tags: readonly string[]
  readonly revision: number
}

/** The targets that an arm of the document's cell cannot reach. `dropped` is true if the page has sent a newer text; `problem` tells why the targets could not be checked. */
export interface TargetFindingsBody {
  readonly findings: readonly FindingBody[]
  readonly problem: string
  readonly dropped: boolean
}

/** A text whose targets are checked; a newer request of the same page replaces the pending one. */
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

/** A text under edit. */
export interface TextBody {
  readonly text: string
}

/** A run up to event `seq`, or its intervals that started or ended after the requested event. `merged` means that adjacent intervals were merged: request a shorter time range for the exact ones. `left_out` is the number of dropped markers. */
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

/** The intervals of one node, in order; its path gives its depth. */
export interface TimelineRow {
  readonly path: string
  readonly spans: readonly ActivationInterval[]
}

/** Measured tool state: opening of a gripper (m) or closing of a hand (0 to 100), and whether it holds a part. */
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

/** A transition inside a machine. */
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

/** One version of a document and when it was first seen; `by` is `editor`, or `file` for a change on disk. */
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

/** A node that waits at the gate, `before` its entry or `after` its outcome, with the reasons. */
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

/** From the client: watch this run (empty: the list of runs only); the response is a snapshot. */
export interface WatchRun {
  readonly k: "watch"
  readonly run?: string
}

export type Frame = Hello | LiveSnapshot | LiveDelta | DocumentsChanged | Ping

export type Edit = AddNode | RemoveNodes | RenameNode | MoveNodes | SetTransition | ClearTransition | SetInitial | SetParameter | ClearParameter | SetField | SetPositions | GroupNodes | UngroupNode | DuplicateNodes | PasteNodes | SetDocument | AutoConnect
