"""Actions: goals that are accepted or rejected, give feedback, and can be held and cancelled.

The server's handler is one coroutine per goal, run in a task that the bus owns. It sees its goal
through `ActiveGoal`; the client sees it through `GoalHandle`. A cancel is a request: the goal
has ended only when the handler has, so the next goal finds the device at rest.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any, Generic, TypeVar

from engine.bus.lease import Holder
from engine.cause_chain import cause_of
from engine.errors import BusError, FlexcellError, GoalRejected, SkillFailed
from engine.event import Cause

R = TypeVar("R")
F = TypeVar("F")
_log = logging.getLogger("flexcell.bus")


class GoalStatus(Enum):
    """Where a goal stands; the last four are final."""

    PENDING = "pending"
    ACTIVE = "active"
    HELD = "held"
    CANCELING = "canceling"
    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"
    REJECTED = "rejected"


@dataclass(frozen=True)
class GoalEnd(Generic[R]):
    """How a goal ended; `result` may be partial unless it succeeded, `cause` says why it did not."""

    status: GoalStatus
    result: R | None
    cause: Cause | None


class GoalCanceledEarly(BusError):
    """Raised by `ActiveGoal.accept` when the client cancelled before the server had accepted."""


class ActiveGoal(Generic[F]):
    """The server's view of one goal."""

    def __init__(self, goal_id: str, address: str, holder: Holder) -> None:
        self.id = goal_id
        self.address = address
        self.holder = holder
        self.status = GoalStatus.PENDING
        self.started = False
        self.cancel_requested = False
        self.accepted = asyncio.Event()
        self.latest_feedback: F | None = None
        self.feedback_listeners: list[Callable[[F], None]] = []
        self.cancel_callback: Callable[[], None] | None = None
        self.hold_callback: Callable[[], Awaitable[None]] | None = None
        self.resume_callback: Callable[[], Awaitable[None]] | None = None

    def accept(self) -> None:
        """Declare that the goal will be executed; raise GoalRejected instead to refuse it."""
        if self.cancel_requested:
            raise GoalCanceledEarly("cancelled before it was accepted", where=self.address)
        if self.status is GoalStatus.PENDING:
            self.status = GoalStatus.ACTIVE
            self.accepted.set()

    def feedback(self, message: F) -> None:
        """Tell the client how far it is."""
        self.latest_feedback = message
        for listener in self.feedback_listeners:
            listener(message)

    def on_cancel(self, callback: Callable[[], None]) -> None:
        """Register what starts the stop; without it a cancel cancels the handler's task."""
        self.cancel_callback = callback
        if self.cancel_requested:
            callback()

    def on_hold(self, callback: Callable[[], Awaitable[None]]) -> None:
        """Register what brings the work to rest without ending it; returns when at rest."""
        self.hold_callback = callback

    def on_resume(self, callback: Callable[[], Awaitable[None]]) -> None:
        """Register what lets held work go on."""
        self.resume_callback = callback


