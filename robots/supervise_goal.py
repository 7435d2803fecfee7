"""Supervises the motion of a goal: feedback, hold, resume, cancel and the result of the motion."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from engine.bus import ActiveGoal
from engine.errors import RobotError, SkillFailed
from robots.port import Motion, MotionEnd, MotionReport

FEEDBACK_S = 0.05


async def supervise_goal(
    motion: Motion, handle: ActiveGoal[Any], *, publish: Callable[[], None], device: str, words: str
) -> None:
    """Return once `motion` has ended and its device is at rest, also for a canceled goal.

    `publish` publishes feedback, also at the end; `device` is the bus name of the moving device and `words` its name
    in messages.

    Raises:
        SkillFailed: the device stopped by itself, or was stopped by a party other than the goal's sender.
        CancelledError: this task was cancelled; the device is at rest nevertheless.
    """
    handle.on_cancel(motion.cancel)
    handle.on_hold(motion.hold)
    handle.on_resume(motion.resume)
    report = asyncio.ensure_future(motion.report())
    try:
        while not (await asyncio.wait((report,), timeout=FEEDBACK_S))[0]:
            publish()
    finally:
        await _at_rest(motion, report)
    publish()
    _check_report(report.result(), handle, device=device, words=words)


async def _at_rest(motion: Motion, report: asyncio.Future[MotionReport]) -> None:
    """Cancel the motion and wait for its end, even if this task is cancelled repeatedly meanwhile."""
    cancelled: asyncio.CancelledError | None = None
    if not report.done():
        # A device that no longer takes commands is lost; its report gives the reason.
        with suppress(RobotError):
            motion.cancel()
    while not report.done():
        try:
            await asyncio.wait((report,))
        except asyncio.CancelledError as error:
            cancelled = error
    if cancelled is not None:
        raise cancelled


def _check_report(report: MotionReport, handle: ActiveGoal[Any], *, device: str, words: str) -> None:
    if report.end is MotionEnd.FAILED:
        cause = RobotError(report.reason or "the port gives no reason", where=device)
        raise SkillFailed(f"{words} stopped before the goal", where=handle.address) from cause
    if report.end is MotionEnd.CANCELED and not handle.cancel_requested:
        raise SkillFailed(f"{words} was stopped by another command", where=handle.address)
