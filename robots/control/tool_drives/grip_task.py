"""The motion of a gripper's drive: holds, resumes and cancels it, and reports how it ended."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from robots.control.motion_event import AnyMotionEvent, MotionFinished, MotionHeld, MotionResumed
from robots.port import MotionEnd, MotionReport

REST_S = 0.06
"""Time for which a drive must stand still to be at rest."""


@dataclass(kw_only=True)
class _Task:
    """The active motion."""

    number: int
    patience_s: float
    hold: bool = False
    request: int = 0
    held_reported: bool = False
    resume_pending: bool = False
    cancel: bool = False
    stop_cause: str = ""
    waited_s: float = 0.0


class GripTask:
    """At most one motion at a time; the drive asks it whether to move, and reports every step to it."""

    def __init__(self) -> None:
        self._task: _Task | None = None
        self._rest_s = 0.0

    @property
    def number(self) -> int:
        """Number of the active motion, 0 for none."""
        return self._task.number if self._task else 0

    @property
    def halted(self) -> bool:
        """True while a motion is held or being cancelled."""
        return self._task is not None and (self._task.hold or self._task.cancel)

    @property
    def cancelled(self) -> bool:
        """True while a motion is being cancelled."""
        return self._task is not None and self._task.cancel

    def start(self, number: int, *, patience_s: float) -> None:
        """Begin a motion; it fails after `patience_s`, held time excluded."""
        self._task = _Task(number=number, patience_s=patience_s)
        self._rest_s = 0.0

    def forget(self) -> None:
        """Drop the active motion without an event."""
        self._task, self._rest_s = None, 0.0

    def hold(self, number: int, *, request: int = 0) -> None:
        """Stop and keep the motion."""
        task = self._task
        if task and task.number == number:
            task.hold, task.held_reported, task.resume_pending = True, False, False
            task.request = request

    def resume(self, number: int, *, request: int = 0) -> None:
        """Resume."""
        task = self._task
        if task and task.number == number:
            task.hold, task.resume_pending, task.request = False, True, request

    def cancel(self, number: int) -> None:
        """Stop and end as CANCELED."""
        if self._task and self._task.number == number:
            self._task.cancel = True

    def stop(self, cause: str = "") -> None:
        """Cancel the active motion; with a `cause` it fails with that."""
        if self._task and not self._task.cancel:
            self._task.cancel, self._task.stop_cause = True, cause

    def judge(
        self,
        step_s: float,
        *,
        still: bool,
        reached: bool,
        progress: Callable[[], float],
        late: Callable[[float], str],
    ) -> tuple[AnyMotionEvent, ...]:
        """Return the events of this step.

        Args:
            step_s: The control period.
            still: Nothing moves in this step; after `REST_S` the drive is at rest.
            reached: The goal is reached.
            progress: Completed share of the motion.
            late: Returns the failure reason after the given number of seconds.
        """
        self._rest_s = self._rest_s + step_s if still else 0.0
        task = self._task
        if task is None:
            return ()
        at_rest = self._rest_s >= REST_S
        if task.resume_pending:
            task.resume_pending = False
            self._rest_s = 0.0
            return (MotionResumed(motion=task.number, request=task.request),)
        if task.cancel:
            if not at_rest:
                return self._wait(step_s, progress, late, at_rest=at_rest)
            end = MotionEnd.FAILED if task.stop_cause else MotionEnd.CANCELED
            return self._finish(task, end, progress, task.stop_cause)
        if task.hold:
            if not at_rest or task.held_reported:
                return ()
            task.held_reported = True
            return (MotionHeld(motion=task.number, request=task.request),)
        if at_rest and reached:
            return self._finish(task, MotionEnd.REACHED, progress)
        return self._wait(step_s, progress, late, at_rest=at_rest)

    def _wait(
        self, step_s: float, progress: Callable[[], float], late: Callable[[float], str], *, at_rest: bool
    ) -> tuple[AnyMotionEvent, ...]:
        task = self._task
        assert task is not None
        task.waited_s += step_s
        if task.waited_s < task.patience_s:
            return ()
        return self._finish(task, MotionEnd.FAILED, progress, late(task.waited_s), at_rest=at_rest)

    def _finish(
        self, task: _Task, end: MotionEnd, progress: Callable[[], float], reason: str = "", *, at_rest: bool = True
    ) -> tuple[AnyMotionEvent, ...]:
        share = progress()
        self._task = None
        report = MotionReport(end=end, reason=reason, at_rest=at_rest)
        return (MotionFinished(motion=task.number, progress=share, report=report),)


class TaskDrive:
    """Base of the drives of tools: the motion that they execute is a `GripTask`.

    What a drive does at rest and while held is its own: fingers keep their force, a switch its field.
    """

    def __init__(self) -> None:
        self._task = GripTask()

    @property
    def number(self) -> int:
        """Number of the active motion, 0 for none."""
        return self._task.number

    def hold(self, number: int, *, request: int = 0) -> None:
        """Stop and keep the motion."""
        self._task.hold(number, request=request)

    def resume(self, number: int, *, request: int = 0) -> None:
        """Resume the motion."""
        self._task.resume(number, request=request)

    def cancel(self, number: int) -> None:
        """Stop where it is and end as CANCELED."""
        self._task.cancel(number)

    def stop(self, cause: str = "") -> None:
        """Cancel the active motion; a held object stays held. With a `cause` the motion fails."""
        self._task.stop(cause)
