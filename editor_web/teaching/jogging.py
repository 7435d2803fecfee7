"""Jogging for one page: an arm moves only while the page sends velocities, and stops when the page disconnects.

One goal serves all presses of an arm in one space; it stays open for `OPEN_S` after the last one and gives way to any
other goal meanwhile. A press that is released before the arm has moved is executed for `LEAST_PRESS_S` nevertheless.
The arm has its own watchdog: without a velocity for `WATCHDOG_S` it comes to rest, independent of this module.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from editor_web.teaching.goal_failure_text import goal_failure_text
from editor_web.teaching.teaching_messages import JogStatus, PressDropped, RefusedFrame, StartJog
from engine.bus import GoalHandle, GoalStatus, JsonBus
from engine.errors import FlexcellError
from engine.skills.jogging import MOST_WAIT_S

WATCHDOG_S = 0.12
"""Three times the period at which a page repeats its velocity."""
OPEN_S = 1.0
"""How long a goal stays open after the last release."""
IDLE_S = 3.0
"""After so long without a command the arm itself ends the goal: this server no longer does."""
LEAST_PRESS_S = 0.1
"""The shortest press: as long as a key that is tapped."""
MOST_M_S, MOST_RAD_S, MOST_JOINT_RAD_S = 0.25, 1.0, 1.0
_LATE_S = 0.001
_LINEAR = 3
_TWIST = 6
ToPage = JogStatus | PressDropped | RefusedFrame


@dataclass(kw_only=True)
class _Press:
    """A press of the page.

    Attributes:
        jog: What is jogged.
        velocity: The latest one; empty before the first.
        heard_s: When it, or the release, came.
        is_up: Whether it is released.
        is_published: Whether the arm knows of it.
    """

    jog: StartJog
    velocity: tuple[float, ...] = ()
    heard_s: float = 0.0
    is_up: bool = False
    is_published: bool = False


class Jogger:
    """Jogs at most one arm.

    Args:
        bus: The bus of the arms.
        taken: The jogged arms of all pages; shared by all joggers of a server.
        send: Receives the messages to the page.
    """

    def __init__(self, bus: JsonBus, *, taken: dict[str, Jogger], send: Callable[[ToPage], None]) -> None:
        self._bus = bus
        self._taken = taken
        self._send = send
        self._loop = asyncio.get_running_loop()
        # At the end the press that is held; before it those that the arm has not been told yet.
        self._presses: deque[_Press] = deque()
        self._opened: StartJog | None = None
        self._goal: GoalHandle[Any, Any] | None = None
        self._is_accepted = False
        self._task: asyncio.Task[None] | None = None
        self._publishing: asyncio.Task[None] | None = None
        self._closing: asyncio.TimerHandle | None = None

    @property
    def arm(self) -> str:
        """The arm that is jogged; empty while nothing is pressed."""
        return self._presses[-1].jog.arm if self._presses else ""

    async def begin(self, jog: StartJog) -> None:
        """Begin a press; a jog of another arm, or in the other space, ends first, after its own presses."""
        await self.release()
        opened, task = self._opened, self._task
        if opened is not None and (opened.arm, opened.space) != (jog.arm, jog.space):
            await self._executed()
            await self.rest()
        elif task is not None and task.cancelling():
            await asyncio.wait({task})
        other = self._taken.get(jog.arm)
        if other is not None and other is not self:
            if other.arm:
                self._refuse("another page jogs this arm", "wait until it stops jogging")
                return
            await other.rest()
        self._presses.append(_Press(jog=jog))
        self._send(JogStatus(arm=jog.arm))
        self._keep_open()
        if self._task is None:
            self._opened = jog
            self._taken[jog.arm] = self
            self._task = asyncio.create_task(self._perform(jog), name=f"jog {jog.arm}")

    async def go(self, velocity: tuple[float, ...]) -> None:
        """Move at this velocity for at most `WATCHDOG_S`; a velocity above the limits is refused."""
        press = self._presses[-1] if self._presses else None
        if press is None or press.is_up:
            return
        if fault := _too_fast(press.jog, velocity):
            self._refuse(fault, "")
            await self.rest()
            return
        if not any(velocity):
            # A stick in its middle: what it says next is a press of its own.
            if press.velocity:
                press.is_up = True
                self._presses.append(_Press(jog=press.jog))
                await self._publish_presses()
            return
        press.velocity, press.heard_s = velocity, self._loop.time()
        await self._publish_presses()

    async def release(self) -> None:
        """End the press: the arm comes to rest once it has moved, and the jog stays open for the next press."""
        press = self._presses[-1] if self._presses else None
        if press is None or press.is_up:
            return
        press.is_up, press.heard_s = True, self._loop.time()
        if not self._is_accepted:
            self._loop.call_later(MOST_WAIT_S + _LATE_S, self._drop_old_presses)
        await self._publish_presses()
        self._send(JogStatus(arm=""))
        self._keep_open()

    async def rest(self) -> None:
        """End the jog at once; return when the arm is at rest, also if the stop was requested before."""
        self._presses.clear()
        task = self._task
        if task is None:
            return
        if not task.cancelling():
            # Once only: a second cancellation would interrupt the wait for the arm to rest.
            task.cancel()
        await asyncio.wait({task})
        if self._task is task:
            # A task that was cancelled before it started has released nothing.
            self._release()

    def _drop_old_presses(self) -> None:
        """Leave the presses that the arm may not begin any more, and tell."""
        now_s = self._loop.time()
        while self._presses and self._presses[0].is_up and now_s - self._presses[0].heard_s > MOST_WAIT_S:
            if self._presses.popleft().velocity:
                self._report_dropped()

    def _report_dropped(self) -> None:
        if self._opened is not None:
            self._send(PressDropped(arm=self._opened.arm, within_s=MOST_WAIT_S))

    async def _publish_presses(self) -> None:
        """Tell the arm of the presses that it does not know yet, in their order, once it takes commands."""
        if not self._is_accepted:
            return
        self._drop_old_presses()
        try:
            while self._presses:
                press = self._presses[0]
                await self._publish_press(press)
                if not press.is_up:
                    return
                if self._presses and self._presses[0] is press:
                    self._presses.popleft()
        except FlexcellError as error:
            self._refuse(error.message, error.hint or "")
            await self.rest()

    async def _publish_press(self, press: _Press) -> None:
        silent_s = self._loop.time() - press.heard_s
        if not press.velocity or (silent_s > WATCHDOG_S and not press.is_up):
            return
        topic = f"{press.jog.arm}/jog"
        if not (press.is_up and press.is_published):
            command: dict[str, object] = {"velocity": press.velocity}
            if press.jog.space == "tool":
                command["frame"] = press.jog.frame
            if not press.is_published:
                command["least_s"] = LEAST_PRESS_S
            press.is_published = True
            await self._bus.publish(topic, command)
        if press.is_up:
            await self._bus.publish(topic, {"velocity": [0.0] * len(press.velocity), "age_s": silent_s})

    async def _executed(self) -> None:
        """Return when the arm has executed its presses, or has had the time for them."""
        goal = self._goal
        if goal is None or goal.finished:
            return
        is_idle = asyncio.Event()
        goal.on_feedback(lambda _: is_idle.set() if goal.replaceable and not self._presses else None)
        try:
            async with asyncio.timeout(MOST_WAIT_S + LEAST_PRESS_S):
                await goal.accepted()
                await is_idle.wait()
        except TimeoutError:
            self._report_dropped()
        except FlexcellError:
            # The goal itself tells why it has ended.
            return

    async def _perform(self, jog: StartJog) -> None:
        goal: dict[str, object] = {"watchdog_s": WATCHDOG_S, "idle_s": IDLE_S, "replaceable": True}
        if jog.space == "tool":
            goal["frame"] = jog.frame
        try:
            end = await self._bus.perform(f"{jog.arm}/jog_{jog.space}", goal, on_sent=self._on_sent)
            # Whatever ends a jog in which nothing is pressed is of no interest to the page.
            if self._presses and end.status is not GoalStatus.SUCCEEDED:
                self._refuse(goal_failure_text(end), "")
        except FlexcellError as error:
            self._refuse(error.message, error.hint or "")
        finally:
            self._release()

    def _on_sent(self, goal: GoalHandle[Any, Any]) -> None:
        self._goal = goal
        goal.on_accepted(self._on_accepted)
        reported = 0

        def report(feedback: object) -> None:
            nonlocal reported
            dropped = int(getattr(feedback, "dropped", 0))
            while reported < dropped:
                reported += 1
                self._report_dropped()

        goal.on_feedback(report)

    def _on_accepted(self) -> None:
        self._is_accepted = True
        self._publishing = asyncio.create_task(self._publish_presses(), name="tell the first presses")

    def _keep_open(self) -> None:
        """Let the jog stay open for `OPEN_S` from now."""
        if self._closing is not None:
            self._closing.cancel()
        self._closing = self._loop.call_later(OPEN_S, self._close)

    def _close(self) -> None:
        self._closing = None
        if self._presses:
            self._keep_open()
        elif self._task is not None and not self._task.cancelling():
            self._task.cancel()

    def _release(self) -> None:
        opened, self._opened = self._opened, None
        self._task, self._goal, self._is_accepted = None, None, False
        self._presses.clear()
        if self._closing is not None:
            self._closing.cancel()
            self._closing = None
        if opened is not None:
            self._taken.pop(opened.arm, None)
            self._send(JogStatus(arm=""))

    def _refuse(self, message: str, hint: str) -> None:
        self._send(RefusedFrame(what="jog", message=message, hint=hint))


def _too_fast(jog: StartJog, velocity: tuple[float, ...]) -> str:
    """Return the exceeded limit of jogging; empty for none."""
    if jog.space == "joints":
        limits = [MOST_JOINT_RAD_S] * len(velocity)
    else:
        limits = [MOST_M_S] * _LINEAR + [MOST_RAD_S] * _LINEAR
        if len(velocity) != _TWIST:
            return f"expected a velocity of {_TWIST} numbers, got {len(velocity)}"
    for value, limit in zip(velocity, limits, strict=True):
        if not abs(value) <= limit:
            return f"jog velocity {value:.3g} exceeds the limit of {limit:g}"
    return ""
