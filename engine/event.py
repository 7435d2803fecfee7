"""Events: the immutable facts of a run, the only input of journal, browser and replay.

`time_s` is the run's own clock (0 at the start); `seq` counts from 1 without gaps. `path` is the
node path, such as `root/approach/left`; `visit` counts the activations of that path in this run.
"""

from __future__ import annotations

import msgspec

from engine.errors import Cause


# Events cannot be part of a reference cycle, and a server keeps hundreds of thousands: the collector can skip them.
class Event(msgspec.Struct, frozen=True, tag_field="event", gc=False):
    """One fact of a run."""

    seq: int
    time_s: float


class RunStarted(Event, frozen=True, kw_only=True, tag="run_started"):
    """The run started; `document` is the semantic hash of the behavior."""

    behavior: str
    document: str
    parameters: dict[str, object]
    seed: int
    clock: str
    inputs: dict[str, object] = {}


class NodeEntered(Event, frozen=True, kw_only=True, tag="entered"):
    """A node became active."""

    path: str
    visit: int
    kind: str
    inputs: dict[str, object]


class NodeExited(Event, frozen=True, kw_only=True, tag="exited", omit_defaults=True):
    """A node ended with an outcome, or was `preempted`."""

    path: str
    visit: int
    outcome: str
    preempted: bool = False
    cause: Cause | None = None


class UserdataWritten(Event, frozen=True, kw_only=True, tag="userdata", omit_defaults=True):
    """A node, or its post-condition named by `post`, wrote `key` into the scope of the container `scope`."""

    path: str
    scope: str
    key: str
    value: object
    post: str = ""


class UserdataAppended(Event, frozen=True, kw_only=True, tag="userdata_appended"):
    """A node appended `value` to the list at `key` in the scope of the container `scope`."""

    path: str
    scope: str
    key: str
    value: object


class TransitionTaken(Event, frozen=True, kw_only=True, tag="transition"):
    """State machine `path` takes the transition of `source` to `target`, a child or an outcome of its own."""

    path: str
    source: str
    outcome: str
    target: str


class GoalSent(Event, frozen=True, kw_only=True, tag="goal"):
    """A state sent an action goal or service request."""

    path: str
    goal: str
    address: str
    request: dict[str, object]


class GoalFinished(Event, frozen=True, kw_only=True, tag="goal_finished", omit_defaults=True):
    """A goal ended: succeeded, canceled, aborted or rejected."""

    path: str
    goal: str
    status: str
    result: dict[str, object] | None = None
    cause: Cause | None = None


class GoalHeld(Event, frozen=True, kw_only=True, tag="goal_held"):
    """The device confirmed rest and keeps the goal."""

    path: str
    goal: str


class GoalResumed(Event, frozen=True, kw_only=True, tag="goal_resumed"):
    """A held goal was resumed."""

    path: str
    goal: str


class ServiceCalled(Event, frozen=True, kw_only=True, tag="call"):
    """A state called a service; `call` numbers the calls of one activation from 1."""

    path: str
    call: str
    address: str
    request: dict[str, object]


class ServiceAnswered(Event, frozen=True, kw_only=True, tag="answer", omit_defaults=True):
    """The service responded, or failed with `cause`."""

    path: str
    call: str
    result: object = None
    cause: Cause | None = None


class MessageReceived(Event, frozen=True, kw_only=True, tag="received"):
    """A state read a message of a topic."""

    path: str
    topic: str
    message: object


class MessagePublished(Event, frozen=True, kw_only=True, tag="published"):
    """A state published a message on a topic."""

    path: str
    topic: str
    message: object


class NodeDiverted(Event, frozen=True, kw_only=True, tag="diverted", omit_defaults=True):
    """A node was left for `target` without an outcome: by timeout, guard or on_error (`by`)."""

    path: str
    visit: int
    by: str
    target: str
    cause: Cause | None = None


class NodeSkipped(Event, frozen=True, kw_only=True, tag="skipped"):
    """A disabled node was passed over with an outcome; it was not entered. In a tree its status is `skipped`."""

    path: str
    outcome: str


class BranchesPreempted(Event, frozen=True, kw_only=True, tag="branches_preempted"):
    """A condition of concurrency container `path` preempts some branches while the others continue.

    `branches` are the preempted branches that had not ended; each has ended, without an outcome, after its clean-up.
    """

    path: str
    condition: str
    branches: tuple[str, ...]


class StatusChanged(Event, frozen=True, kw_only=True, tag="status"):
    """The status of a behavior tree node changed: success, failure, running, skipped or invalid.

    A leaf is invalid when it is halted or its result is discarded. It is running when it has ended but is not ticked
    because the condition of an enclosing `while_do_else` is running; its status is reported at its next tick.
    """

    path: str
    status: str


class OperatorCommanded(Event, frozen=True, kw_only=True, tag="command"):
    """A command of the operator; `command` is a name of `engine.runtime.control.Control`."""

    command: str
    path: str
    arguments: dict[str, object]


class GateReached(Event, frozen=True, kw_only=True, tag="gate", omit_defaults=True):
    """A node waits `before` its entry or `after` its outcome because of `reasons`."""

    path: str
    visit: int
    point: str
    reasons: tuple[str, ...]
    outcome: str = ""


class GatePassed(Event, frozen=True, kw_only=True, tag="gate_passed"):
    """The node continues after the gate."""

    path: str
    visit: int
    point: str


