"""A device that takes time to turn and to come to rest, and the state that turns it."""

from __future__ import annotations

from typing import Any, ClassVar

import msgspec

from engine.bus import ActiveGoal, SkillBus
from engine.skill import Action
from engine.state import Context, Outcome, State

BRAKING_S = 0.25


class Turned(msgspec.Struct, frozen=True):
    """How long it has turned."""

    turned_s: float


class Turn(Action[Turned, Turned], frozen=True, kw_only=True):
    """Turn for a time."""

    for_s: float = 1.0


class Turntable:
    """Carries out `table/turn`; braking takes `BRAKING_S`."""

    def __init__(self, bus: SkillBus, *, holdable: bool = True) -> None:
        self._bus = bus
        self._holdable = holdable
        self._held = False
        self._moving = False
        self.goals: list[str] = []
        bus.advertise_action(Turn, self.turn, namespace="table")

    async def turn(self, goal: Turn, handle: ActiveGoal[Turned]) -> Turned:
        handle.accept()
        self._held = False
        self.goals.append(handle.id)
        if self._holdable:
            handle.on_hold(self._hold)
            handle.on_resume(self._resume)
        turned_s = 0.0
        while turned_s < goal.for_s:
            await self._bus.clock.sleep(0.125)
            turned_s += 0.0 if self._held else 0.125
        return Turned(turned_s)

    async def _hold(self) -> None:
        await self._bus.clock.sleep(BRAKING_S)
        self._held = True

    async def _resume(self) -> None:
        self._held = False


class TurnTable(State, frozen=True, kw_only=True):
    """Turn the table."""

    state_name: ClassVar[str] = "test.TurnTable"
    outcomes: ClassVar[tuple[str, ...]] = ("turned", "failed")
    success: ClassVar[tuple[str, ...]] = ("turned",)
    outputs: ClassVar[dict[str, Any]] = {"turned_s": float}
    for_s: float = 1.0

    def resources(self) -> tuple[str, ...]:
        return ("table",)

    async def run(self, ctx: Context) -> Outcome:
        end = await ctx.perform(Turn(for_s=self.for_s), to="table")
        if end.result is None or end.status != "succeeded":
            return Outcome("failed", cause=end.cause)
        return Outcome("turned", {"turned_s": end.result.turned_s})
