"""A state is one step of a behavior: a frozen set of typed parameters and a coroutine.

    class Wait(State, frozen=True, kw_only=True):
        '''Wait for a duration.'''

        state_name: ClassVar[str] = "flow.Wait"
        outcomes: ClassVar[tuple[str, ...]] = ("done",)
        duration_s: Annotated[float, Meta(ge=0, description="Duration", extra_json_schema={"unit": "s"})]

        async def run(self, ctx: Context) -> Outcome:
            await ctx.clock.sleep(self.duration_s)
            return Outcome("done")

Fields are the parameters (`with:`). Keyword-only arguments of `run` after `ctx` are the input keys
(`in:`) with their types and defaults. Keys of `outputs` are the output keys (`out:`). A preempted
state is cancelled: clean up in `try/finally` and do not suppress CancelledError. A state that can
be undone also has an `undo`.
"""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Mapping
from typing import Any, ClassVar, Protocol, TypeVar

import msgspec

from engine.cause_chain import wrap_cause
from engine.clock import Clock
from engine.errors import Cause, PathBlocked
from engine.skill import Action, Service, Skill
from engine.skills.arm_target import ArmTarget, StoredTargets, ToolChange
from engine.skills.goal_end import GoalEnd

_BLOCKED = PathBlocked.__name__
_NO_REASON = {
    "canceled": "the goal was cancelled by somebody other than this state",
    "rejected": "the device gave no reason for refusing it",
}

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)

Skills = tuple[type[Skill[Any]], ...]
_NO_OUTPUT: Mapping[str, object] = {}
_ALWAYS_WRITTEN: Mapping[str, tuple[str, ...]] = {}


class Outcome(msgspec.Struct, frozen=True):
    """The result of a state: a declared outcome name, its output keys, and the cause of a failure."""

    name: str
    outputs: Mapping[str, object] = _NO_OUTPUT
    cause: Cause | None = None


class RequestRecord(msgspec.Struct, frozen=True, kw_only=True):
    """A goal or call of a state, with its result.

    `status` is succeeded, canceled, aborted or rejected for a goal, answered or failed for a call, and empty when the
    end is unknown, as after a crash.
    """

    address: str
    request: Mapping[str, object]
    status: str = ""
    result: object = None


class ActivationRecord(msgspec.Struct, frozen=True, kw_only=True):
    """The effects of one activation of a state, for its `undo`: from the events of the run, also those before a crash.

    `outcome` is empty when it was preempted or failed with an error. `outputs` are plain data.
    """

    inputs: Mapping[str, object]
    outcome: str
    outputs: Mapping[str, object]
    requests: tuple[RequestRecord, ...]


class Context(Protocol):
    """The interface of a running state to the run; nothing else is passed to it."""

    @property
    def clock(self) -> Clock:
        """The clock of the run, the only one that a state may use."""
        ...

    @property
    def path(self) -> str:
        """The node path of this state, such as `root/approach/left`."""
        ...

    async def call(self, request: Service[R], *, to: str) -> R:
        """Call the service `<to>/<skill_name>`.

        Raises:
            NoSuchSkill: there is no such service.
            SkillFailed: the handler raised an error that is not a FlexcellError; it is the cause.
            FlexcellError: the handler's own error, such as EntryNotFound, unchanged.
        """
        ...

    async def perform(self, goal: Action[R, F], *, to: str) -> GoalEnd[R]:
        """Send a goal to `<to>/<skill_name>` and wait for its end.

        A preempted state cancels the goal and waits until the device confirms rest before
        CancelledError is raised. Pausing the run holds the goal.
        """
        ...

    async def latest(self, topic: str, kind: type[S]) -> S:
        """Return the latest message of a topic; wait for the first one."""
        ...

    async def next_message(self, topic: str, kind: type[S]) -> S:
        """Wait for the next message of a topic."""
        ...

    async def latest_data(self, topic: str) -> object:
        """Return the latest message of a topic of any type as plain data; wait for the first one.

        Raises:
            BusError: there is no such topic.
        """
        ...

    async def next_data(self, topic: str, condition: Callable[[object], bool]) -> object:
        """Wait for the next message of a topic of any type, as plain data, that meets a condition.

        No message between the call and the answer is missed. The run records that message alone.

        Raises:
            BusError: there is no such topic.
        """
        ...

    async def publish(self, topic: str, message: object) -> None:
        """Publish plain data on a topic that the cell document declares.

        Raises:
            BusError: the cell declares no such topic, or the message is not of its type.
        """
        ...

    async def offer(self, outcome: str) -> None:
        """Return when the operator approves `outcome`, at once when the run's autonomy permits it.

        Cancelling this call withdraws the request. Returning the outcome afterwards does not ask
        the operator again.
        """
        ...

    def log(self, message: str, *, level: str = "info") -> None:
        """Write a line into the run's event log."""
        ...

    def random(self) -> float:
        """Return a number in [0, 1) from the run's seed."""
        ...