class OutcomeRequested(Event, frozen=True, kw_only=True, tag="outcome_requested"):
    """The run's autonomy is below the level that `outcome` requires; the operator is asked once."""

    path: str
    visit: int
    outcome: str
    required: str


class OutcomeWithdrawn(Event, frozen=True, kw_only=True, tag="outcome_withdrawn"):
    """The request of `OutcomeRequested` is withdrawn or has been answered."""

    path: str
    visit: int
    outcome: str


class PauseConfirmed(Event, frozen=True, kw_only=True, tag="pause_confirmed", omit_defaults=True):
    """All held goals are at rest; `cannot` names the goals that cannot be held."""

    cannot: tuple[str, ...] = ()


class OperatorChanged(Event, frozen=True, kw_only=True, tag="operator"):
    """The operator's status changed to `attached`, `detached` or `lost`."""

    status: str


class BehaviorChanged(Event, frozen=True, kw_only=True, tag="behavior_changed", omit_defaults=True):
    """A new version of the document replaced the running one; `report` has a line for each change.

    `restarted` are the active nodes that are preempted and entered again, `removed` the removed branches of active
    concurrency containers; `preempt` is true when the operator allowed that. `replaced` are the nodes of the old
    version whose class or kind has changed. `documents` are the texts of the new version,
    when they can be stored, and `behavior` names the behavior among them.
    """

    document: str
    report: tuple[str, ...]
    preempt: bool = False
    restarted: tuple[str, ...] = ()
    removed: tuple[str, ...] = ()
    replaced: tuple[str, ...] = ()
    behavior: str = ""
    documents: dict[str, str] = {}


class UndoStarted(Event, frozen=True, kw_only=True, tag="undo_began"):
    """A step back started to undo activation `undoes` of a state; `visit` numbers the undo."""

    path: str
    visit: int
    undoes: int


class UndoEnded(Event, frozen=True, kw_only=True, tag="undo_ended", omit_defaults=True):
    """The undo ended: done, failed with `cause`, or `preempted`."""

    path: str
    visit: int
    undoes: int
    preempted: bool = False
    cause: Cause | None = None


class FormerValue(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """The restored value of `key` in the scope of a container; `defined` is false when it had no value."""

    scope: str
    key: str
    value: object = None
    defined: bool = True


class RunSteppedBack(Event, frozen=True, kw_only=True, tag="stepped_back", omit_defaults=True):
    """The run stepped back to before the entry of `path` and abandoned `source`.

    `values` are restored in userdata. `went_wrong` and `reason` are the causes that the container had recorded of its
    children at that time. With `cause` the step back failed: some states may have been undone, and the run stays where
    it was.
    """

    path: str
    source: str
    values: tuple[FormerValue, ...] = ()
    went_wrong: Cause | None = None
    reason: Cause | None = None
    cause: Cause | None = None


class RunResumed(Event, frozen=True, kw_only=True, tag="resumed"):
    """The run was resumed after its engine died; nodes in `rerun` are entered again, others got an outcome."""

    after_seq: int
    epoch: int
    rerun: tuple[str, ...]


class FaultInjected(Event, frozen=True, kw_only=True, tag="fault", omit_defaults=True):
    """A fault of the fault file was applied to a request."""

    path: str
    address: str
    fault: str
    detail: str = ""


class LoopBlocked(Event, frozen=True, kw_only=True, tag="loop_blocked"):
    """A state blocked the event loop; all other states had to wait."""

    path: str
    blocked_s: float
    where: str


class NodeAbandoned(Event, frozen=True, kw_only=True, tag="abandoned"):
    """A node did not stop in time and was abandoned; the run continues without it."""

    path: str
    waited_s: float


class MessageLogged(Event, frozen=True, kw_only=True, tag="log"):
    """A log message of a state or the runner; `level` is debug, info, warning or error."""

    path: str
    level: str
    message: str


class NodeRetried(Event, frozen=True, kw_only=True, tag="retry"):
    """A node is run again after a failure; `attempt` counts from 2."""

    path: str
    attempt: int
    wait_s: float
    cause: Cause | None = None


class StopRequested(Event, frozen=True, kw_only=True, tag="stop"):
    """A stop of the run was requested."""

    reason: str


class RunEnded(Event, frozen=True, kw_only=True, tag="run_ended", omit_defaults=True):
    """The run ended; `status` is finished, stopped or errored."""

    status: str
    outcome: str | None = None
    cause: Cause | None = None


AnyEvent = (
    RunStarted
    | RunResumed
    | NodeEntered
    | NodeExited
    | UserdataAppended
    | UserdataWritten
    | TransitionTaken
    | NodeDiverted
    | NodeSkipped
    | BranchesPreempted
    | NodeRetried
    | StatusChanged
    | GoalSent
    | GoalFinished
    | GoalHeld
    | GoalResumed
    | ServiceCalled
    | ServiceAnswered
    | MessagePublished
    | MessageReceived
    | MessageLogged
    | OperatorCommanded
    | GateReached
    | GatePassed
    | OutcomeRequested
    | OutcomeWithdrawn
    | PauseConfirmed
    | OperatorChanged
    | UndoStarted
    | UndoEnded
    | RunSteppedBack
    | BehaviorChanged
    | FaultInjected
    | LoopBlocked
    | NodeAbandoned
    | StopRequested
    | RunEnded
)
