"""Jogging for one page: an arm goes only as long as the page says so, and rests when the page is gone.

The last word is the arm's own: where nothing is heard for `WATCHDOG_S` it comes to rest, whatever happens here.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable

from editor_web.teaching.goal_failure_text import goal_failure_text
from editor_web.teaching.teaching_messages import JogStatus, RefusedFrame, StartJog
from engine.bus.action import GoalStatus
from engine.bus.json_bus import JsonBus
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
        bus: Where the arms are.
        taken: The arms that are jogged, by anybody's page; shared by all joggers of a server.
        tell: Takes what the page is to know.
    """

    def __init__(
        self, bus: JsonBus, *, taken: dict[str, Jogger], tell: Callable[[JogStatus | RefusedFrame], None]
    ) -> None:
        self._bus = bus
        self._taken = taken
        self._tell = tell
        self._jog: StartJog | None = None
        self._task: asyncio.Task[None] | None = None

    @property
    def arm(self) -> str:
        """The arm that is jogged; empty for none."""
        return self._jog.arm if self._jog is not None else ""

    async def begin(self, jog: StartJog) -> None:
        """Make ready to jog; what was jogged before comes to rest first."""
        await self.rest()
        other = self._taken.get(jog.arm)
        if other is not None:
            self._refuse("another page jogs this arm", "wait until it lets go")
            return
        self._jog = jog
        self._taken[jog.arm] = self
        self._task = asyncio.create_task(self._carry_out(jog), name=f"jog {jog.arm}")

    async def go(self, velocity: tuple[float, ...]) -> None:
        """Go at this velocity for `WATCHDOG_S` at most; one that is too fast is refused."""
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
        """Bring the arm to rest; returns when it is, also where that was asked for before."""
        task = self._task
        if task is None:
            return
        if not task.cancelling():
            # Once only: a second one would not let it wait until the arm rests.
            task.cancel()
        await asyncio.wait({task})
        if self._task is task:
            self._task = None
            # One that was cancelled before it began has let go of nothing.
            self._let_go()

    def _let_go(self) -> None:
        jog, self._jog = self._jog, None
        if jog is not None:
            self._taken.pop(jog.arm, None)
            self._tell(JogStatus(arm=""))

    def _refuse(self, message: str, hint: str) -> None:
        self._tell(RefusedFrame(what="jog", message=message, hint=hint))

    async def _carry_out(self, jog: StartJog) -> None:
        goal: dict[str, object] = {"watchdog_s": WATCHDOG_S, "idle_s": IDLE_S}
        if jog.space == "tool":
            goal["frame"] = jog.frame
        self._tell(JogStatus(arm=jog.arm))
        try:
            end = await self._bus.perform(f"{jog.arm}/jog_{jog.space}", goal)
            if end.status not in (GoalStatus.SUCCEEDED, GoalStatus.CANCELED):
                self._refuse(goal_failure_text(end), "")
        except FlexcellError as error:
            self._refuse(error.message, error.hint or "")
        finally:
            self._let_go()


def _too_fast(jog: StartJog, velocity: tuple[float, ...]) -> str:
    """Say which limit of jogging is exceeded; empty for none."""
    if jog.space == "joints":
        limits = [MOST_JOINT_RAD_S] * len(velocity)
    else:
        limits = [MOST_M_S] * _LINEAR + [MOST_RAD_S] * _LINEAR
        if len(velocity) != _TWIST:
            return f"a velocity of {len(velocity)} numbers was given where {_TWIST} are due"
    for value, limit in zip(velocity, limits, strict=True):
        if not abs(value) <= limit:
            return f"a jog goes at {limit:g} at most, not at {value:.3g}"
    return ""