async def nothing_to_undo(self: State, ctx: Context, done: ActivationRecord) -> None:
    """Undo a state without effects other than its outputs; assign it in the class as `undo = nothing_to_undo`."""


class State(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One step of a behavior. Subclasses define `state_name`, `outcomes`, parameters as fields, and `run`."""

    state_name: ClassVar[str] = ""
    outcomes: ClassVar[tuple[str, ...]] = ()
    outputs: ClassVar[Mapping[str, Any]] = _NO_OUTPUT
    """Output key → type."""
    skills: ClassVar[Skills] = ()
    """The skills that it performs and that need a capability of the device; the check compares them with its driver."""
    icon: ClassVar[str] = ""
    """The name of its icon on the page; without one, `ICON` of its module, then of its package."""
    success: ClassVar[tuple[str, ...]] = ()
    """Outcomes that mean SUCCESS to a behavior tree; the others mean FAILURE."""
    resume: ClassVar[str] = ""
    """Action after a crash during the state: rerun, ask, or an outcome; by default ask when it commands
    hardware and an operator is demanded, else rerun."""
    instant: ClassVar[bool] = False
    """True when it never waits, and only parameters and inputs decide its outcome; the check finds loops of them."""
    observes: ClassVar[bool] = False
    """True when it only reads measurements, at little cost and without effects: a behavior tree then evaluates it
    again while a later node is running, and records events only when the result changes."""
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = _ALWAYS_WRITTEN
    """Outcome → output keys that are not written with it; the check assumes that all others are written."""

    def resources(self) -> tuple[str, ...]:
        """Names of the robots and devices that this state commands; leased while it runs."""
        return ()

    def arm_targets(self, stored: StoredTargets) -> tuple[ArmTarget | ToolChange, ...]:
        """Targets of arms in this state; called by a check before any run, also with some parameters unknown.

        Args:
            stored: The initial entries of the cell's store.
        """
        return ()

    async def on_pause(self, ctx: Context) -> None:
        """Come to rest; called during `run` when the run is paused, in addition to holding its goals."""

    async def on_resume(self, ctx: Context) -> None:
        """Resume after a pause."""

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Return why an activation cannot be undone; empty when it can. Called before anything moves."""
        return ""

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Undo the effects of an activation, for a step back; a class without its own `undo` cannot be undone.

        The values that the state wrote into userdata are restored separately. An error means that the undo failed.
        """
        raise NotImplementedError

    run: ClassVar[Callable[..., Coroutine[Any, Any, Outcome]]]
    """Execute the step: subclasses define `async def run(self, ctx: Context, *, key: type, …) -> Outcome`."""


def goal_cause(what: str, goal: Action[Any, Any], end: GoalEnd[Any], *, to: str, where: str, kind: str) -> Cause:
    """Return the cause chain of a failed goal.

    Args:
        what: The message, `left did not reach joints entry home`.
        goal: The goal that was sent.
        end: The end of the goal; its cause is the inner cause of the chain.
        to: The bus namespace that the goal was sent to.
        where: The path of the state.
        kind: The name of the state.
    """
    address = goal.address(to)
    skill = address.rpartition("/")[2]
    fallback = Cause(message=_NO_REASON.get(end.status, "the device gave no reason"), where=address)
    return wrap_cause(f"{what}: {skill} was {end.status}", end.cause or fallback, where=where, kind=kind)


def is_path_blocked(end: GoalEnd[Any]) -> bool:
    """Return whether a goal was refused because the planning scene blocks its path."""
    return end.cause is not None and any(link.kind == _BLOCKED for link in end.cause.chain())
