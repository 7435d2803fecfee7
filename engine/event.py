"""Events: the frozen facts of a run, the only thing journal, browser and replay ever see.

`time_s` is the run's own clock (0 at the start); `seq` counts from 1 without gaps. `path` is the
node path `root/approach/left`; `visit` counts the activations of that path in this run.
"""

from __future__ import annotations

import msgspec


class Cause(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """One link of the chain that explains a failure; `because` is the link below it.

    `nodes` is the way an error took through the behavior, `path at file:line:column`, innermost first.
    """

    message: str
    where: str = ""
    kind: str = ""
    because: Cause | None = None
    nodes: tuple[str, ...] = ()

    def chain(self) -> tuple[Cause, ...]:
        """Return the links from the outermost to the root cause."""
        links: list[Cause] = []
        link: Cause | None = self
        while link is not None:
            links.append(link)
            link = link.because
        return tuple(links)


# None of them can be part of a circle, and a server keeps hundreds of thousands: the collector need not look at them.
class Event(msgspec.Struct, frozen=True, tag_field="event", gc=False):
    """One fact of a run."""

    seq: int
    time_s: float


class RunStarted(Event, frozen=True, kw_only=True, tag="run_started"):
    """The run begins; `document` is the content hash of the behavior's meaning."""

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
    """A node finished with an outcome; `preempted` when it was told to stop instead."""

    path: str
    visit: int
    outcome: str
    preempted: bool = False
    cause: Cause | None = None


class UserdataWritten(Event, frozen=True, kw_only=True, tag="userdata", omit_defaults=True):
    """A node wrote `key` into the scope of the container `scope`, or a post-condition of it did, which `post` names."""

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
    """Machine `path` follows the outcome of `source` to `target`, a child or an own outcome."""

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
    """The goal ended: succeeded, canceled, aborted or rejected."""

    path: str
    goal: str
    status: str
    result: dict[str, object] | None = None
    cause: Cause | None = None


class GoalHeld(Event, frozen=True, kw_only=True, tag="goal_held"):
    """The device confirmed that it is at rest and keeps the goal."""

    path: str
    goal: str


class GoalResumed(Event, frozen=True, kw_only=True, tag="goal_resumed"):
    """A goal that was held goes on."""

    path: str
    goal: str


class ServiceCalled(Event, frozen=True, kw_only=True, tag="call"):
    """A state asked a service; `call` numbers the calls of one activation, from 1."""

    path: str
    call: str
    address: str
    request: dict[str, object]


class ServiceAnswered(Event, frozen=True, kw_only=True, tag="answer", omit_defaults=True):
    """The service answered, or failed with `cause`."""

    path: str
    call: str
    result: object = None
    cause: Cause | None = None


class MessageReceived(Event, frozen=True, kw_only=True, tag="received"):
    """A state read a message of a topic."""

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


class BranchesPreempted(Event, frozen=True, kw_only=True, tag="branches_preempted"):
    """A condition of concurrency container `path` holds that preempts some branches, while the others go on.

    `branches` are those of them that had not ended; each counts as ended, without an outcome, when it has cleaned up.
    """

    path: str
    condition: str
    branches: tuple[str, ...]


class StatusChanged(Event, frozen=True, kw_only=True, tag="status"):
    """A composite or decorator of a behavior tree has another status: success, failure, running, skipped or invalid.

    A leaf is invalid when it is halted, or its end counts no more; running when it has ended and a tick has not come to
    it, as the condition of a `while_do_else` around it is running. When one comes to it at last, its status is told.
    """

    path: str
    status: str


class OperatorCommanded(Event, frozen=True, kw_only=True, tag="command"):
    """The operator commanded something; `command` is a name of `engine.runtime.control.Control`."""

    command: str
    path: str
    arguments: dict[str, object]


class GateReached(Event, frozen=True, kw_only=True, tag="gate", omit_defaults=True):
    """A node waits `before` its entry or `after` its outcome, for one of `reasons`."""

    path: str
    visit: int
    point: str
    reasons: tuple[str, ...]
    outcome: str = ""


class GatePassed(Event, frozen=True, kw_only=True, tag="gate_passed"):
    """It waits no longer."""

    path: str
    visit: int
    point: str


class OutcomeRequested(Event, frozen=True, kw_only=True, tag="outcome_requested"):
    """The run's autonomy is below what `outcome` requires; the operator is asked once."""

    path: str
    visit: int
    outcome: str
    required: str


class OutcomeWithdrawn(Event, frozen=True, kw_only=True, tag="outcome_withdrawn"):
    """The question of `OutcomeRequested` has become void, answered or not."""

    path: str
    visit: int
    outcome: str


class PauseConfirmed(Event, frozen=True, kw_only=True, tag="pause_confirmed", omit_defaults=True):
    """Everything that was to be held is at rest; `cannot` names goals that cannot be held."""

    cannot: tuple[str, ...] = ()


class OperatorChanged(Event, frozen=True, kw_only=True, tag="operator"):
    """The operator is `attached`, `detached` or `lost`."""

    status: str


class BehaviorChanged(Event, frozen=True, kw_only=True, tag="behavior_changed", omit_defaults=True):
    """A new version of the document took the place of the running one; `report` has a line for each change.

    `restarted` are the active nodes that are preempted and entered anew, `removed` the branches of active concurrency
    containers that are gone; `preempt` says that the operator wanted that. `replaced` are the nodes of the old version
    that are of another class or kind now. `documents` are the texts of the version,
    where they can be kept, and `behavior` is the name of the behavior among them.
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
    """A step back began to undo a state: what its activation `undoes` had done; `visit` numbers the undoing."""

    path: str
    visit: int
    undoes: int


class UndoEnded(Event, frozen=True, kw_only=True, tag="undo_ended", omit_defaults=True):
    """It is undone; not where it failed with `cause`, or was `preempted`."""

    path: str
    visit: int
    undoes: int
    preempted: bool = False
    cause: Cause | None = None


class FormerValue(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """What `key` of the scope of a container held before what was taken back; not `defined` where it held nothing."""

    scope: str
    key: str
    value: object = None
    defined: bool = True


class RunSteppedBack(Event, frozen=True, kw_only=True, tag="stepped_back", omit_defaults=True):
    """The run stands before the entry of `path` again, `source` having been given up for that.

    `values` are in userdata again. `went_wrong` and `reason` are what the container knew then of the course of its
    children. With `cause` it was not possible: something may have been undone, and it stands where it was.
    """

    path: str
    source: str
    values: tuple[FormerValue, ...] = ()
    went_wrong: Cause | None = None
    reason: Cause | None = None
    cause: Cause | None = None


class RunResumed(Event, frozen=True, kw_only=True, tag="resumed"):
    """The run goes on after its engine died; nodes in `rerun` are entered again, others took an outcome."""

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
    """A state kept the event loop from running: every other state had to wait."""

    path: str
    blocked_s: float
    where: str


class NodeAbandoned(Event, frozen=True, kw_only=True, tag="abandoned"):
    """A node did not confirm in time that it stopped; the run goes on without it."""

    path: str
    waited_s: float


class MessageLogged(Event, frozen=True, kw_only=True, tag="log"):
    """A state or the runner says something; `level` is debug, info, warning or error."""

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
    """Somebody asked the run to stop."""

    reason: str


class RunEnded(Event, frozen=True, kw_only=True, tag="run_ended", omit_defaults=True):
    """The run is over; `status` is finished, stopped or errored."""

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
    | BranchesPreempted
    | NodeRetried
    | StatusChanged
    | GoalSent
    | GoalFinished
    | GoalHeld
    | GoalResumed
    | ServiceCalled
    | ServiceAnswered
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
