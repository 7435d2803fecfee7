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

/** What would be written: the id and name of the new document, its plan, and the ids of copies of nested ones. */
export interface AdaptationBody {
  readonly id: string
  readonly name: string
  readonly plan: AdaptationPlan
  readonly copies: readonly string[]
}

/** What a behavior becomes in another cell. Attributes: own_cell: The name of the cell that the behavior is written for. cell: The name of the other cell. names: What becomes of each name. undecided: Expressions that make names of the own cell in a run; they stay as they are. findings: Those of the check of the adapted behavior in the other cell. */
export interface AdaptationPlan {
  readonly own_cell: string
  readonly cell: string
  readonly names: readonly MappedName[]
  readonly undecided: readonly UndecidedName[]
  readonly findings: readonly FindingView[]
}

/** What names of the behavior become, by `kind:name`, an empty one to keep it; others are proposed. `id` is that of the new document, one beside the original if empty; `name` that of the new behavior. */
export interface AdaptationRequest {
  readonly id?: string
  readonly name?: string
  readonly names?: Dict<string>
}

/** Add an item at the end of a section, which is written if the document has none. */
export interface AddCellItem {
  readonly edit: "add_item"
  readonly section: "bonds" | "cameras" | "connectors" | "devices" | "equipment" | "fixtures" | "frames" | "modules" | "parts" | "robots"
  readonly name: string
  readonly value: Dict<unknown>
}

/** Insert a new node into a container; its name is generated if none is given. `kind` is a key of documents: state, behavior, machine, concurrency, priority, tree, foreach, and inside trees sequence, selector, and so on. `runs` is what a state, behavior or behaviour runs. With `yaml`, nodes as `copy` returns them are the content instead. `after` connects the open success outcomes of a sibling (its path) to the new node; `on_edge` inserts it into a transition. `index` is its position among the children. */
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

/** A visit of a node in the left run and the same one in the right run; null in the run that does not have it. */
export interface AlignedVisit {
  readonly path: string
  readonly left: Visit | null
  readonly right: Visit | null
}

