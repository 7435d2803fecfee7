"""Jogging for one page: an arm moves only while the page sends velocities, and stops when the page disconnects.

The arm has its own watchdog: without a velocity for `WATCHDOG_S` it comes to rest, independent of this module.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from editor_web.teaching.goal_failure_text import goal_failure_text
from editor_web.teaching.teaching_messages import JogStatus, RefusedFrame, StartJog
from engine.bus import GoalStatus, JsonBus
from engine.errors import FlexcellError

WATCHDOG_S = 0.12
"""Three times the period at which a page repeats its velocity."""
IDLE_S = 1.0
MOST_M_S, MOST_RAD_S, MOST_JOINT_RAD_S = 0.25, 1.0, 1.0
_LINEAR = 3
_TWIST = 6


class Jogger:
    """Jogs at most one arm.

    Args:
        bus: The bus of the arms.
        taken: The jogged arms of all pages; shared by all joggers of a server.
        send: Receives the messages to the page.
    """

    def __init__(
        self, bus: JsonBus, *, taken: dict[str, Jogger], send: Callable[[JogStatus | RefusedFrame], None]
    ) -> None:
        self._bus = bus
        self._taken = taken
        self._send = send
        self._jog: StartJog | None = None
        self._task: asyncio.Task[None] | None = None

    @property
    def arm(self) -> str:
        """The jogged arm; empty for none."""
        return self._jog.arm if self._jog is not None else ""

    async def begin(self, jog: StartJog) -> None:
        """Prepare to jog an arm; the previously jogged arm comes to rest first."""
        await self.rest()
        other = self._taken.get(jog.arm)
        if other is not None:
            self._refuse("another page jogs this arm", "wait until it stops jogging")
            return
        self._jog = jog
        self._taken[jog.arm] = self
        self._task = asyncio.create_task(self._perform(jog), name=f"jog {jog.arm}")

    async def go(self, velocity: tuple[float, ...]) -> None:
        """Move at this velocity for at most `WATCHDOG_S`; a velocity above the limits is refused."""
        jog = self._jog
        if jog is None:
            return
        if fault := _too_fast(jog, velocity):
            self._refuse(fault, "")
            await self.rest()
            return
        try:
            await self._bus.publish(f"{jog.arm}/jog", {"velocity": velocity})
        except FlexcellError as error:
            self._refuse(error.message, error.hint or "")
            await self.rest()

    async def rest(self) -> None:
        """Bring the arm to rest; return when it is at rest, also if the stop was requested before."""
        task = self._task
        if task is None:
            return
        if not task.cancelling():
            # Once only: a second cancellation would interrupt the wait for the arm to rest.
            task.cancel()
        await asyncio.wait({task})
        if self._task is task:
            self._task = None
            # A task that was cancelled before it started has released nothing.
            self._release()

    def _release(self) -> None:
        jog, self._jog = self._jog, None
        if jog is not None:
            self._taken.pop(jog.arm, None)
            self._send(JogStatus(arm=""))

    def _refuse(self, message: str, hint: str) -> None:
        self._send(RefusedFrame(what="jog", message=message, hint=hint))

    async def _perform(self, jog: StartJog) -> None:
        goal: dict[str, object] = {"watchdog_s": WATCHDOG_S, "idle_s": IDLE_S}
        if jog.space == "tool":
            goal["frame"] = jog.frame
        self._send(JogStatus(arm=jog.arm))
        try:
            end = await self._bus.perform(f"{jog.arm}/jog_{jog.space}", goal)
            if end.status not in (GoalStatus.SUCCEEDED, GoalStatus.CANCELED):
                self._refuse(goal_failure_text(end), "")
        except FlexcellError as error:
            self._refuse(error.message, error.hint or "")
        finally:
            self._release()


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
