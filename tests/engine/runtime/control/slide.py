"""A slide that moves at 1 m/s and remembers where, and the states that move it; one of them knows the way back."""

from __future__ import annotations

import asyncio
from typing import Any, ClassVar

import msgspec

from engine.bus import ActiveGoal, SkillBus
from engine.errors import SkillFailed
from engine.skill import Action
from engine.state import ActivationRecord, Context, Outcome, State

_STEP_S = 0.125


class Slid(msgspec.Struct, frozen=True):
    """From where to where it has moved."""

    start_m: float
    end_m: float


class SlideTo(Action[Slid, Slid], frozen=True, kw_only=True):
    """Move to a position."""

    to_m: float


class Slide:
    """Carries out `slide/slide_to`; jams on the way to a position in `jams`."""

    def __init__(self, bus: SkillBus, *, at_m: float = 0.0) -> None:
        self._bus = bus
        self._held = False
        self.at_m = at_m
        self.goals: list[float] = []
        self.jams: set[float] = set()
        bus.advertise_action(SlideTo, self.slide, namespace="slide")

    async def slide(self, goal: SlideTo, handle: ActiveGoal[Slid]) -> Slid:
        handle.accept()
        handle.on_hold(self._hold)
        handle.on_resume(self._resume)
        self._held = False
        self.goals.append(goal.to_m)
        start_m = self.at_m
        try:
            while self.at_m != goal.to_m:
                await self._bus.clock.sleep(_STEP_S)
                if goal.to_m in self.jams:
                    raise SkillFailed("it is jammed", where="slide")
                if not self._held:
                    left_m = goal.to_m - self.at_m
                    self.at_m += max(-_STEP_S, min(_STEP_S, left_m))
        except asyncio.CancelledError:
            pass
        return Slid(start_m, self.at_m)

    async def _hold(self) -> None:
        self._held = True

    async def _resume(self) -> None:
        self._held = False


class MoveSlide(State, frozen=True, kw_only=True):
    """Move the slide, and back to where it was."""

    state_name: ClassVar[str] = "test.MoveSlide"
    outcomes: ClassVar[tuple[str, ...]] = ("there", "failed")
    success: ClassVar[tuple[str, ...]] = ("there",)
    outputs: ClassVar[dict[str, Any]] = {"at_m": float}
    to_m: float = 1.0

    def resources(self) -> tuple[str, ...]:
        return ("slide",)

    async def run(self, ctx: Context) -> Outcome:
        end = await ctx.perform(SlideTo(to_m=self.to_m), to="slide")
        if end.result is None or end.status != "succeeded":
            return Outcome("failed", cause=end.cause)
        return Outcome("there", {"at_m": end.result.end_m})

    def cannot_undo(self, done: ActivationRecord) -> str:
        known = all(goal.result is not None for goal in done.requests)
        return "" if known else "where the slide was is not known"

    async def undo(self, ctx: Context, done: ActivationRecord) -> None:
        for goal in reversed(done.requests):
            start_m = msgspec.convert(goal.result, Slid).start_m
            end = await ctx.perform(SlideTo(to_m=start_m), to="slide")
            if end.status != "succeeded":
                raise SkillFailed(f"the slide did not get back to {start_m:g} m", where=ctx.path)


class PushSlide(State, frozen=True, kw_only=True):
    """Move the slide, and nobody knows how to take that back."""

    state_name: ClassVar[str] = "test.PushSlide"
    outcomes: ClassVar[tuple[str, ...]] = ("there",)
    to_m: float = 1.0

    def resources(self) -> tuple[str, ...]:
        return ("slide",)

    async def run(self, ctx: Context) -> Outcome:
        await ctx.perform(SlideTo(to_m=self.to_m), to="slide")
        return Outcome("there")