/** An arm with the names of its skills. */
export interface ArmInfo {
  readonly name: string
  readonly model: string
  readonly urdf: string
  readonly joint_names: readonly string[]
  readonly lower_rad: readonly number[]
  readonly upper_rad: readonly number[]
  readonly velocity_rad_s: readonly number[]
  readonly acceleration_rad_s2: readonly number[]
  readonly base: Pose
  readonly tool_frame: string
  readonly licence: string
  readonly effort_nm: readonly number[]
  readonly jerk_rad_s3: readonly number[]
  readonly tool: string
  readonly tool_kind: string
  readonly tool_licence: string
  readonly calibration: string
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

/** What is open at one arm after a stop. `part` is the name of the part that its tool holds, `?` when unknown, empty for none; `kept` is true once an operator has decided that the arm keeps it. `has_moved` is true once it is elsewhere than where it was stopped. `home` is the joints entry of its home configuration, empty if there is none; `home_names` are those looked for. `problem` is why the last step with this arm failed, empty if it did not. */
export interface ArmRecovery {
  readonly name: string
  readonly part: string
  readonly kept: boolean
  readonly can_release: boolean
  readonly has_moved: boolean
  readonly home: string
  readonly home_names: readonly string[]
  readonly at_home: boolean
  readonly problem: string
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
  readonly level: "full" | "high" | "low" | "off"
}

/** A version to compare with; `results` is the path of its file in the project. */
export interface Baseline {
  readonly results: string
  readonly version: BaselineVersion
}

/** Another version that has executed configurations of a sweep. */
export interface BaselineVersion {
  readonly version: string
  readonly runs: number
  readonly successes: number
  readonly changed: readonly string[]
  readonly saved_unix_s: number
}

/** What one batch has shown. */
export interface BatchTrace {
  readonly batch: number
  readonly runs: number
  readonly failures: number
  readonly refused: number
  readonly nearest: number | null
}

/** A new version of the document replaced the running one; `report` has a line for each change. `restarted` are the active nodes that are preempted and entered again, `removed` the removed branches of active concurrency containers; `preempt` is true when the operator allowed that. `replaced` are the nodes of the old version whose class or kind has changed. `documents` are the texts of the new version, when they can be stored, and `behavior` names the behavior among them. */
export interface BehaviorChanged {
  readonly event: "behavior_changed"
  readonly seq: number
  readonly time_s: number
  readonly document: string
  readonly report: readonly string[]
  readonly preempt?: boolean
  readonly restarted?: readonly string[]
  readonly removed?: readonly string[]
  readonly replaced?: readonly string[]
  readonly behavior?: string
  readonly documents?: Dict<string>
}

/** A behavior that another behavior may reference by its file; `icon` is the name of its icon. */
export interface BehaviorReferenceView {
  readonly id: string
  readonly name: string
  readonly icon: string
  readonly description: string
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
  readonly parameters: readonly KeyView[]
}

/** One line of the list of behaviors: how many findings prevent a run, and how many do not. */
export interface BehaviorSummary {
  readonly id: string
  readonly name: string
  readonly description: string
  readonly errors: number
  readonly warnings: number
  readonly fit: CellFit
}

/** A behavior for the dashboard's list and graph; `graph` is None when the behavior cannot be read. */
export interface BehaviorView {
  readonly id: string
  readonly name: string
  readonly description: string
  readonly parameters: readonly ParameterView[]
  readonly findings: readonly FindingView[]
  readonly graph: GraphNode | null
  readonly view: Dict<readonly [number, number]>
  readonly success: readonly string[]
  readonly fit: CellFit
}

/** A condition of concurrency container `path` preempts some branches while the others continue. `branches` are the preempted branches that had not ended; each has ended, without an outcome, after its clean-up. */
export interface BranchesPreempted {
  readonly event: "branches_preempted"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly condition: string
  readonly branches: readonly string[]
}

/** Pause the run `before` the entry or `after` the outcome of the nodes that `path` matches. `path` may contain the wildcards `*` and `?`. `condition` (`if:`) is an expression over userdata and parameters. The run pauses from hit number `hits` on. `outcomes` limits an `after` breakpoint to these outcomes. One with `once` is removed when it has paused the run. */
export interface Breakpoint {
  readonly path: string
  readonly when?: "after" | "before"
  readonly if?: string | null
  readonly hits?: number
  readonly outcomes?: readonly string[]
  readonly enabled?: boolean
  readonly once?: boolean
}

/** All breakpoints of a run or a behavior; they replace the previous ones. */
export interface BreakpointsBody {
  readonly breakpoints: readonly Breakpoint[]
}

/** One line of the bus listing. */
export interface BusEntry {
  readonly kind: string
  readonly name: string
  readonly type: string
  readonly detail: string
}

/** The numeric fields of all topics. */
export interface BusFields {
  readonly topics: readonly TopicFields[]
}

/** The JSON Schema of a request or message. */
export interface BusForm {
  readonly name: string
  readonly schema: Dict<unknown>
}

/** All topics, skills and parameters of the bus, without metrics. */
export interface BusListing {
  readonly shape: string
  readonly topics: readonly TopicInfo[]
  readonly skills: readonly SkillInfo[]
  readonly parameters: readonly ParameterInfo[]
}

/** A message to publish on a topic that takes commands. */
export interface BusMessageBody {
  readonly topic: string
  readonly message: Dict<unknown>
}

/** Metrics of the bus, once a second; a changed `shape` means that the list of the bus has changed. */
export interface BusMetricsFrame {
  readonly k: "traffic"
  readonly shape: string
  readonly topics: Dict<TopicMetrics>
  readonly leases: readonly LeaseMetrics[]
  readonly goals: readonly GoalInfo[]
}

/** A new value of a parameter. */
export interface BusParameterBody {
  readonly name: string
  readonly value: unknown
}

/** A request to a service or action on the bus; `address` is `<namespace>/<skill_name>`. */
export interface BusRequestBody {
  readonly address: string
  readonly request?: Dict<unknown>
}

/** From the page: a button of a keyboard or gamepad, to publish on `buttons/<source>/<button>`. */
export interface ButtonInput {
  readonly k: "button"
  readonly source: string
  readonly button: string
  readonly value: boolean
}

/** A note on the canvas: plain text, its upper left corner relative to its container, its size, its colour. */
export interface CanvasNote {
  readonly text: string
  readonly position: readonly [number, number]
  readonly size: readonly [number, number]
  readonly colour: "blue" | "green" | "grey" | "pink" | "yellow"
}

/** A capture with all its data; missing data is None or empty. */
export interface Capture {
  readonly summary: CaptureSummary
  readonly names: readonly string[]
  readonly joints: readonly number[]
  readonly pose: Pose | null
  readonly trajectory: Trajectory | null
  readonly joint_dmp: JointDmp | null
  readonly joint_fit: JointFit | null
  readonly cart_dmp: CartDmp | null
  readonly cart_fit: CartFit | null
  readonly gripper: GripperSetting | null
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

/** A dynamic movement primitive of the tool centre point (RCL table 7), with a quaternion DMP for its orientation. `goal` and `y0` are x y z in metres and a unit quaternion x y z w, `dy0` the velocity (m/s) and the angular velocity (rad/s) at the start. `w1` to `w3` are the weights of the motion along x, y and z, `w4` to `w6` those of the rotation about x, y and z; the other fields are as in `JointDmp`. All values are along the axes of `frame`: `world`, or a frame of the arm. `tasktrans` is a rigid transform of the whole motion in that frame, 4 x 4 row by row; empty for none. The signs of the quaternions matter: the rotation takes the direction in which the quaternion reaches `goal` without a change of sign. */
export interface CartDmp {
  readonly N: number
  readonly a_z: number
  readonly a_x: number
  readonly tau: number
  readonly id: number
  readonly goal: readonly number[]
  readonly y0: readonly number[]
  readonly dy0: readonly number[]
  readonly c: readonly number[]
  readonly sigma: readonly number[]
  readonly w1: readonly number[]
  readonly w2: readonly number[]
  readonly w3: readonly number[]
  readonly w4: readonly number[]
  readonly w5: readonly number[]
  readonly w6: readonly number[]
  readonly tasktrans: readonly number[]
  readonly frame: string
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
  readonly states: readonly StateView[]
  readonly containers: readonly ContainerView[]
  readonly behaviors: readonly BehaviorReferenceView[]
  readonly entries: readonly EntryName[]
  readonly names: Dict<readonly string[]>
}

/** One link with the rest of its chain; `because` is the next link towards the root cause. `nodes` are the nodes that an error passed through, `path at file:line:column`, innermost first. */
export interface Cause {
  readonly message: string
  readonly where?: string
  readonly kind?: string
  readonly compared?: readonly MeasuredValue[]
  readonly because?: Cause | null
  readonly nodes?: readonly string[]
}

/** Failed runs with the same innermost cause; numbers in its message may differ between them. */
export interface CauseGroup {
  readonly at: string
  readonly message: string
  readonly runs: number
  readonly examples: readonly number[]
}

/** One link as logs show it; `skill` is the skill at the address `where` in words, empty if that is no address. */
export interface CauseLine {
  readonly message: string
  readonly where: string
  readonly kind: string
  readonly compared: readonly MeasuredValue[]
  readonly skill: string
}

/** Whether every device of the cell is connected; the latest value of `cell/connection`. `reason` names the lost devices with the causes; for a reconnected cell, the differences from before. */
export interface CellConnection {
  readonly connected: boolean
  readonly reason: string
}

/** A document of the cell on disk; `saved_at` is the time of its last change, seconds since 1970. */
export interface CellDocumentBody {
  readonly id: string
  readonly saved_at: number
  readonly draft: CellDraft
}

/** A document that can be edited: its id is its path in the project. `folder` is what a cell document beside the open one writes for a module; empty for the cell itself. */
export interface CellDocumentName {
  readonly id: string
  readonly kind: "cell" | "module"
  readonly folder: string
}

/** What a text says; one that cannot be read has findings and no items. `frames` are the poses in the world, or in the frame of the module, of all that something may stand in, `parts` those of parts, `positions` those of devices, by names in the cell; none while the text has errors. The path of a finding is `fixtures/floor`, empty for one that is in no item. */
export interface CellDraft {
  readonly text: string
  readonly hash: string
  readonly kind: "cell" | "module"
  readonly items: readonly DraftItem[]
  readonly findings: readonly FindingView[]
  readonly frames: Dict<Pose>
  readonly parts: Dict<Pose>
  readonly positions: Dict<readonly string[]>
}

/** A text after edits, with what it says; the text as it was if an edit was refused. */
export interface CellEditAnswer {
  readonly draft: CellDraft
  readonly refused: EditRefusal | null
}

/** A text and the edits to apply, all or none. */
export interface CellEditsBody {
  readonly text: string
  readonly edits: readonly (AddCellItem | RemoveCellItem | RenameCellItem | SetCellField | RenameCellField)[]
}

/** The cell that a behavior is written for, and why it cannot be executed in the connected one. */
export interface CellFit {
  readonly cell: string
  readonly obstacle: string
}

/** One item of a cell. `model` says what it is, in the words of the document: `panda`, `box`, `mujoco`. `owner` is the address of the item that carries it, empty for one that stands by itself. `topics` are those of the bus that tell of it. `text` are its lines of the document, the first of which has the number `line`, from 1; `file` is the document of its module, empty for that of the cell. */
export interface CellItem {
  readonly path: string
  readonly kind: "bond" | "camera" | "device" | "equipment" | "fixture" | "frame" | "module" | "occupancy" | "part" | "person" | "robot" | "store" | "tool" | "world"
  readonly name: string
  readonly model: string
  readonly owner: string
  readonly topics: readonly string[]
  readonly text: string
  readonly line: number
  readonly file: string
}

/** The items of a cell in the order of its document, which is `file`. `changed` says that the document has changed since the cell was opened: the items are those of the open cell, and their lines those of the document now. */
export interface CellItems {
  readonly cell: string
  readonly description: string
  readonly file: string
  readonly changed: boolean
  readonly items: readonly CellItem[]
}

/** Where the items of the cell are now; at most five per second, and only after a change. `poses` are those of parts and frames in the world frame by name, rounded to 0.1 mm and 0.1 mrad; `cameras` those of the optical frames of cameras. `tools` are by the name of their arm, `devices` by their address on the bus. `modules` are the connectors of modules by their names, empty where one is not plugged. */
export interface CellStateFrame {
  readonly k: "cell"
  readonly poses: Dict<Pose>
  readonly cameras: Dict<Pose>
  readonly tools: Dict<ToolHolds>
  readonly devices: Dict<DeviceNow>
  readonly modules: Dict<string>
}

/** The latest stop: `stopping`, then `stopped` until an operator releases it, then `released`. While it is not released no run starts; an operator may move arms and tools by hand. `parts` is `reset` once the parts of a simulation are back at their initial poses, `absent` in a cell that cannot reset them. `devices` are arms and world, in the order of the cell. `real` are the devices with a driver. */
export interface CellStop {
  readonly number: number
  readonly phase: "released" | "stopped" | "stopping"
  readonly reason: string
  readonly since_unix_s: number
  readonly devices: readonly StoppedDevice[]
  readonly runs: readonly StoppedRun[]
  readonly arms: readonly ArmRecovery[]
  readonly parts: "absent" | "open" | "reset"
  readonly real: readonly DeviceRecovery[]
}

/** The cell was stopped, what is open after it has changed, or it was released; null once it is closed. */
export interface CellStopChanged {
  readonly k: "stop"
  readonly stop: CellStop | null
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

/** Two versions on the same configurations: `pair.only_first` are the runs in which only the baseline succeeded. */
export interface Comparison {
  readonly baseline: string
  readonly changed: readonly string[]
  readonly pair: RatePair
  readonly interval: Interval
  readonly margin: number | null
  readonly broken: readonly number[]
}

/** Holds when the children in `when` have ended with the outcome named for each: all, or any `at_least` of them. It decides the `outcome` of the container, or has an empty `outcome` and preempts the children in `preempt`. */
export interface ConcurrencyCondition {
  readonly outcome: string
  readonly when: Dict<string>
  readonly at_least: number | null
  readonly preempt: readonly string[]
}

/** What is wrong with a condition; empty if nothing is. `names` are the keys and parameters that it may use. */
export interface ConditionCheck {
  readonly problem: string
  readonly hint: string
  readonly names: readonly string[]
}

/** What is different in one run of a sweep; the rest is what all its runs have in common. */
export interface Configuration {
  readonly number: number
  readonly seed: number
  readonly values: Dict<unknown>
}

/** The document has changed on disk; `merge` has both changes, null if they cannot be merged by nodes. */
export interface ConflictBody {
  readonly message: string
  readonly where: string
  readonly hint: string
  readonly theirs: string
  readonly theirs_hash: string
  readonly merge: NodeMerge | null
}

/** A request to reconnect the lost devices of the cell. */
export interface ConnectBody {
}

/** A kind of node that holds others; `icon` is the name of its icon, `form` the fields that its form shows. */
export interface ContainerView {
  readonly kind: string
  readonly title: string
  readonly doc: string
  readonly only_in_tree: boolean
  readonly icon: string
  readonly form: readonly KindField[]
}

/** State of a run as shown to an operator. */
export interface ControlView {
  readonly paused: boolean
  readonly confirmed: boolean
  readonly cannot: readonly string[]
  readonly waiting: readonly GateWait[]
  readonly locks: readonly string[]
  readonly breakpoints: readonly Breakpoint[]
  readonly autonomy: "full" | "high" | "low" | "off"
  readonly operator: string
  readonly active: readonly string[]
  readonly stepping: boolean
  readonly demanded: boolean
  readonly loss_policy: "continue" | "hold" | "stop"
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

/** A node that can be entered, or an exit of the node at `path`. `name` is the outcome of an `outcome` or `transition`, the text of a `condition` with its number in front, or the status of a tree node; `target` is its target. `count` is how often it was executed. */
export interface CoverageItem {
  readonly kind: "condition" | "guard" | "node" | "on_error" | "outcome" | "status" | "timeout" | "transition"
  readonly path: string
  readonly name?: string
  readonly target?: string
  readonly file: string
  readonly line: number
  readonly column: number
  readonly count?: number
}

/** What a number of runs has shown of the success rate; a design that is not random has no interval. */
export interface CurvePoint {
  readonly runs: number
  readonly rate: number
  readonly interval: Interval | null
}

/** A value that the aligned visit `index` read on its entry or wrote, and that is another one in the right run. */
export interface DataDifference {
  readonly at: string
  readonly left: string | null
  readonly right: string | null
  readonly index: number
  readonly path: string
  readonly kind: "read" | "wrote"
}

/** From the client: subscribe to exactly this data. `number` is returned with the samples of these `fields`, each written `topic:path`. `traffic` requests rates, leases and goals, `topic` the messages of one topic, `run` the userdata of a run with the values of `watches`, `goals` the progress of the goals of a run, `cell` where the items of the cell are and what its tools hold. */
export interface DataSubscription {
  readonly k: "look"
  readonly number?: number
  readonly traffic?: boolean
  readonly topic?: string
  readonly fields?: readonly string[]
  readonly run?: string
  readonly watches?: readonly Watch[]
  readonly goals?: string
  readonly cell?: boolean
}

/** A deleted document that can be restored; `saved_at` is when its last text was first seen. */
export interface DeletedDocumentBody {
  readonly id: string
  readonly saved_at: number
}

/** The request for a proposal; with `id` the behavior is also written as a new document. The server fills in `name` and `cell` of the options. */
export interface DemonstrationBody {
  readonly steps: readonly TaughtStep[]
  readonly options?: ProposalOptions
  readonly id?: string
}

/** One device for which the document of the cell names a driver. Attributes: device: Its name in the document: `left`, `left/gripper`, `vice`. address: Its namespace on the bus, which names the kind of tool: `left/hand`. driver: The name of the driver. simulated: Whether the open cell simulates it instead. can: What the driver can do, in words. cannot: What it cannot do, in words, with the reason where there is one beside the device. proven: What it was tested against, and whether it ever ran on hardware. page: Path of its documentation. enabling: What enabling the device does at it. options: The options of the driver that are not at their defaults. schema: The JSON Schema of the options. problem: Why the driver or its options cannot be read; all else is empty then. */
export interface DeviceDetails {
  readonly device: string
  readonly address: string
  readonly driver: string
  readonly simulated: boolean
  readonly can: readonly string[]
  readonly cannot: readonly string[]
  readonly proven: string
  readonly page: string
  readonly enabling: string
  readonly options: Dict<unknown>
  readonly schema: Dict<unknown>
  readonly problem: string
}

/** How fresh the readings of a real device are; the latest value of `<device>/link`. `readings_hz` and `longest_gap_s` are those of the last half second, `age_s` is the age of the last reading. `speed_scaling` is the share of the commanded speed that the controller permits, None where it does not say. */
export interface DeviceLink {
  readonly readings_hz: number
  readonly longest_gap_s: number
  readonly age_s: number
  readonly speed_scaling: number | null
}

/** A real device: whether it may move, and how fresh its readings are. */
export interface DeviceNow {
  readonly state: DeviceState
  readonly link: DeviceLink | null
}

/** Whether a real device may move after a stop; `problem` is why not, empty if it may. `name` is its address on the bus. A device that does not answer has to be connected again before it is enabled. */
export interface DeviceRecovery {
  readonly name: string
  readonly connected: boolean
  readonly enabled: boolean
  readonly problem: string
}

/** Whether a real device answers and may move; the latest value of `<device>/device`. Attributes: driver: Its driver. address: Where it is connected. connected: Whether it answers. enabled: Whether it may move. problem: Why it does not answer or may not move, empty when `enabled`. fault: Its own fault by name. mode: All of this in one word. firmware: What it says of its firmware; empty if it says nothing. safety: Why its controller does not move, by name; `normal` while it can, empty where it does not say. last_cause: Why it was stopped or lost last; stays after it was enabled again. last_cause_unix_s: When that was; 0 for never. enabled_by: Who has enabled it last, as the person calls themselves. enabled_for: The reason that was given. */
export interface DeviceState {
  readonly driver: string
  readonly address: string
  readonly connected: boolean
  readonly enabled: boolean
  readonly problem: string
  readonly fault: string
  readonly mode: "enabled" | "fault" | "lost" | "reading" | "stopped"
  readonly firmware: string
  readonly safety: string
  readonly last_cause: string
  readonly last_cause_unix_s: number
  readonly enabled_by: string
  readonly enabled_for: string
}

/** The status of a stop at one device; `connected` is false once its process has ended. */
export interface DeviceStop {
  readonly name: string
  readonly connected: boolean
  readonly acknowledged: boolean
  readonly at_rest: boolean
}

/** Where two runs first differ: a `visit` that one does not have, another `outcome`, or another `cause` of it. `index` is that of the aligned visit. `left_s` and `right_s` are when it shows in each run, null where the run does not have the visit. */
export interface Divergence {
  readonly kind: "cause" | "outcome" | "visit"
  readonly path: string
  readonly index: number
  readonly left_s: number | null
  readonly right_s: number | null
  readonly text: string
}

/** Graph and findings of a text; `graph` and `document` are None if it cannot be read. `checked` is False if the graph was built but the check has not run yet. */
export interface DocumentAnalysis {
  readonly hash: string
  readonly graph: DocumentNode | null
  readonly document: DocumentInfo | null
  readonly findings: readonly FindingView[]
  readonly checked: boolean
}

/** A document on disk; `saved_at` is the time of its last change, seconds since 1970. */
export interface DocumentBody {
  readonly hash: string
  readonly graph: DocumentNode | null
  readonly document: DocumentInfo | null
  readonly findings: readonly FindingView[]
  readonly checked: boolean
  readonly id: string
  readonly text: string
  readonly saved_at: number
}

/** All changes, those of the document first; `layout_only` when only positions on the canvas differ. */
export interface DocumentDiff {
  readonly changes: readonly NodeChange[]
  readonly layout_only: boolean
}

/** A document of the behavior with another text: the lines of a unified difference, at most `MAX_LINES`. */
export interface DocumentDifference {
  readonly name: string
  readonly lines: readonly string[]
}

/** The declarations of the document itself, as written. */
export interface DocumentInfo {
  readonly name: string
  readonly description: string
  readonly cell: string | null
  readonly parameters: Dict<Dict<unknown>>
  readonly userdata: Dict<unknown>
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
}

/** One node as written: values raw, `${…}` not evaluated; lines and columns count from 1. `targets` are its own transitions, outcome to target; `transitions` are, as in the graph of a run, the arrows between its children. `settings` are the remaining keys of its kind, such as `memory` or `times`. `document` is the id of the behavior that it references. `exits` are the outcomes that its container does not lead anywhere yet. `role` is its key in the surrounding tree node, such as `then`. `canvas_notes` stand freely inside it. */
export interface DocumentNode {
  readonly path: string
  readonly name: string
  readonly kind: string
  readonly icon: string
  readonly title: string
  readonly description: string
  readonly outcomes: readonly string[]
  readonly children: readonly DocumentNode[]
  readonly transitions: readonly GraphTransition[]
  readonly initial: string | null
  readonly conditions: readonly string[]
  readonly disabled: boolean | string
  readonly label: string
  readonly role: string
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
  readonly canvas_notes: Dict<CanvasNote>
  readonly position: readonly [number, number] | null
  readonly rules: readonly ConcurrencyCondition[]
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
  readonly check?: boolean
}

/** An item of a document as written, with its first and last line, from 1. */
export interface DraftItem {
  readonly section: "bonds" | "cameras" | "connectors" | "devices" | "equipment" | "fixtures" | "frames" | "modules" | "parts" | "robots"
  readonly name: string
  readonly line: number
  readonly end_line: number
  readonly value: Dict<unknown>
}

/** From the page, every 50 ms while the mouse is down on its 3D view. */
export interface DragKeepAlive {
  readonly k: "held"
}

/** A device for which the document of the cell names a driver: `left`, `left/gripper`. `simulated` says that the open cell simulates it instead. */
export interface DrivenDeviceChoice {
  readonly device: string
  readonly driver: string
  readonly simulated: boolean
}

/** Insert copies of nodes next to them; transitions among them connect the copies. */
export interface DuplicateNodes {
  readonly edit: "duplicate"
  readonly paths: readonly string[]
}

/** How long something took in `count` runs, in seconds: the median, the quartiles, the extremes. `last_s` is that of the latest run of all, however it ended; null where that run did not have it or has not ended. */
export interface DurationSpread {
  readonly count: number
  readonly median_s: number
  readonly lower_s: number
  readonly upper_s: number
  readonly least_s: number
  readonly most_s: number
  readonly last_s: number | null
}

/** A text after edits with its findings, and its graph, or the difference from the graph that the asker has. */
export interface EditAnswer {
  readonly hash: string
  readonly graph: DocumentNode | null
  readonly document: DocumentInfo | null
  readonly findings: readonly FindingView[]
  readonly checked: boolean
  readonly text: string
  readonly changed: readonly string[]
  readonly refused: EditRefusal | null
  readonly difference: GraphDifference | null
}

/** Why no edit was applied; `index` is the edit that failed, `losses` are those that it did not accept. */
export interface EditRefusal {
  readonly message: string
  readonly hint: string
  readonly index: number
  readonly losses: readonly TypeLoss[]
}

/** A text and the edits to apply, all or none. `graph` is the hash of the text whose graph the page has; the answer then has only the difference, if the server knows that graph too. */
export interface EditsBody {
  readonly text: string
  readonly check?: boolean
  readonly edits: readonly Edit[]
  readonly graph?: string | null
}

/** Entries of the store have changed. */
export interface EntriesChanged {
  readonly k: "entries"
}

/** One change of an entry: author, time (UTC, milliseconds since 1970), reason; published on `store/changes`. */
export interface EntryChanged {
  readonly kind: string
  readonly name: string
  readonly revision: number
  readonly deleted: boolean
  readonly tags: readonly string[]
  readonly by: string
  readonly reason: string
  readonly changed_unix_ms: number
}

/** Every change of an entry, oldest first. */
export interface EntryHistory {
  readonly changes: readonly EntryChanged[]
}

/** A named entry of the cell's store. */
export interface EntryName {
  readonly kind: string
  readonly name: string
}

/** The last changes of the first matching entries, and the total number of matching ones. */
export interface EntryPage {
  readonly entries: readonly EntryChanged[]
  readonly total: number
}

/** A stored entry: `value` has the fields of its `kind`; `revision` counts its changes. `tags` is None when unspecified. */
export interface EntryRecord {
  readonly kind: string
  readonly name: string
  readonly value: Dict<unknown>
  readonly revision: number
  readonly tags?: readonly string[] | null
}

/** Why a request failed: message, location (a parameter's name, a file, a node path) and hint. */
export interface ErrorBody {
  readonly message: string
  readonly where: string
  readonly hint: string
}

/** A page of a run's events from the journal; `after=last` requests the next page. */
export interface EventsBody {
  readonly events: readonly (RunStarted | RunResumed | NodeEntered | NodeExited | UserdataAppended | UserdataWritten | TransitionTaken | NodeDiverted | NodeSkipped | BranchesPreempted | NodeRetried | StatusChanged | GoalSent | GoalFinished | GoalHeld | GoalResumed | ServiceCalled | ServiceAnswered | MessagePublished | MessageReceived | MessageLogged | OperatorCommanded | GateReached | GatePassed | OutcomeRequested | OutcomeWithdrawn | PauseConfirmed | OperatorChanged | UndoStarted | UndoEnded | RunSteppedBack | BehaviorChanged | FaultInjected | LoopBlocked | NodeAbandoned | StopRequested | RunEnded)[]
  readonly last: number
}

/** What a factor is varied over: a list of values, each equally likely, or a distribution of numbers. `nominal` is its value where nothing is varied: by default that of the parameter or of the cell. `levels` is the number of values that a grid takes of a distribution: the middles of so many equally likely parts. */
export interface Factor {
  readonly values?: readonly unknown[] | null
  readonly uniform?: readonly [number, number] | null
  readonly log_uniform?: readonly [number, number] | null
  readonly normal?: Normal | null
  readonly integer?: boolean
  readonly nominal?: number | string | boolean | null
  readonly levels?: number
}

/** A value of a behavior or its cell that a sweep can vary, with its value where nothing is varied. */
export interface FactorChoice {
  readonly address: string
  readonly nominal: unknown
  readonly unit: string
  readonly description: string
  readonly least: number | null
  readonly most: number | null
  readonly options: readonly unknown[]
}

/** The parts of one factor in which there is a run. */
export interface FactorCoverage {
  readonly address: string
  readonly parts: number
  readonly covered: number
  readonly gap: readonly [number, number] | null
  readonly gap_share: number | null
}

/** How the success and the duration of runs depend on a factor. */
export interface FactorEffect {
  readonly address: string
  readonly with_success: number | null
  readonly with_duration: number | null
  readonly levels: readonly Level[]
}

/** The values of a factor with which runs failed alike; the search chose them, so that they are no random sample. */
export interface FactorRegion {
  readonly address: string
  readonly listed: boolean
  readonly failing: readonly unknown[]
  readonly executed: readonly unknown[]
  readonly share: number
  readonly passed_inside: number
}

/** Failing runs with the same root cause, and where they are. */
export interface FailureCluster {
  readonly cause: CauseGroup
  readonly regions: readonly FactorRegion[]
}

/** An estimate, and an interval that may be looked at at any time. */
export interface FailureProbability {
  readonly estimate: number
  readonly interval: Interval
  readonly effective_failures: number
}

/** A fault of the fault file was applied to a request. */
export interface FaultInjected {
  readonly event: "fault"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly address: string
  readonly fault: string
  readonly detail?: string
}

/** One field that differs; None on the side on which it does not exist. */
export interface FieldChange {
  readonly field: string
  readonly before: unknown
  readonly after: unknown
}

/** One finding with its position in the document. */
export interface FindingView {
  readonly severity: string
  readonly code: string
  readonly message: string
  readonly path: string
  readonly line: number
  readonly column: number
  readonly hint: string
}

/** Edits that would resolve a finding; `title` describes them completely. A fix is `sure` if it only corrects an evident typo, or removes something without effect: it may be applied automatically. For all others a person must choose. */
export interface Fix {
  readonly title: string
  readonly edits: readonly Edit[]
  readonly sure: boolean
}

/** A finding of a text with its fixes. */
export interface FixesBody {
  readonly severity: string
  readonly code: string
  readonly message: string
  readonly path: string
  readonly line: number
  readonly column: number
  readonly hint: string
  readonly fixes: readonly Fix[]
}

/** End an active or waiting node with an outcome. */
export interface ForceBody {
  readonly path: string
  readonly outcome: string
}

/** The restored value of `key` in the scope of a container; `defined` is false when it had no value. */
export interface FormerValue {
  readonly scope: string
  readonly key: string
  readonly value?: unknown
  readonly defined?: boolean
}

/** The node continues after the gate. */
export interface GatePassed {
  readonly event: "gate_passed"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly point: string
}

/** A node waits `before` its entry or `after` its outcome because of `reasons`. */
export interface GateReached {
  readonly event: "gate"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly point: string
  readonly reasons: readonly string[]
  readonly outcome?: string
}

/** A node that waits at the gate: gate point, visit, and reasons. `required` is the autonomy level that the outcome requires; empty before an entry. */
export interface GateWait {
  readonly path: string
  readonly visit: number
  readonly point: "after" | "before"
  readonly outcome: string
  readonly reasons: readonly string[]
  readonly required: string
}

/** Another run whose arms are shown as ghosts, at a time of its own clock. */
export interface GhostRequest {
  readonly run: string
  readonly time_s: number
}

/** Last line: the end of the goal; the device is at rest. */
export interface GoalEndLine {
  readonly k: "end"
  readonly end: GoalEnd
}

/** The end of a goal; `result` may be partial unless it succeeded, `cause` is the reason of a failure. */
export interface GoalEnd {
  readonly status: GoalStatus
  readonly result: unknown
  readonly cause: Cause | null
}

/** A goal ended: succeeded, canceled, aborted or rejected. */
export interface GoalFinished {
  readonly event: "goal_finished"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly goal: string
  readonly status: string
  readonly result?: Dict<unknown> | null
  readonly cause?: Cause | null
}

/** The device confirmed rest and keeps the goal. */
export interface GoalHeld {
  readonly event: "goal_held"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly goal: string
}

/** An active goal: its run and node, and its latest feedback. */
export interface GoalInfo {
  readonly id: string
  readonly address: string
  readonly run: string
  readonly node: string
  readonly status: string
  readonly feedback: unknown
}

/** An active goal: `share` is its progress from 0 to 1 if the feedback has it, `words` the feedback as text. */
export interface GoalProgress {
  readonly address: string
  readonly status: string
  readonly share: number | null
  readonly words: string
}

/** Status and latest feedback of the goal; at most five lines per second. */
export interface GoalProgressLine {
  readonly k: "course"
  readonly status: string
  readonly feedback: unknown
}

/** A held goal was resumed. */
export interface GoalResumed {
  readonly event: "goal_resumed"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly goal: string
}

/** A state sent an action goal or service request. */
export interface GoalSent {
  readonly event: "goal"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly goal: string
  readonly address: string
  readonly request: Dict<unknown>
}

/** First line: the goal's id, for its cancellation. */
export interface GoalSentLine {
  readonly k: "sent"
  readonly goal: string
}

/** The status of a goal; the last four are final. */
export type GoalStatus = "aborted" | "active" | "canceled" | "canceling" | "held" | "pending" | "rejected" | "succeeded"

/** All active goals of a run, by the path of the node that sent them. */
export interface GoalsFrame {
  readonly k: "goals"
  readonly run: string
  readonly goals: Dict<GoalProgress>
}

/** How the graph of the text with the hash `base` becomes another one; nodes are named by path. `nodes` are those that are new or say something else, without children, transitions and lines. `children` are the names of all children, in order, where these changed; a node that is no child any more is gone. `arrows` are the transitions between children of a node, by the child that they leave, where they changed. `shifts` are pairs of a line of the old graph and a number of lines by which everything from there on moved; `lines` are line, column and last line of all other nodes. */
export interface GraphDifference {
  readonly base: string
  readonly nodes: Dict<DocumentNode>
  readonly children: Dict<readonly string[]>
  readonly arrows: Dict<Dict<readonly GraphTransition[]>>
  readonly shifts: readonly (readonly [number, number])[]
  readonly lines: Dict<readonly [number, number, number]>
}

/** One node with its descendants; `path` is the node path of events, `icon` the name of its icon. */
export interface GraphNode {
  readonly path: string
  readonly name: string
  readonly kind: string
  readonly icon: string
  readonly title: string
  readonly description: string
  readonly outcomes: readonly string[]
  readonly children: readonly GraphNode[]
  readonly transitions: readonly GraphTransition[]
  readonly initial: string | null
  readonly conditions: readonly string[]
  readonly disabled: boolean | string
}

/** A transition of a state machine; the outcome of a timeout is `after 30 s`, that of on_error is `error`. */
export interface GraphTransition {
  readonly source: string
  readonly outcome: string
  readonly target: string
}

/** The taught setting of a gripper: `held` a part `width_m` wide, or was open by that width. `force_n` is the grasp force, 0 when unknown. */
export interface GripperSetting {
  readonly width_m: number
  readonly held: boolean
  readonly force_n: number
}

/** Group siblings in a new container in their place; transitions that leave them become its outcomes. */
export interface GroupNodes {
  readonly edit: "group"
  readonly paths: readonly string[]
  readonly kind: "concurrency" | "machine" | "parallel" | "priority" | "selector" | "sequence"
  readonly name?: string | null
}

/** To the page: the arm whose handle it has (empty: none), and whether the handle is dragged. */
export interface HandleStatus {
  readonly k: "gripped"
  readonly arm: string
  readonly mode: "move" | "push"
  readonly pulled: boolean
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
  readonly preempt?: boolean
}

/** The result of a hot change, one line per difference. */
export interface HotChangeResultBody {
  readonly changes: readonly string[]
}

/** Keep-alive without data. */
export interface IdleFrame {
  readonly k: "ping"
}

/** What a set of runs has covered of all factors. */
export interface InputCoverage {
  readonly factors: readonly FactorCoverage[]
  readonly pairs: readonly PairCoverage[]
}

/** A run of the journal whose process died after event `last_seq`; it can be resumed. */
export interface InterruptedRun {
  readonly id: string
  readonly behavior: string
  readonly started_unix_s: number
  readonly last_seq: number
}

/** The rates, from 0 to 1 (of a difference from -1), that the runs do not exclude. */
export type Interval = readonly [number, number]

/** To the page: where its handle is dragged in the world; at the phase `end` the mouse is up. */
export interface ItemHandleMoved {
  readonly k: "placed"
  readonly phase: "end" | "start" | "update"
  readonly xyz: readonly [number, number, number]
  readonly xyzw: readonly [number, number, number, number]
}

/** What the arm that this page jogs stands before, and which directions lead out; no names for nothing. */
export interface JogBlockFrame {
  readonly k: "block"
  readonly robot: string
  readonly first: string
  readonly second: string
  readonly distance_m: number | null
  readonly directions_out: readonly JogDirection[]
}

/** A direction of a jog: along (0 to 2) or about (3 to 5) an axis of the tool's frame, or a joint by its number. */
export interface JogDirection {
  readonly axis: number
  readonly sign: number
}

/** Whether an arm can be jogged at once; not ready with a `reason` where its path cannot be checked. */
export interface JogReadiness {
  readonly k: "ready"
  readonly arm: string
  readonly ready: boolean
  readonly reason: string
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

/** A dynamic movement primitive in joint space (RCL table 6) for n joints and `N` kernels. `goal`, `y0` (rad) and `dy0` (rad/s) have n values; `c` and `sigma`, the centres and variances of the kernels over the phase, have `N`; `w` has one row of `N` weights for each joint, the table's w1 to wn. `tau` is the duration in seconds, `a_z` and `a_x` the dimensionless gains of transformation and phase. `tasktrans` is a linear map of the joints, n x n row by row, applied to the output of the primitive; empty for none. `id` is free for the user. */
export interface JointDmp {
  readonly N: number
  readonly a_z: number
  readonly a_x: number
  readonly tau: number
  readonly id: number
  readonly goal: readonly number[]
  readonly y0: readonly number[]
  readonly dy0: readonly number[]
  readonly c: readonly number[]
  readonly sigma: readonly number[]
  readonly w: readonly (readonly number[])[]
  readonly tasktrans: readonly number[]
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

/** What the runs of a sweep that are looked at say about one requirement. */
export interface JudgedRequirement {
  readonly text: string
  readonly number: string | null
  readonly runs: number
  readonly kept: number
  readonly missing: number
  readonly interval: Interval | null
  readonly verdict: "failed" | "passed" | "undecided"
}

/** One key with all its writers and readers, in document order. */
export interface KeyFlow {
  readonly key: string
  readonly writers: readonly KeyWriter[]
  readonly readers: readonly KeyReader[]
}

/** A node that reads a key. `by`: as an input of the same name, mapped through `in`, in an expression, or collected by a foreach. `sources` are the paths from which the value may come, `defined` whether there is one; `witness` is how it is reached without one. */
export interface KeyReader {
  readonly path: string
  readonly by: string
  readonly name: string
  readonly required: boolean
  readonly defined: "always" | "maybe" | "never" | "unreachable"
  readonly sources: readonly string[]
  readonly witness: string
}

/** A parameter or userdata key, with its JSON Schema and its default as plain data. */
export interface KeyView {
  readonly name: string
  readonly required: boolean
  readonly default: unknown
  readonly schema: Dict<unknown>
}

/** A node that writes a key, or a container that declares it; the path is empty for the document itself. `name` is the output key, or the field of the node that writes it. */
export interface KeyWriter {
  readonly path: string
  readonly origin: "collect" | "index" | "item" | "output" | "parameter" | "post" | "userdata"
  readonly name: string
}

/** A field in the form of a node; a switch is on where the document says nothing, a list may be written out. */
export interface KindField {
  readonly key: string
  readonly label: string
  readonly hint: string
  readonly control: "list" | "switch" | "text"
}

/** The lease of `resource`: its run, node and goal, which may be empty, and its duration. */
export interface LeaseMetrics {
  readonly resource: string
  readonly run: string
  readonly node: string
  readonly goal: string
  readonly held_s: number
}

/** The runs with one value of a factor, or with values of one range; the interval is of their success rate. */
export interface Level {
  readonly label: string
  readonly runs: number
  readonly interval: Interval
  readonly successes: number
}

/** The changes of the watched run since `after`, the changed runs and arms, and the current control of the run. `dropped` is the number of missing log lines. */
export interface LiveDelta {
  readonly k: "delta"
  readonly run: string
  readonly after: number
  readonly seq: number
  readonly now_s: number
  readonly ticking: boolean
  readonly runs: readonly RunView[]
  readonly nodes: Dict<NodeLive>
  readonly log: readonly LogLine[]
  readonly dropped: number
  readonly control: ControlView | null
  readonly lock_reasons: Dict<string>
  readonly robots: Dict<RobotLive>
}

/** The complete state of the watched run (empty if none), all runs, newest first, and all arms. `now_s` is the run's clock at sending; it advances with wall time while `ticking`, and stands while the run is paused. `control` is null unless the run is active; `lock_reasons` are the texts of the operator, by the path of the locked node. */
export interface LiveSnapshot {
  readonly k: "snapshot"
  readonly run: string
  readonly seq: number
  readonly now_s: number
  readonly ticking: boolean
  readonly runs: readonly RunView[]
  readonly nodes: Dict<NodeLive>
  readonly log: readonly LogLine[]
  readonly control: ControlView | null
  readonly lock_reasons: Dict<string>
  readonly robots: Dict<RobotLive>
  readonly stop: CellStop | null
}

/** Hold the outcome of a node; `reason` goes into the event log. */
export interface LockBody {
  readonly path: string
  readonly reason?: string
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
  readonly role?: "operator" | "viewer"
}

/** From the client: turn the camera of its 3D view to the first of these names that the cell has. A name is that of a part, a frame or an arm. */
export interface LookAt {
  readonly k: "look"
  readonly page: string
  readonly names: readonly string[]
}

/** A state blocked the event loop; all other states had to wait. */
export interface LoopBlocked {
  readonly event: "loop_blocked"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly blocked_s: number
  readonly where: string
}

/** A name of the cell that a behavior is written for, and what it becomes. Attributes: kind: As `NameUse.kind`. name: The name in the own cell. detail: In words what it is. target: The name in the other cell; empty if nothing is chosen, then it stays as it is. reason: In words why this target is proposed, or why none is; empty for a chosen one. candidates: What it may become, the best first. paths: The nodes that use it; empty for a declaration of the document. */
export interface MappedName {
  readonly kind: string
  readonly name: string
  readonly detail: string
  readonly target: string
  readonly reason: string
  readonly candidates: readonly NameCandidate[]
  readonly paths: readonly string[]
}

/** A body where it will be: `size_m` are edges x, y, z of a box, diameter and length of a cylinder, a diameter. `pose` is that of its centre in the world. With `warns` it is red. */
export interface MarkedBody {
  readonly shape: "box" | "cylinder" | "sphere"
  readonly size_m: readonly number[]
  readonly pose: readonly [readonly [number, number, number], readonly [number, number, number, number]]
  readonly warns?: boolean
}

/** The distribution of a measure over the runs that succeeded, and over those that did not. */
export interface MeasureSpread {
  readonly name: string
  readonly successes: Quantiles | null
  readonly failures: Quantiles | null
}

/** What was measured at a time of the run's clock, after event `seq`. `path` is the node whose goal was active at the device then, empty for none. `device` is its address: `left`, `left/gripper`. `value` and `limit`, what was asked for or is allowed, are in `unit`; None where there is none. */
export interface MeasuredMarker {
  readonly kind: "contact" | "force" | "grasp" | "limit"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly device: string
  readonly value: number | null
  readonly unit: string
  readonly limit: number | null
  readonly text: string
}

/** The measured markers of a run up to event `seq`, in order of time. `unread` says why the telemetry is not in them; it is empty where it is. `every` is n where only every n-th message of a topic was read, for there are too many; peaks between those are missing. `left_out` counts dropped markers. */
export interface MeasuredMarkers {
  readonly seq: number
  readonly marks: readonly MeasuredMarker[]
  readonly unread: string
  readonly every: number
  readonly left_out: number
}

/** A measured number of a failure, in `unit`, and what was expected: from `least` to `most`, null for no limit. */
export interface MeasuredValue {
  readonly quantity: string
  readonly measured: number
  readonly unit: string
  readonly least?: number | null
  readonly most?: number | null
}

/** A text to merge with the one on disk, and the side to take for conflicts, by `path field`. */
export interface MergeBody {
  readonly text: string
  readonly base_hash: string
  readonly sides?: Dict<"mine" | "theirs">
}

/** The latest message of the subscribed topic, truncated to a bounded size; at most five per second. `at_s` is the sampling time on the server's clock; `problem` tells why there is no message. */
export interface MessageFrame {
  readonly k: "message"
  readonly topic: string
  readonly at_s: number
  readonly value: unknown
  readonly problem: string
}

/** A log message of a state or the runner; `level` is debug, info, warning or error. */
export interface MessageLogged {
  readonly event: "log"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly level: string
  readonly message: string
}

/** A state published a message on a topic. */
export interface MessagePublished {
  readonly event: "published"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly topic: string
  readonly message: unknown
}

/** A state read a message of a topic. */
export interface MessageReceived {
  readonly event: "received"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly topic: string
  readonly message: unknown
}

/** The models that a cell document may name without a folder of its own. */
export interface ModelNames {
  readonly robots: readonly string[]
  readonly tools: readonly string[]
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
  readonly updated: readonly string[]
  readonly left: readonly string[]
}

/** A name of the other cell, and in words what it is. */
export interface NameCandidate {
  readonly name: string
  readonly detail: string
}

/** Something that has a name. `id` is that of a behavior, also for its node at `path`; the name of a state class; the name of an entry, of kind `path`; the id of a run; the address of an item of the cell, also for its topic `path`. `icon` is the name of the icon of a node, a state class or a behavior. */
export interface NameHit {
  readonly kind: "behavior" | "entry" | "item" | "node" | "run" | "state" | "topic"
  readonly id: string
  readonly title: string
  readonly detail: string
  readonly path: string
  readonly icon: string
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

/** A sweep document to be written to `id`, a path in the project; so are the paths in `document`. */
export interface NewSweepBody {
  readonly id: string
  readonly document: SweepDocument
}

/** A node did not stop in time and was abandoned; the run continues without it. */
export interface NodeAbandoned {
  readonly event: "abandoned"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly waited_s: number
}

/** A node that was added, removed, changed, or moved to another container or name, and possibly changed. The path `document` stands for the document itself. `before_path` is the previous path of a moved node. */
export interface NodeChange {
  readonly path: string
  readonly change: "added" | "changed" | "moved" | "removed"
  readonly before_path: string | null
  readonly fields: readonly FieldChange[]
}

/** The node that a command addresses. */
export interface NodeCommandBody {
  readonly path: string
}

/** A field that both sides changed differently. Attributes: path: The node, `document` for the document itself. field: The field, `with.speed`; empty for the node as a whole: one side removed or replaced it. base: What both started with; None where it did not exist, as for the two sides. mine: The value of who saves. theirs: The value in the file. side: Which of them is in the merged text. */
export interface NodeConflict {
  readonly path: string
  readonly field: string
  readonly base: unknown
  readonly mine: unknown
  readonly theirs: unknown
  readonly side: "mine" | "theirs"
}

/** How often a node was visited in each run, and how long all its visits together took. */
export interface NodeDifference {
  readonly path: string
  readonly visits_left: number
  readonly visits_right: number
  readonly duration_left_s: number
  readonly duration_right_s: number
}

/** A node was left for `target` without an outcome: by timeout, guard or on_error (`by`). */
export interface NodeDiverted {
  readonly event: "diverted"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly by: string
  readonly target: string
  readonly cause?: Cause | null
}

/** A node became active. */
export interface NodeEntered {
  readonly event: "entered"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly kind: string
  readonly inputs: Dict<unknown>
}

/** A node ended with an outcome, or was `preempted`. */
export interface NodeExited {
  readonly event: "exited"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly outcome: string
  readonly preempted?: boolean
  readonly cause?: Cause | null
}

/** One node: idle, active, done, failed, stopped or skipped. `visits` counts activations, so that a visit shorter than a frame is visible. Times are on the run's clock; `duration_s` is that of the last finished visit. `last_transition` is the last transition of a machine, as `source|outcome`. `taken` counts how often its machine has followed each outcome of this node, since the machine was entered; an undone node counts anew. `plan` is the last path that this visit planned. */
export interface NodeLive {
  readonly status: string
  readonly visits: number
  readonly outcome: string
  readonly entered_s: number
  readonly duration_s: number
  readonly cause: string
  readonly last_transition: string
  readonly taken: Dict<number>
  readonly plan: PlanLive | null
}

/** A text with the changes of both sides; `theirs_changed` are the nodes that the file changed. */
export interface NodeMerge {
  readonly text: string
  readonly conflicts: readonly NodeConflict[]
  readonly theirs_changed: readonly string[]
}

/** A node is run again after a failure; `attempt` counts from 2. */
export interface NodeRetried {
  readonly event: "retry"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly attempt: number
  readonly wait_s: number
  readonly cause: Cause | null
}

/** A disabled node was passed over with an outcome; it was not entered. In a tree its status is `skipped`. */
export interface NodeSkipped {
  readonly event: "skipped"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly outcome: string
}

/** The activations of a node that ended in a run, and the seconds that they took on its clock. */
export interface NodeTime {
  readonly visits: number
  readonly total_s: number
}

/** How long all visits of a node together took in a run. */
export interface NodeTrend {
  readonly count: number
  readonly median_s: number
  readonly lower_s: number
  readonly upper_s: number
  readonly least_s: number
  readonly most_s: number
  readonly last_s: number | null
  readonly path: string
}

/** A normal distribution. */
export interface Normal {
  readonly mean?: number
  readonly deviation: number
}

/** An open past run or recording, with the behavior as of the start of the run. It is shown as it stands: a run without an end is `interrupted`. */
export interface OpenRunBody {
  readonly run: PastRunBody
  readonly behavior: BehaviorView
}

/** From the client: operate this run (empty: none); a lost connection is a lost operator. */
export interface OperateRun {
  readonly k: "operate"
  readonly run?: string
}

/** The operator's status changed to `attached`, `detached` or `lost`. */
export interface OperatorChanged {
  readonly event: "operator"
  readonly seq: number
  readonly time_s: number
  readonly status: string
}

/** A command of the operator; `command` is a name of `engine.runtime.control.Control`. */
export interface OperatorCommanded {
  readonly event: "command"
  readonly seq: number
  readonly time_s: number
  readonly command: string
  readonly path: string
  readonly arguments: Dict<unknown>
}

/** The run's autonomy is below the level that `outcome` requires; the operator is asked once. */
export interface OutcomeRequested {
  readonly event: "outcome_requested"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly outcome: string
  readonly required: string
}

/** The runs that ended with one outcome, or status where they had none; the interval is of its share of all. */
export interface OutcomeShare {
  readonly label: string
  readonly runs: number
  readonly interval: Interval
  readonly success: boolean
}

/** The request of `OutcomeRequested` is withdrawn or has been answered. */
export interface OutcomeWithdrawn {
  readonly event: "outcome_withdrawn"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly outcome: string
}

/** The pairs of parts of two factors in which there is a run. */
export interface PairCoverage {
  readonly first: string
  readonly second: string
  readonly parts: number
  readonly covered: number
}

/** A parameter with its present value and the JSON Schema of its values. */
export interface ParameterInfo {
  readonly name: string
  readonly doc: string
  readonly value: unknown
  readonly schema: Dict<unknown>
}

/** One parameter for a form. */
export interface ParameterView {
  readonly name: string
  readonly schema: Dict<unknown>
  readonly required: boolean
}

/** A run in its journal; `status` is running, finished, stopped or errored. A run with status `running` has no end in the journal: it is active in another process, or its process died. `document` is the semantic hash of the behavior, `events` the number of events. */
export interface PastRun {
  readonly id: string
  readonly behavior: string
  readonly status: string
  readonly outcome: string | null
  readonly success: boolean
  readonly cause: string
  readonly started_at_s: number
  readonly duration_s: number
  readonly waits: string
  readonly ticking: boolean
  readonly document: string
  readonly events: number
}

/** One run of the journal. `running` means that it has no end: it is active, or its engine died. `recording` is the path of its recording, empty if there is none; `here` is true for a run of this server. */
export interface PastRunBody {
  readonly id: string
  readonly behavior: string
  readonly status: string
  readonly outcome: string | null
  readonly success: boolean
  readonly cause: string
  readonly started_at_s: number
  readonly duration_s: number
  readonly waits: string
  readonly ticking: boolean
  readonly document: string
  readonly events: number
  readonly failed: boolean
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

/** The scopes of a run after event `seq`, by container path, and the values of the watches, in their order. `problem` tells why there are none. */
export interface PastUserdata {
  readonly seq: number
  readonly scopes: Dict<ScopeView>
  readonly watches: readonly WatchValue[]
  readonly problem: string
}

/** From the page: show this run at this time of its clock, with the arms of another; null shows the live cell. */
export interface PastViewRequest {
  readonly run: string
  readonly time_s: number | null
  readonly ghost?: GhostRequest | null
}

/** What a page shows: a run at a time of its recording; or a `problem`, and the live cell. `ghost_problem` says why the arms of the other run are not shown. */
export interface PastViewState {
  readonly run: string
  readonly time_s: number
  readonly from_s: number
  readonly until_s: number
  readonly problem: string
  readonly ghost_problem: string
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

/** All held goals are at rest; `cannot` names the goals that cannot be held. */
export interface PauseConfirmed {
  readonly event: "pause_confirmed"
  readonly seq: number
  readonly time_s: number
  readonly cannot?: readonly string[]
}

/** The drawing of a behavior, as the page exports it. */
export interface PictureBody {
  readonly svg: string
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

/** Play back an entry or a capture with an arm; `speed` is a fraction of the taught speed. */
export interface PlayBody {
  readonly kind?: string
  readonly name?: string
  readonly capture?: number
  readonly revision?: number
  readonly arm: string
  readonly speed: number
}

/** The end of a playback: `succeeded`, `preempted`, `rejected` or `failed`, and the cause. */
export interface PlaybackResult {
  readonly status: string
  readonly cause: string
}

/** A design read from a file: the header row has addresses, whether they are `factors` or not; a row is a run. */
export interface PointsFile {
  readonly csv: string
}

/** From the client: answer to a ping. */
export interface Pong {
  readonly k: "pong"
}

/** A rigid transform: position in metres and unit quaternion x y z w, in `frame`. */
export interface Pose {
  readonly xyz: readonly [number, number, number]
  readonly xyzw: readonly [number, number, number, number]
  readonly frame: string
}

/** From the page: this arm is shown to be jogged; answered with its readiness, now and after every stop. Without a name no arm is shown any more. */
export interface PrepareJogging {
  readonly k: "prepare"
  readonly arm: string
}

/** One open page. Attributes: page: Its number since the server started. name: As the person calls themselves; the role and the number without. role: What the page may do. document: The behavior that it shows; empty for none. node: The node that is selected there; empty for none. edits: Whether it is the editor that shows it. operates: The run that it operates; empty for none. since_s: When it took control of that run, seconds since 1970. */
export interface Presence {
  readonly page: number
  readonly name: string
  readonly role: string
  readonly document: string
  readonly node: string
  readonly edits: boolean
  readonly operates: string
  readonly since_s: number | null
}

/** All open pages; `page` is the number of the one that this is sent to. */
export interface PresenceChanged {
  readonly k: "presence"
  readonly page: number
  readonly present: readonly Presence[]
}

/** A press has moved nothing: it was released, and the arm could not begin to move within `within_s` after that. */
export interface PressDropped {
  readonly k: "dropped"
  readonly arm: string
  readonly within_s: number
}

/** From the page: preview this arm along an entry or a capture; without an arm, clear the preview. `place` 0 replaces all previews; places 1 to 4 are shown side by side, each in its colour. `value` is shown in the place of an entry: the fields of one of this `kind`. */
export interface PreviewTaught {
  readonly k: "look"
  readonly kind?: string
  readonly name?: string
  readonly capture?: number
  readonly revision?: number
  readonly arm?: string
  readonly value?: Dict<unknown> | null
  readonly place?: number
}

/** A recording and the primitive learned from it, as the arm would execute them, and their fit errors. */
export interface PrimitiveComparison {
  readonly demonstration: Trace | null
  readonly primitive: Trace | null
  readonly joint_fit: JointFit | null
  readonly cart_fit: CartFit | null
}

/** A proposal with the findings of its behavior; `id` is the document it was written to, empty for none. */
export interface ProposalBody {
  readonly text: string
  readonly steps: readonly TaughtStep[]
  readonly words: readonly string[]
  readonly remarks: readonly string[]
  readonly arm: string
  readonly tool: string
  readonly arms: readonly string[]
  readonly parts: readonly string[]
  readonly findings: readonly FindingView[]
  readonly id: string
}

/** Options of the behavior; every number is the default of one of its parameters. `approach_m` is the length of the straight approach to a grasp without a taught approach; `width_m` the width of the grasped part, None when unknown: then any part between the fingers counts. `cell` is the path of the cell document to be written in the behavior, empty for none. */
export interface ProposalOptions {
  readonly name?: string
  readonly arm?: string
  readonly tool?: string | null
  readonly speed?: number
  readonly line_speed_m_s?: number
  readonly approach_m?: number
  readonly width_m?: number | null
  readonly cell?: string
}

/** Push the tool of a simulated arm, along the world axes. */
export interface PushToolBody {
  readonly arm: string
  readonly force_n: readonly [number, number, number]
  readonly duration_s: number
}

/** The distribution of a number over runs. */
export interface Quantiles {
  readonly name: string
  readonly runs: number
  readonly least: number
  readonly middle: number
  readonly p95: number
  readonly most: number
}

/** How two versions ended the same runs: numbers of runs by who succeeded. */
export interface RatePair {
  readonly both: number
  readonly only_first: number
  readonly only_second: number
  readonly neither: number
}

/** Values of fields at the same times, seconds of the run; null before the first message. The time range is divided into cells of two times each: their values are the least and the most in the cell, in the order in which they were. So no peak is lost, however long the range is. */
export interface RecordedCurves {
  readonly times_s: readonly number[]
  readonly fields: readonly string[]
  readonly columns: readonly (readonly (number | null)[])[]
}

/** The topics of a recording with their numeric fields, and the time that it covers on the clock of the run. */
export interface RecordedFields {
  readonly topics: readonly TopicFields[]
  readonly from_s: number
  readonly until_s: number
}

/** A run of a sweep that was executed again and recorded to `recording`, a path in the project. */
export interface RecordedTrial {
  readonly recording: string
  readonly same: boolean
  readonly result: TrialResult
  readonly saved: TrialResult
}

/** One recording of the project; `problem` says why it cannot be opened, else empty. */
export interface RecordingFile {
  readonly path: string
  readonly run: string
  readonly behavior: string
  readonly started_at_s: number
  readonly size_bytes: number
  readonly changed_at_s: number
  readonly problem: string
}

/** A step of the recovery; it has no settings. */
export interface RecoveryStepBody {
}

/** A behavior that references another one, or names an item of its cell: its id and name, and the nodes that do. */
export interface ReferringBehavior {
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

/** A request to release the stop of this number, null for the latest; refused if the cell was stopped again. */
export interface ReleaseStopBody {
  readonly stop?: number | null
}

/** Remove an item that nothing else in the document names. */
export interface RemoveCellItem {
  readonly edit: "remove_item"
  readonly section: "bonds" | "cameras" | "connectors" | "devices" | "equipment" | "fixtures" | "frames" | "modules" | "parts" | "robots"
  readonly name: string
}

/** Remove nodes, with the transitions and conditions that name them; other references become findings. */
export interface RemoveNodes {
  readonly edit: "remove_nodes"
  readonly paths: readonly string[]
}

/** Rename an axis, belt, sensor or position of a device, with all that names it in the document. */
export interface RenameCellField {
  readonly edit: "rename_field"
  readonly section: "bonds" | "cameras" | "connectors" | "devices" | "equipment" | "fixtures" | "frames" | "modules" | "parts" | "robots"
  readonly name: string
  readonly field: readonly [string, string]
  readonly new_name: string
}

/** Rename an item, with all that names it in the document. */
export interface RenameCellItem {
  readonly edit: "rename_item"
  readonly section: "bonds" | "cameras" | "connectors" | "devices" | "equipment" | "fixtures" | "frames" | "modules" | "parts" | "robots"
  readonly name: string
  readonly new_name: string
}

/** Rename a node; all references to it are updated. */
export interface RenameNode {
  readonly edit: "rename_node"
  readonly path: string
  readonly name: string
}

/** Give nodes another type in place; what fits is kept. `kind` is state, behavior, or that of a container or part of a tree; `runs` is what a state or behavior runs. What does not fit is removed, but only if it is in `accepted`; otherwise the edit is refused with all `losses`. */
export interface ReplaceType {
  readonly edit: "replace_type"
  readonly paths: readonly string[]
  readonly kind: string
  readonly runs?: string
  readonly accepted?: readonly TypeLoss[]
}

/** A request to resume an interrupted run: `answers` by path are `rerun` or an outcome. */
export interface ResumeBody {
  readonly answers?: Dict<string>
  readonly changed?: boolean
}

/** An interrupted state that needs a decision. */
export interface ResumeQuestion {
  readonly path: string
  readonly outcomes: readonly string[]
}

/** An interrupted run resumes only after these questions are answered. */
export interface ResumeQuestionsBody {
  readonly message: string
  readonly where: string
  readonly hint: string
  readonly questions: readonly ResumeQuestion[]
}

/** One arm: its mode, its activity in words, the error of a reflex stop, and its speed override. `path` is its planned path, which the 3D view shows. `separation` says how separation monitoring slows it down, empty if it does not. */
export interface RobotLive {
  readonly name: string
  readonly mode: string
  readonly activity: string
  readonly error: string
  readonly speed_override: number
  readonly controller: string
  readonly path: PathLive | null
  readonly separation: string
}

/** Two runs beside one another. `visits` are aligned, each container before what is inside; `divergence` is where the runs first differ, null where they do not. `settings` are parameters, inputs, seed and clock that differ. `left_out` and `data_left_out` count what is not listed. `icons` has the name of the icon of each visited node, as far as its graph is known. */
export interface RunComparison {
  readonly left: PastRun
  readonly right: PastRun
  readonly divergence: Divergence | null
  readonly visits: readonly AlignedVisit[]
  readonly left_out: number
  readonly nodes: readonly NodeDifference[]
  readonly settings: readonly ValueChange[]
  readonly documents: readonly DocumentDifference[]
  readonly data: readonly DataDifference[]
  readonly data_left_out: number
  readonly icons: Dict<string>
}

/** The run ended; `status` is finished, stopped or errored. */
export interface RunEnded {
  readonly event: "run_ended"
  readonly seq: number
  readonly time_s: number
  readonly status: string
  readonly outcome?: string | null
  readonly cause?: Cause | null
}

/** A failed run: the failure originated at event `seq`, at node `path` (empty if in no node). `entered_seq` is the entry into that node, from where the run can be tried again; 0 if it is in no node. `hint` says what to do, `links` are the causes without it. `steps` say how the nodes from the root to the origin ended, `around` are the requests, answers and writes of the origin. */
export interface RunFailure {
  readonly seq: number
  readonly entered_seq: number
  readonly time_s: number
  readonly path: string
  readonly text: string
  readonly hint: string
  readonly links: readonly CauseLine[]
  readonly steps: readonly LogLine[]
  readonly around: readonly LogLine[]
}

/** Where a run starts: at the node `path`, with the data of event `seq` of a run in the journal. Without `run`, it starts with the initial userdata. Without `path`, at the state entered last. */
export interface RunPosition {
  readonly run?: string
  readonly seq?: number | null
  readonly path?: string | null
}

/** The run was resumed after its engine died; nodes in `rerun` are entered again, others got an outcome. */
export interface RunResumed {
  readonly event: "resumed"
  readonly seq: number
  readonly time_s: number
  readonly after_seq: number
  readonly epoch: number
  readonly rerun: readonly string[]
}

/** The run started; `document` is the semantic hash of the behavior. */
export interface RunStarted {
  readonly event: "run_started"
  readonly seq: number
  readonly time_s: number
  readonly behavior: string
  readonly document: string
  readonly parameters: Dict<unknown>
  readonly seed: number
  readonly clock: string
  readonly inputs: Dict<unknown>
}

/** The run stepped back to before the entry of `path` and abandoned `source`. `values` are restored in userdata. `went_wrong` and `reason` are the causes that the container had recorded of its children at that time. With `cause` the step back failed: some states may have been undone, and the run stays where it was. */
export interface RunSteppedBack {
  readonly event: "stepped_back"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly source: string
  readonly values?: readonly FormerValue[]
  readonly went_wrong?: Cause | null
  readonly reason?: Cause | null
  readonly cause?: Cause | null
}

/** The last runs of a behavior, newest first, of `known` in the journal. Each is counted once: it `succeeded`, `failed`, was `stopped`, or has `not_ended`. Durations are those of runs that succeeded, `duration` is null and `nodes` empty where there is none. */
export interface RunTrend {
  readonly behavior: string
  readonly runs: readonly PastRun[]
  readonly known: number
  readonly succeeded: number
  readonly failed: number
  readonly stopped: number
  readonly not_ended: number
  readonly duration: DurationSpread | null
  readonly nodes: readonly NodeTrend[]
}

/** One run, active or ended; `status` is running, stopping, finished, stopped, errored or interrupted. `behavior` is the id of its document, of a past run the name of the behavior. `duration_s` is on the clock of the run, see `run_duration_s`; of an active run it is the time so far, which advances with wall time while `ticking`. `waits` is asks, paused or locked while it waits for a person. */
export interface RunView {
  readonly id: string
  readonly behavior: string
  readonly status: string
  readonly outcome: string | null
  readonly success: boolean
  readonly cause: string
  readonly started_at_s: number
  readonly duration_s: number
  readonly waits: string
  readonly ticking: boolean
}

/** Rows of the chosen fields, in their order: time on the server's clock, and a value each (null where none). `dropped` is the number of earlier rows that were dropped because the page was too slow. */
export interface SamplesFrame {
  readonly k: "samples"
  readonly number: number
  readonly times_s: readonly number[]
  readonly rows: readonly (readonly (number | null)[])[]
  readonly dropped: number
}

/** A text to write, and the hash of the version it is based on. */
export interface SaveBody {
  readonly text: string
  readonly base_hash: string
}

/** Write a capture to the store as a named entry; it stays in the buffer. `form` selects another kind than the default: every recording can be saved as `trajectory`, `dmp` or `cart_dmp`, and its last configuration as `joints` or `pose`. Fails when the entry exists, unless `replace`. */
export interface SaveCapture {
  readonly id: number
  readonly name: string
  readonly form?: "cart_dmp" | "dmp" | "gripper" | "joints" | "pose" | "trajectory" | null
  readonly tags?: readonly string[]
  readonly replace?: boolean
  readonly by?: string
  readonly reason?: string
}

/** A request to save what a run was shrunk to as a test case: a sweep document at `id`, a path in the project. */
export interface SaveCaseBody {
  readonly id: string
}

/** The version that is on disk now. */
export interface SaveResultBody {
  readonly hash: string
  readonly saved_at: number
}

/** The values of one container, kept after its exit; `is_open` is False then. */
export interface ScopeView {
  readonly is_open: boolean
  readonly since_s: number
  readonly values: Dict<UserdataRecord>
}

/** From the client: show on its page alone where an arm is at a share, 0 to 1, of its proposed path; null: none. */
export interface ScrubPath {
  readonly k: "scrub"
  readonly page: string
  readonly robot: string
  readonly share: number | null
}

/** How far a search for failures is. */
export interface SearchLive {
  readonly failures: number
  readonly nearest: number | null
  readonly is_satisfied: boolean
}

/** A search for failures instead of a design: what has ended decides which configurations are executed next. The first `batch` configurations are those of a random design; each later batch is drawn nearer to the runs that failed, or came nearest to it. `towards` names the number that tells how near a run that succeeded is; with `failure` none does. A run that fails is always nearer. The same seed finds the same configurations, with any number of workers. Of the method `cross_entropy`, `elite` is the share of a batch that the next one is drawn around, and `random_share` the share of each batch that is drawn at random all the same: it finds what the number does not point at, and bounds the weight of a run in the estimate of the failure probability. */
export interface SearchSpec {
  readonly towards?: string
  readonly method?: "cross_entropy" | "optuna"
  readonly runs?: number
  readonly batch?: number
  readonly stop_after?: number | null
  readonly elite?: number
  readonly random_share?: number
}

/** The number of a run whose least or largest value is searched for; a run that fails is beyond all of them. */
export interface SearchTarget {
  readonly name: string
  readonly sign: number
  readonly guides: boolean
}

export interface SearchView {
  readonly line: SweepLine
  readonly document: SweepDocument
  readonly done: number
  readonly failures: number
  readonly towards: string
  readonly found: string
  readonly method: string
  readonly likelihood: string
  readonly figure: string
  readonly subject: string
  readonly versions: Dict<string>
  readonly spec: SearchSpec
  readonly target: SearchTarget
  readonly ended_by: "failures" | "interrupted" | "runs" | "time"
  readonly refused: number
  readonly clusters: readonly FailureCluster[]
  readonly nearest: readonly TrialResult[]
  readonly batches: readonly BatchTrace[]
  readonly probability: FailureProbability | null
  readonly cpu_s: number
}

/** The service responded, or failed with `cause`. */
export interface ServiceAnswered {
  readonly event: "answer"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly call: string
  readonly result?: unknown
  readonly cause?: Cause | null
}

/** A state called a service; `call` numbers the calls of one activation from 1. */
export interface ServiceCalled {
  readonly event: "call"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly call: string
  readonly address: string
  readonly request: Dict<unknown>
}

/** The role of the session and the features of this server; `stop` is for operators. The 3D view is at `http://<host>:<cell_view_port>/cell/<page>/`, a separate origin; null without a 3D view. */
export interface SessionBody {
  readonly role: string
  readonly cell_name: string
  readonly cell_view_port: number | null
  readonly epoch: string
  readonly cell: CellConnection
  readonly devices: readonly DrivenDeviceChoice[]
  readonly opening_problem: string
  readonly stop: StopEndpoint | null
}

/** Add a free note to the canvas of a container, change it, move it, resize it; null removes it. */
export interface SetCanvasNote {
  readonly edit: "set_canvas_note"
  readonly path: string
  readonly name: string
  readonly note: CanvasNote | null
}

/** Set a field of an item; null removes it, so that its default applies. Of a list and of a mapping only what differs is written: the other values keep their spelling. */
export interface SetCellField {
  readonly edit: "set_field"
  readonly section: "bonds" | "cameras" | "connectors" | "devices" | "equipment" | "fixtures" | "frames" | "modules" | "parts" | "robots"
  readonly name: string
  readonly field: readonly string[]
  readonly value: unknown
}

/** Change declarations of the document; null removes a key. Other keys are unchanged. Keys: name, description, cell, parameters, userdata, outcomes, success. */
export interface SetDocument {
  readonly edit: "set_document"
  readonly changes: Dict<unknown>
}

/** Set one field of a node; null removes it. For every node: description, timeout, retry, guard, on_error, autonomy, resume, in, out, success, every, post, disabled, notes, and what it runs (state, behavior, behaviour). For containers the keys of their kind: initial, conditions, otherwise, userdata, shared, items, times, as, index, next, collect, memory, policy, synchronise, success_count, failure_count, after, status, running, failure; and `order`, the names of all children in their new order. */
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

/** From the page: show the handle of this arm (empty: none); it moves the tool, or pushes an arm in hand guiding. */
export interface ShowHandle {
  readonly k: "take"
  readonly arm?: string
  readonly mode?: "move" | "push"
}

/** From the page: show a handle at a pose in the world, or none; it moves nothing, the page is told where it is. */
export interface ShowItemHandle {
  readonly k: "place"
  readonly at?: readonly [readonly [number, number, number], readonly [number, number, number, number]] | null
  readonly turns?: boolean
}

/** From the client: the 3D view under `/cell/<page>/` shows exactly these groups. */
export interface ShowLayers {
  readonly k: "show"
  readonly page: string
  readonly groups: readonly ("cameras" | "commanded" | "detections" | "frames" | "obstacles" | "paths" | "people" | "voxels")[]
}

/** From the page: what is marked in its 3D view, in the place of what was before. */
export interface ShowMarks {
  readonly k: "mark"
  readonly points?: readonly (readonly [number, number, number])[]
  readonly box?: readonly [readonly [number, number, number], readonly [number, number, number]] | null
  readonly axes?: readonly [readonly [number, number, number], readonly [number, number, number, number]] | null
  readonly body?: MarkedBody | null
}

/** From the client: what this page shows; the last one counts, and goes with the connection. */
export interface ShowPresence {
  readonly k: "present"
  readonly name?: string
  readonly document?: string
  readonly node?: string
  readonly edits?: boolean
}

/** A request to shrink a failing run; `same` is what must stay the same: how it ends, or its root cause too. */
export interface ShrinkBody {
  readonly same?: "cause" | "outcome"
}

/** How far a failing run is shrunk. */
export interface ShrinkProgress {
  readonly runs: number
  readonly most_runs: number
  readonly step: string
  readonly changed: readonly string[]
}

/** How far a failing run is shrunk, and what came of it; kept as long as the server runs. */
export interface Shrinking {
  readonly status: "idle" | "running" | "stopping"
  readonly progress: ShrinkProgress | null
  readonly found: ShrunkTrial | null
  readonly saved_as: string
  readonly problem: string
}

/** A failing configuration with as few and as small changes from nominal as were found. */
export interface Shrunk {
  readonly result: TrialResult
  readonly changed: Dict<readonly [unknown, unknown]>
  readonly runs: number
  readonly passes: Dict<unknown>
  readonly seed_matters: boolean
  readonly placement_noise: boolean
  readonly interrupted: boolean
}

/** The smallest change from nominal with which a run still fails. */
export interface ShrunkTrial {
  readonly subject: string
  readonly failing: Configuration
  readonly shrunk: Shrunk
}

/** One numeric field of a topic: its path `position_rad.0`, its label `position_rad joint1`, its unit. */
export interface SignalField {
  readonly path: string
  readonly label: string
  readonly unit: string
}

/** A request to open the cell anew: `simulated` are the devices that its world simulates instead of their drivers. All others with a driver are real. */
export interface SimulationBody {
  readonly simulated: readonly string[]
}

/** A service or action: its address, request type, documentation and response type. */
export interface SkillInfo {
  readonly kind: string
  readonly name: string
  readonly type: string
  readonly doc: string
  readonly answer: string
}

/** A request to start a run; without a seed the server chooses one. With `breakpoints`, those in the file of the behavior hold. The run pauses once before the node `until`. */
export interface StartBody {
  readonly behavior: string
  readonly parameters?: Dict<unknown>
  readonly inputs?: Dict<unknown>
  readonly seed?: number | null
  readonly supervision?: Supervision
  readonly breakpoints?: boolean
  readonly begin?: RunPosition | null
  readonly until?: string | null
}

/** The data with which a run can start at a node: of the last run that entered it, else the initial values. `run` is empty where no run has; `seq` is the event before its entry. `obstacle` tells why a run cannot start there. */
export interface StartData {
  readonly run: string
  readonly seq: number | null
  readonly started_unix_s: number
  readonly parameters: Dict<unknown>
  readonly userdata: Dict<unknown>
  readonly obstacle: string
}

/** From the page: a key goes down that jogs this arm, until `rest`. */
export interface StartJog {
  readonly k: "jog"
  readonly arm: string
  readonly space: "joints" | "tool"
  readonly frame?: "base" | "tool" | "world"
}

/** The run that was started. */
export interface StartResultBody {
  readonly run: string
}

/** The file of a state class; its class statement is from `line` to `end_line`, which count from 1. `file` is relative to the project for a module of the project, absolute for one of an installed package. */
export interface StateSource {
  readonly state: string
  readonly module: string
  readonly file: string
  readonly in_project: boolean
  readonly line: number
  readonly end_line: number
  readonly text: string
}

/** A state; `group` is the part of its name before the last dot, `icon` the name of its icon. */
export interface StateView {
  readonly name: string
  readonly group: string
  readonly icon: string
  readonly summary: string
  readonly doc: string
  readonly outcomes: readonly string[]
  readonly success: readonly string[]
  readonly parameters: readonly KeyView[]
  readonly inputs: readonly KeyView[]
  readonly outputs: readonly KeyView[]
}

/** Modules of the project's own states were loaded anew, or could not be; how often since the server has started. */
export interface StatesChanged {
  readonly k: "states"
  readonly revision: number
}

/** The status of a behavior tree node changed: success, failure, running, skipped or invalid. A leaf is invalid when it is halted or its result is discarded. It is running when it has ended but is not ticked because the condition of an enclosing `while_do_else` is running; its status is reported at its next tick. */
export interface StatusChanged {
  readonly event: "status"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly status: string
}

/** One step back of a paused run, in the branch of `path` if given. */
export interface StepBackBody {
  readonly path?: string
}

/** One step of a paused run, in the branch of `path` if given. */
export interface StepBody {
  readonly mode?: "into" | "out" | "over"
  readonly path?: string
}

/** A request to stop a run; `reason` goes into its event log. */
export interface StopBody {
  readonly reason?: string
}

/** The address of STOP, independent of the engine: POST `{"token": …, "reason": …}` to `url`. */
export interface StopEndpoint {
  readonly url: string
  readonly token: string
}

/** From the page: the key is up; a press during which the arm has not moved is executed for a moment. */
export interface StopJog {
  readonly k: "rest"
}

/** A stop of the run was requested. */
export interface StopRequested {
  readonly event: "stop"
  readonly seq: number
  readonly time_s: number
  readonly reason: string
}

/** The response to STOP: `acknowledged` once every connected device has it; `stop` is 0 before the first. `engine` is `informed` when its event loop has received the stop, `silent` while it is blocked or frozen, `ended` when its process has ended. `after_s` is the time from STOP to this response. */
export interface StopStatus {
  readonly stop: number
  readonly reason: string
  readonly acknowledged: boolean
  readonly at_rest: boolean
  readonly engine: "ended" | "informed" | "silent"
  readonly after_s: number
  readonly devices: readonly DeviceStop[]
}

/** What a stop did at one device: at rest `after_s` seconds after the stop, or `failed` with the reason. */
export interface StoppedDevice {
  readonly name: string
  readonly status: "at_rest" | "failed" | "stopping"
  readonly after_s: number
  readonly reason: string
}

/** A run that the stop has ended; a new run can start from its event `seq`, at the node `path`. `path` is the state that it had entered last, empty if it had entered none. */
export interface StoppedRun {
  readonly id: string
  readonly behavior: string
  readonly seq: number
  readonly path: string
}

/** How operators watch over a run; `flexcell run --help` explains the same options. `autonomy` applies while an operator is attached or demanded: outcomes that require less pass without confirmation. With `demand_operator` it applies although no operator is attached. `loss_policy` applies when the last operator has been lost for `loss_timeout_s`. */
export interface Supervision {
  readonly autonomy?: "full" | "high" | "low" | "off"
  readonly demand_operator?: boolean
  readonly start_paused?: boolean
  readonly loss_policy?: "continue" | "hold" | "stop"
  readonly loss_timeout_s?: number
}

/** A sweep compared with a baseline. */
export interface SweepComparison {
  readonly comparison: Comparison
  readonly verdict: "failed" | "passed" | "undecided" | null
  readonly words: string
}

/** A sweep as written. `interval` of the success rate: `anytime` may be looked at after every run, and a sweep ends as soon as it decides what is required; `exact` is narrower, for the number of `runs` that is fixed before. Both are for runs that are drawn at random. In another design what is required is compared with the share of its runs. `require` is a success rate, `success >= 0.98`, the share of runs in which a number keeps a limit, `share(cell.contact_force_max_n <= 30) >= 0.95`, or a list of these. A number is a measure, userdata at the end, or `duration_s`; a run without it does not keep the limit. Each run has a seed of its own, derived from `seed` and its number; with `placement_noise` it also places the parts that have `jitter` in the cell. The budget is the number of `runs`, the wall `time` of the sweep, or the `width` of the interval of the success rate; whatever comes first ends it. `timeout` is the wall time of one run, `limit` its time on the clock of the run. With `search` the configurations are searched for, `search.runs` of them; what is required is then not decided. */
export interface SweepDocument {
  readonly flexcell: 1
  readonly description?: string
  readonly behavior: string
  readonly cell?: string | null
  readonly simulate?: readonly string[]
  readonly store?: string | null
  readonly parameters?: Dict<unknown>
  readonly inputs?: Dict<unknown>
  readonly faults?: string | null
  readonly substitutes?: string | null
  readonly factors?: Dict<Factor>
  readonly design?: "grid" | "latin_hypercube" | "random" | "sobol" | PointsFile
  readonly search?: SearchSpec | null
  readonly seed?: number
  readonly placement_noise?: boolean
  readonly runs?: number
  readonly time?: number | string | null
  readonly width?: number | null
  readonly interval?: "anytime" | "exact"
  readonly confidence?: number
  readonly require?: string | readonly string[] | null
  readonly timeout?: number | string
  readonly limit?: number | string
}

/** The sweep that was made. */
export interface SweepIdBody {
  readonly id: string
}

/** One line of the list of sweeps; `id` is the path of the document in the project. */
export interface SweepLine {
  readonly id: string
  readonly description: string
  readonly behavior: string
  readonly design: string
  readonly require: string
  readonly towards: string
  readonly factors: readonly string[]
  readonly live: SweepLive
  readonly problem: string
}

/** The sweeps of a project, and the results that belong to none of them. */
export interface SweepList {
  readonly sweeps: readonly SweepLine[]
  readonly others: readonly UndescribedResults[]
}

/** How far a sweep is. `looked_at` counts the runs without a gap before them: rate and interval are of those. */
export interface SweepLive {
  readonly status: "idle" | "running" | "stopping"
  readonly planned: number
  readonly done: number
  readonly looked_at: number
  readonly successes: number
  readonly interval: Interval | null
  readonly verdict: "failed" | "passed" | "undecided" | null
  readonly rate_hz: number
  readonly remaining_s: number | null
  readonly search: SearchLive | null
  readonly problem: string
}

/** Runs of a sweep without their times in nodes, failing ones first, each in the order of configurations. `alike` has the numbers of all failing runs with the same cause, the most frequent cause first. */
export interface SweepRuns {
  readonly runs: readonly TrialResult[]
  readonly total: number
  readonly alike: readonly (readonly number[])[]
}

/** A request to execute what is left of a sweep; `again` also what crashed or hung before. */
export interface SweepStartBody {
  readonly again?: boolean
}

export interface SweepView {
  readonly line: SweepLine
  readonly document: SweepDocument
  readonly curve: readonly CurvePoint[]
  readonly subject: string
  readonly versions: Dict<string>
  readonly planned: number
  readonly done: number
  readonly looked_at: number
  readonly successes: number
  readonly interval: Interval | null
  readonly requirements: readonly JudgedRequirement[]
  readonly verdict: "failed" | "passed" | "undecided" | null
  readonly ended_by: "decided" | "interrupted" | "runs" | "time"
  readonly outcomes: readonly OutcomeShare[]
  readonly causes: readonly CauseGroup[]
  readonly duration_s: Quantiles | null
  readonly nodes: readonly Quantiles[]
  readonly outputs: readonly Quantiles[]
  readonly measures: readonly MeasureSpread[]
  readonly effects: readonly FactorEffect[]
  readonly inputs: InputCoverage
  readonly items: number
  readonly missing: readonly CoverageItem[]
  readonly cpu_s: number
}

/** How far sweeps are that are being executed, or have just ended, by id. */
export interface SweepsChanged {
  readonly k: "sweeps"
  readonly changed: Dict<SweepLive>
}

/** New tags of an entry; `revision` is the revision that they are based on. */
export interface TagsBody {
  readonly kind: string
  readonly name: string
  readonly tags: readonly string[]
  readonly revision: number
}

/** The targets that an arm of the document's cell cannot reach; `dropped` if the page has sent a newer text. */
export interface TargetFindingsBody {
  readonly findings: readonly FindingView[]
  readonly problem: string
  readonly dropped: boolean
}

/** A text whose targets are checked; a newer request of the same page replaces the pending one. */
export interface TargetsBody {
  readonly text: string
  readonly page: string
}

/** An entry or an action of the tool; an omitted `role` is inferred. `part` is the part of a grasp. */
export interface TaughtStep {
  readonly kind: "action" | "cart_dmp" | "dmp" | "gripper" | "joints" | "pose" | "trajectory"
  readonly name: string
  readonly role?: "approach" | "close" | "depart" | "follow" | "grasp" | "open" | "release" | "via" | null
  readonly part?: string | null
}

/** The status of the Helping Hand, also the latest value of `teach/status`. `recording` and `guided` are names of robots; `message`, in JSON `said`, is the last thing that it reported, such as why a capture was refused. */
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

/** Whether a tool holds something, and the name of the part: `?` when unknown, empty for none. */
export interface ToolHolds {
  readonly held: boolean
  readonly part: string
}

/** Measured tool state: opening of a gripper (m) or closing of a hand (0 to 100), and whether it holds a part. */
export interface ToolLive {
  readonly width_m: number | null
  readonly closed_percent: number | null
  readonly held: boolean
}

/** The numeric fields of one topic. */
export interface TopicFields {
  readonly topic: string
  readonly type: string
  readonly fields: readonly SignalField[]
}

/** A topic: its message type with its documentation, and whether users may publish on it. */
export interface TopicInfo {
  readonly name: string
  readonly type: string
  readonly doc: string
  readonly takes_commands: boolean
}

/** Traffic of one topic: rate over the last seconds, age of the latest message (null before the first). */
export interface TopicMetrics {
  readonly rate_hz: number
  readonly age_s: number | null
  readonly on_demand: boolean
  readonly subscribers: number
}

/** The motion of an arm along an entry, one row per time. `joints` are radians in the order of `joint_names`, empty when the arm cannot follow; `poses` are x y z (m) and a unit quaternion x y z w of the tool centre point in the world. `times_s` is 0 for a single configuration. `remark` is the reason for missing joints. */
export interface Trace {
  readonly times_s: readonly number[]
  readonly joint_names: readonly string[]
  readonly joints: readonly (readonly number[])[]
  readonly poses: readonly (readonly number[])[]
  readonly remark: string
}

/** A motion recorded at strictly increasing `times_s`; each other list has one row per time, or is empty. `joints` are radians in the order of `names` or of the robot; `poses` are x y z (m) and a unit quaternion x y z w of the tool centre point in `frame`; `wrenches` are force (N) and torque (Nm) of the environment on the tool along the axes of `wrench_frame`. */
export interface Trajectory {
  readonly times_s: readonly number[]
  readonly joints: readonly (readonly number[])[]
  readonly names: readonly string[]
  readonly poses: readonly (readonly number[])[]
  readonly frame: string
  readonly wrenches: readonly (readonly number[])[]
  readonly wrench_frame: string
}

/** A transition of a machine: a child (its path), and one of its outcomes. */
export interface TransitionRef {
  readonly from: string
  readonly outcome: string
}

/** State machine `path` takes the transition of `source` to `target`, a child or an outcome of its own. */
export interface TransitionTaken {
  readonly event: "transition"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly source: string
  readonly outcome: string
  readonly target: string
}

/** How one configuration ended; everything but the costs is the same wherever it is executed. */
export interface TrialResult {
  readonly configuration: Configuration
  readonly status: "crashed" | "errored" | "finished" | "hung" | "refused" | "stopped"
  readonly outcome: string | null
  readonly success: boolean
  readonly cause: string
  readonly reason: string
  readonly reason_at: string
  readonly duration_s: number
  readonly events: number
  readonly events_sha256: string
  readonly nodes: Dict<NodeTime>
  readonly outputs: Dict<number>
  readonly measures: Dict<number>
  readonly covered: string
  readonly wall_s: number
  readonly cpu_s: number
  readonly memory_bytes: number
}

/** A trigger with its callback and robot; the fields of RCY figure 12. The topic's field `field` (when empty, the only boolean one, or `value` or `data`) is compared with `trig_value`: `rising_edge` fires when they become equal, `falling_edge` when they become unequal, `hold` is active while they are equal. `joint_dmp_N` is the number of kernels of the primitive, 0 selects it by the fit. `tf_save` captures the pose of `source_frame` in `target_frame`, `gripper_save` the opening of the gripper and whether it holds a part. */
export interface Trigger {
  readonly trig_name: string
  readonly robot_ns: string
  readonly trig_topic: string
  readonly trig_type: "falling_edge" | "hold" | "rising_edge"
  readonly trig_callback: "cart_dmp_save" | "grav_comp" | "gripper_save" | "joint_dmp_save" | "joint_save" | "pose_save" | "tf_save"
  readonly trig_value: boolean | number | string
  readonly field: string
  readonly joint_dmp_N: number
  readonly source_frame: string
  readonly target_frame: string
}

/** The YAML text of the triggers and its file, empty when they are kept only while the server runs. */
export interface TriggerDocument {
  readonly file: string
  readonly text: string
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

/** What another type of a node cannot keep: where it is, what it is, its value as JSON, and why it does not fit. */
export interface TypeLoss {
  readonly path: string
  readonly item: string
  readonly value: string
  readonly reason: string
}

/** An expression that makes a name of the cell in a run. */
export interface UndecidedName {
  readonly path: string
  readonly expression: string
}

/** Saved results that no sweep document of the project asks for: of the command line, or of an earlier version. */
export interface UndescribedResults {
  readonly subject: string
  readonly behavior: string
  readonly runs: number
  readonly successes: number
}

/** The undo ended: done, failed with `cause`, or `preempted`. */
export interface UndoEnded {
  readonly event: "undo_ended"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly undoes: number
  readonly preempted?: boolean
  readonly cause?: Cause | null
}

/** A step back started to undo activation `undoes` of a state; `visit` numbers the undo. */
export interface UndoStarted {
  readonly event: "undo_began"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly visit: number
  readonly undoes: number
}

/** Replace a container with its children. */
export interface UngroupNode {
  readonly edit: "ungroup"
  readonly path: string
}

/** One place that uses it. `path` is the node in this document; empty for the document itself. `how` says in what way: `runs`, `reads pose`, `writes`. `line` and `column` count from 1. */
export interface Usage {
  readonly document: string
  readonly behavior: string
  readonly path: string
  readonly how: string
  readonly line: number
  readonly column: number
}

/** All usages, by document and line; `unread` are the documents that cannot be read, and may have more. */
export interface Usages {
  readonly found: readonly Usage[]
  readonly unread: readonly string[]
}

/** A node appended `value` to the list at `key` in the scope of the container `scope`. */
export interface UserdataAppended {
  readonly event: "userdata_appended"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly scope: string
  readonly key: string
  readonly value: unknown
}

/** A value of the userdata of a run, whole; the empty scope is that of the behavior. */
export interface UserdataBody {
  readonly scope?: string
  readonly key: string
  readonly value: unknown
}

/** The changed scopes, by the path of their container; null for a removed one. `first` means that the frame contains all scopes. `watches` are the values of all watches, in their order. */
export interface UserdataFrame {
  readonly k: "userdata"
  readonly run: string
  readonly first: boolean
  readonly scopes: Dict<ScopeView | null>
  readonly watches: readonly WatchValue[]
  readonly problem: string
}

/** One value: its last writer (a node path), the time on the clock of the run, and the number of writes. `by` is empty for an initial value of the scope. */
export interface UserdataRecord {
  readonly value: unknown
  readonly by: string
  readonly at_s: number
  readonly writes: number
}

/** A node, or its post-condition named by `post`, wrote `key` into the scope of the container `scope`. */
export interface UserdataWritten {
  readonly event: "userdata"
  readonly seq: number
  readonly time_s: number
  readonly path: string
  readonly scope: string
  readonly key: string
  readonly value: unknown
  readonly post?: string
}

/** One field that differs: its path `pose.xyz_m[0]`, and both values as short JSON, null where it is missing. */
export interface ValueChange {
  readonly at: string
  readonly left: string | null
  readonly right: string | null
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

/** One activation of a node, with the causes of its failure, from the outermost. */
export interface Visit {
  readonly start_s: number
  readonly end_s: number | null
  readonly status: string
  readonly outcome: string
  readonly visit: number
  readonly seq: number
  readonly end_seq: number
  readonly count: number
  readonly path: string
  readonly cause: string
}

/** An expression, with or without `${…}`, as the node at `path` would read it. Without a path the innermost active container that has a name counts. */
export interface Watch {
  readonly expression: string
  readonly path?: string
}

/** From the client: watch this run (empty: the list of runs only); the response is a snapshot. */
export interface WatchRun {
  readonly k: "watch"
  readonly run?: string
}

/** Its value; `problem` says why there is none. */
export interface WatchValue {
  readonly value: unknown
  readonly problem: string
}

export type DataFrame = BusMetricsFrame | MessageFrame | SamplesFrame | UserdataFrame | GoalsFrame | CellStateFrame | IdleFrame

export type Edit = AddNode | RemoveNodes | RenameNode | MoveNodes | SetTransition | ClearTransition | SetInitial | SetParameter | ClearParameter | SetField | SetPositions | SetCanvasNote | GroupNodes | UngroupNode | ReplaceType | DuplicateNodes | PasteNodes | SetDocument | AutoConnect

export type Frame = Hello | LiveSnapshot | LiveDelta | DocumentsChanged | StatesChanged | SweepsChanged | CellStopChanged | PresenceChanged | Ping

export type GoalStreamLine = GoalSentLine | GoalProgressLine | GoalEndLine

export type TeachingFrame = ArmInfoFrame | ArmsLiveFrame | HelpingHandFrame | EntriesChanged | JogStatus | PressDropped | JogReadiness | JogBlockFrame | RefusedFrame | ItemHandleMoved

export type TeachingMessage = PrepareJogging | StartJog | JogVelocity | StopJog | ButtonInput | PreviewTaught | ShowMarks | ShowItemHandle
