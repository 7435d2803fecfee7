"""A state is one step of a behavior: a frozen set of typed parameters and a coroutine.

    class Wait(State, frozen=True, kw_only=True):
        '''Let time pass.'''

        state_name: ClassVar[str] = "flow.Wait"
        outcomes: ClassVar[tuple[str, ...]] = ("done",)
        duration_s: Annotated[float, Meta(ge=0, description="How long", extra_json_schema={"unit": "s"})]

        async def run(self, ctx: Context) -> Outcome:
            await ctx.clock.sleep(self.duration_s)
            return Outcome("done")

Fields are the parameters (`with:`). Keyword-only arguments of `run` after `ctx` are the input keys
(`in:`) with their types and defaults. Keys of `outputs` are the output keys (`out:`). Being
preempted is being cancelled: clean up in `try/finally` and let CancelledError pass. A state that
can be taken back has an `undo` as well.
"""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, Protocol, TypeVar

import msgspec

from engine.clock import Clock
from engine.event import Cause
from engine.skill import Action, Service
from engine.skills.arm_target import ArmTarget, StoredTargets, ToolChange

R = TypeVar("R")
F = TypeVar("F")
S = TypeVar("S", bound=msgspec.Struct)

_NO_OUTPUT: Mapping[str, object] = {}
_ALWAYS_WRITTEN: Mapping[str, tuple[str, ...]] = {}


class Outcome(msgspec.Struct, frozen=True):
    """How a state ended: a declared outcome name, its output keys, and why where it went wrong."""

    name: str
    outputs: Mapping[str, object] = _NO_OUTPUT
    cause: Cause | None = None


@dataclass(frozen=True)
class ActionEnd(Generic[R]):
    """How an action goal ended: `status` succeeded, canceled, aborted or rejected."""

    status: str
    result: R | None
    cause: Cause | None


class RequestRecord(msgspec.Struct, frozen=True, kw_only=True):
    """A goal that a state had sent, or a call, and what came of it.

    `status` is succeeded, canceled, aborted or rejected for a goal, answered or failed for a call, and empty where no
    end is known, as after a crash.
    """

    address: str
    request: Mapping[str, object]
    status: str = ""
    result: object = None


class ActivationRecord(msgspec.Struct, frozen=True, kw_only=True):
    """What one activation of a state has done, for its `undo`: from the events of the run, also those before a crash.

    `outcome` is empty where it was preempted or failed with an error. `outputs` are as plain data.
    """

    inputs: Mapping[str, object]
    outcome: str
    outputs: Mapping[str, object]
    requests: tuple[RequestRecord, ...]


class Context(Protocol):
    """What a running state may touch; nothing else is passed to it."""

    @property
    def clock(self) -> Clock:
        """The run's time; the only one a state may ask."""
        ...

    @property
    def path(self) -> str:
        """Where this state stands in its behavior, `root/approach/left`."""
        ...

    async def call(self, request: Service[R], *, to: str) -> R:
        """Ask the service `<to>/<skill_name>`.

        Raises:
            NoSuchSkill: nobody answers there.
            SkillFailed: the handler raised something that is not of our family; its error is the cause.
            FlexcellError: the handler's own, such as EntryNotFound, unchanged.
        """
        ...

    async def perform(self, goal: Action[R, F], *, to: str) -> ActionEnd[R]:
        """Send a goal to `<to>/<skill_name>` and wait for its end.

        A preempted state cancels the goal and waits until the device confirms rest before
        CancelledError goes on. Pausing the run holds the goal.
        """
        ...

    async def latest(self, topic: str, kind: type[S]) -> S:
        """Return the newest message of a topic, waiting for the first one."""
        ...

    async def next_message(self, topic: str, kind: type[S]) -> S:
        """Wait for the next message of a topic."""
        ...

    async def offer(self, outcome: str) -> None:
        """Return when the operator agrees to `outcome`, at once where the run's autonomy lets it pass.

        A state that changes its mind cancels this call, which withdraws the question. Returning
        the outcome afterwards asks no second time.
        """
        ...

    def log(self, message: str, *, level: str = "info") -> None:
        """Write a line into the run's event log."""
        ...

    def random(self) -> float:
        """A number in [0, 1) from the run's seed."""
        ...


async def nothing_to_undo(self: State, ctx: Context, done: ActivationRecord) -> None:
    """Undo a state that leaves nothing behind but what it wrote; in its class as `undo = nothing_to_undo`."""


class State(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One step. Subclasses give `state_name`, `outcomes`, parameters as fields, and `run`."""

    state_name: ClassVar[str] = ""
    outcomes: ClassVar[tuple[str, ...]] = ()
    outputs: ClassVar[Mapping[str, Any]] = _NO_OUTPUT
    """Output key → type."""
    success: ClassVar[tuple[str, ...]] = ()
    """Outcomes that mean SUCCESS to a behavior tree; the others mean FAILURE."""
    resume: ClassVar[str] = ""
    """What to do after a crash in mid-state: rerun, ask, or an outcome; by default ask where it commands
    hardware and an operator is demanded, else rerun."""
    instant: ClassVar[bool] = False
    """True when it waits for nothing, and parameters and inputs alone decide its outcome; loops of them are found."""
    observes: ClassVar[bool] = False
    """True when it only reads what others measure, at little cost and without an effect: a behavior tree then asks it
    again on its own while what stands behind it is at work, and no event tells of that unless the answer changes."""
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = _ALWAYS_WRITTEN
    """Outcome → output keys that are not written with it; the check takes all others for written."""

    def resources(self) -> tuple[str, ...]:
        """Names of the robots and devices this state commands; leased while it runs."""
        return ()

    def arm_targets(self, stored: StoredTargets) -> tuple[ArmTarget | ToolChange, ...]:
        """Where this state takes arms; asked by a check, before any run, and on objects with some parameters unknown.

        Args:
            stored: The entries that the store of the cell begins with.
        """
        return ()

    async def on_pause(self, ctx: Context) -> None:
        """Come to rest; called while `run` goes on when the run is paused, beside holding its goals."""

    async def on_resume(self, ctx: Context) -> None:
        """Go on after a pause."""

    def cannot_undo(self, done: ActivationRecord) -> str:
        """Return why what an activation has done cannot be undone; empty where it can. Asked before anything moves."""
        return ""

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        """Undo what an activation has done, for a step back; a class without its own cannot be taken back.

        What the state wrote into userdata is taken back without its help. An error says that it could not be undone.
        """
        raise NotImplementedError

    run: ClassVar[Callable[..., Coroutine[Any, Any, Outcome]]]
    """Do the step: subclasses write `async def run(self, ctx: Context, *, key: type, …) -> Outcome`."""
