"""Actions: goals that are accepted or rejected, send feedback, and can be held and cancelled.

The server's handler is one coroutine per goal, run in a task that the bus owns. The handler accesses
its goal through `ActiveGoal`, the client through `GoalHandle`. A cancel is a request: the goal ends
only when its handler does, so the next goal starts with the device at rest.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable
from typing import Any, Generic, TypeVar

from engine.bus.lease import Holder
from engine.cause_chain import cause_of
from engine.errors import BusError, FlexcellError, GoalRejected, SkillFailed
from engine.skills.goal_end import GoalEnd, GoalStatus

R = TypeVar("R")
F = TypeVar("F")
_log = logging.getLogger("flexcell.bus")


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
        self.replaceable = False
        """Whether it is idle now and ends for the next goal; the handler sets this, see `SkillBus.send_goal`."""
        self.was_replaced = False
        self.ended = asyncio.Event()
        self.accepted = asyncio.Event()
        self.accept_listeners: list[Callable[[], None]] = []
        self.latest_feedback: F | None = None
        self.feedback_listeners: list[Callable[[F], None]] = []
        self.cancel_callback: Callable[[], None] | None = None
        self.hold_callback: Callable[[], Awaitable[None]] | None = None
        self.resume_callback: Callable[[], Awaitable[None]] | None = None

    def accept(self) -> None:
        """Accept the goal for execution; a handler that rejects it raises GoalRejected instead."""
        if self.cancel_requested:
            raise GoalCanceledEarly("cancelled before it was accepted", where=self.address)
        if self.status is GoalStatus.PENDING:
            self.status = GoalStatus.ACTIVE
            self.accepted.set()
            for listener in self.accept_listeners:
                listener()

    def feedback(self, message: F) -> None:
        """Send a feedback message to the client."""
        self.latest_feedback = message
        for listener in self.feedback_listeners:
            listener(message)

    def on_cancel(self, callback: Callable[[], None]) -> None:
        """Register the callback that starts the stop; without one a cancel cancels the handler's task."""
        self.cancel_callback = callback
        if self.cancel_requested:
            callback()

    def on_hold(self, callback: Callable[[], Awaitable[None]]) -> None:
        """Register the callback that brings the device to rest and keeps the goal; it returns at rest."""
        self.hold_callback = callback

    def on_resume(self, callback: Callable[[], Awaitable[None]]) -> None:
        """Register the callback that resumes a held goal."""
        self.resume_callback = callback


class GoalHandle(Generic[R, F]):
    """The client's view of one goal."""

    def __init__(self, goal: ActiveGoal[F], task: asyncio.Task[GoalEnd[R]]) -> None:
        self._goal = goal
        self._task = task

    @property
    def id(self) -> str:
        """The goal's identifier, the idempotence key given by the sender."""
        return self._goal.id

    @property
    def address(self) -> str:
        """`<namespace>/<skill_name>`."""
        return self._goal.address

    @property
    def holder_run(self) -> str:
        """The run that sent the goal."""
        return self._goal.holder.run

    @property
    def holder(self) -> Holder:
        """The sender of the goal."""
        return self._goal.holder

    @property
    def finished(self) -> bool:
        """True once the handler has ended."""
        return self._task.done()

    @property
    def status(self) -> GoalStatus:
        """The present status."""
        return self._goal.status

    @property
    def replaceable(self) -> bool:
        """True while the goal is idle and would end for another one."""
        return self._goal.replaceable and not self._goal.was_replaced

    @property
    def feedback(self) -> F | None:
        """The latest feedback."""
        return self._goal.latest_feedback

    def on_feedback(self, listener: Callable[[F], None]) -> None:
        """Call `listener` with every feedback message from now on."""
        self._goal.feedback_listeners.append(listener)

    def on_accepted(self, listener: Callable[[], None]) -> None:
        """Call `listener` when the server accepts the goal, before its handler goes on."""
        self._goal.accept_listeners.append(listener)

    async def accepted(self) -> None:
        """Wait until the server has accepted.

        Raises:
            GoalRejected: the server rejected the goal; the message is the reason.
        """
        await self._accepted_or_ended()
        if self._task.done() and self._task.result().status is GoalStatus.REJECTED:
            cause = self._task.result().cause
            raise GoalRejected(cause.message if cause else "refused", where=self.address)

    async def result(self) -> GoalEnd[R]:
        """Wait for the end; cancelling this wait does not cancel the goal."""
        return await asyncio.shield(self._task)

    def cancel(self) -> None:
        """Request a stop from the server; `result` returns when the goal has ended."""
        if self._task.done() or self._goal.cancel_requested:
            return
        self._goal.cancel_requested = True
        if self._goal.status is not GoalStatus.PENDING:
            self._goal.status = GoalStatus.CANCELING
        if self._goal.cancel_callback is not None:
            try:
                self._goal.cancel_callback()
            except Exception:
                # The stop must reach the other goals too, and this handler must still end.
                _log.exception("the cancel callback of %s raised; its handler is cancelled", self.address)
                self._task.cancel()
        elif self._goal.started:
            self._task.cancel()

    def replace(self) -> None:
        """Request a stop because another goal takes the place of this idle one."""
        self._goal.was_replaced = True
        self.cancel()

    async def hold(self) -> None:
        """Bring the device to rest and keep the goal; returns when the server confirms.

        A pending goal is held as soon as it is accepted.

        Raises:
            BusError: this skill cannot be held.
        """
        if self._goal.status is GoalStatus.PENDING:
            await self._accepted_or_ended()
        if self._task.done() or self._goal.status is not GoalStatus.ACTIVE:
            return
        if self._goal.hold_callback is None:
            raise BusError("this skill cannot be held", where=self.address, hint="cancel it instead")
        await self._goal.hold_callback()
        if not self._task.done() and self._goal.status is GoalStatus.ACTIVE:
            self._goal.status = GoalStatus.HELD

    async def resume(self) -> None:
        """Resume a held goal; returns when the server confirms."""
        if self._goal.status is not GoalStatus.HELD or self._task.done():
            return
        self._goal.status = GoalStatus.ACTIVE
        if self._goal.resume_callback is not None:
            await self._goal.resume_callback()

    async def _accepted_or_ended(self) -> None:
        """Wait until the server has accepted or the goal has ended."""
        waiter = asyncio.ensure_future(self._goal.accepted.wait())
        try:
            await asyncio.wait({waiter, self._task}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            waiter.cancel()


async def execute_goal(
    handler: Callable[[Any, ActiveGoal[Any]], Awaitable[Any]], request: object, goal: ActiveGoal[Any]
) -> GoalEnd[Any]:
    """Run a handler to its end and return the goal's end; raises only when the bus closes."""
    goal.started = True
    if goal.cancel_requested:
        end: GoalEnd[Any] = GoalEnd(GoalStatus.CANCELED, None, None)
    else:
        end = await _run_handler(handler, request, goal)
    goal.status = end.status
    return end


async def _run_handler(
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
        # A defect of a driver must end its own goal, with the reason, and not the bus or other robots.
        _log.exception("the handler of %s raised", goal.address)
        return GoalEnd(GoalStatus.ABORTED, None, cause_of(error))
    if goal.cancel_requested:
        return GoalEnd(GoalStatus.CANCELED, result, None)
    return GoalEnd(GoalStatus.SUCCEEDED, result, None)