class GoalHandle(Generic[R, F]):
    """The client's view of one goal."""

    def __init__(self, goal: ActiveGoal[F], task: asyncio.Task[GoalEnd[R]]) -> None:
        self._goal = goal
        self._task = task

    @property
    def id(self) -> str:
        """The goal's identity, the idempotence key given by the sender."""
        return self._goal.id

    @property
    def address(self) -> str:
        """`<namespace>/<skill_name>`."""
        return self._goal.address

    @property
    def holder_run(self) -> str:
        """The run that sent it."""
        return self._goal.holder.run

    @property
    def holder(self) -> Holder:
        """Who sent it."""
        return self._goal.holder

    @property
    def finished(self) -> bool:
        """True once the handler has ended."""
        return self._task.done()

    @property
    def status(self) -> GoalStatus:
        """Where it stands now."""
        return self._goal.status

    @property
    def feedback(self) -> F | None:
        """The newest feedback."""
        return self._goal.latest_feedback

    def on_feedback(self, listener: Callable[[F], None]) -> None:
        """Call `listener` with every feedback message from now on."""
        self._goal.feedback_listeners.append(listener)

    async def accepted(self) -> None:
        """Wait until the server has accepted.

        Raises:
            GoalRejected: it refused; the message says why.
        """
        await self._begun()
        if self._task.done() and self._task.result().status is GoalStatus.REJECTED:
            cause = self._task.result().cause
            raise GoalRejected(cause.message if cause else "refused", where=self.address)

    async def result(self) -> GoalEnd[R]:
        """Wait for the end; cancelling this wait does not cancel the goal."""
        return await asyncio.shield(self._task)

    def cancel(self) -> None:
        """Ask the server to stop; `result` tells when it has."""
        if self._task.done() or self._goal.cancel_requested:
            return
        self._goal.cancel_requested = True
        if self._goal.status is not GoalStatus.PENDING:
            self._goal.status = GoalStatus.CANCELING
        if self._goal.cancel_callback is not None:
            try:
                self._goal.cancel_callback()
            except Exception:
                # The stop must go on to the other goals, and this handler must end all the same.
                _log.exception("the cancel callback of %s raised; its handler is cancelled", self.address)
                self._task.cancel()
        elif self._goal.started:
            self._task.cancel()

    async def hold(self) -> None:
        """Bring the work to rest and keep the goal; returns when the server confirms.

        A goal that is still being prepared is held as soon as it has been accepted.

        Raises:
            BusError: this skill cannot be held.
        """
        if self._goal.status is GoalStatus.PENDING:
            await self._begun()
        if self._task.done() or self._goal.status is not GoalStatus.ACTIVE:
            return
        if self._goal.hold_callback is None:
            raise BusError("this skill cannot be held", where=self.address, hint="cancel it instead")
        await self._goal.hold_callback()
        if not self._task.done() and self._goal.status is GoalStatus.ACTIVE:
            self._goal.status = GoalStatus.HELD

    async def resume(self) -> None:
        """Let held work go on; returns when the server confirms."""
        if self._goal.status is not GoalStatus.HELD or self._task.done():
            return
        self._goal.status = GoalStatus.ACTIVE
        if self._goal.resume_callback is not None:
            await self._goal.resume_callback()

    async def _begun(self) -> None:
        """Wait until the server has accepted or the goal has ended."""
        waiter = asyncio.ensure_future(self._goal.accepted.wait())
        try:
            await asyncio.wait({waiter, self._task}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            waiter.cancel()


async def execute_goal(
    handler: Callable[[Any, ActiveGoal[Any]], Awaitable[Any]], request: object, goal: ActiveGoal[Any]
) -> GoalEnd[Any]:
    """Run a handler to its end and say how that was; never raises but for the bus closing."""
    goal.started = True
    if goal.cancel_requested:
        end: GoalEnd[Any] = GoalEnd(GoalStatus.CANCELED, None, None)
    else:
        end = await _ended(handler, request, goal)
    goal.status = end.status
    return end


async def _ended(
    handler: Callable[[Any, ActiveGoal[Any]], Awaitable[Any]], request: object, goal: ActiveGoal[Any]
) -> GoalEnd[Any]:
    try:
        result = await handler(request, goal)
    except GoalCanceledEarly:
        return GoalEnd(GoalStatus.CANCELED, None, None)
    except GoalRejected as error:
        status = GoalStatus.ABORTED if goal.accepted.is_set() else GoalStatus.REJECTED
        return GoalEnd(status, None, cause_of(error))
    except SkillFailed as error:
        return GoalEnd(GoalStatus.ABORTED, error.result, cause_of(error))
    except FlexcellError as error:
        return GoalEnd(GoalStatus.ABORTED, None, cause_of(error))
    except asyncio.CancelledError as error:
        if not goal.cancel_requested:
            raise
        task = asyncio.current_task()
        if task is not None:
            task.uncancel()
        return GoalEnd(GoalStatus.CANCELED, None, cause_of(error) if str(error) else None)
    except Exception as error:
        # A driver's bug must end its goal with the reason, not the bus and the other robots.
        _log.exception("the handler of %s raised", goal.address)
        return GoalEnd(GoalStatus.ABORTED, None, cause_of(error))
    if goal.cancel_requested:
        return GoalEnd(GoalStatus.CANCELED, result, None)
    return GoalEnd(GoalStatus.SUCCEEDED, result, None)
