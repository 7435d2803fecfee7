"""States that do what a test's document tells them."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from typing import Any, ClassVar

from engine.state import Context, Outcome, State
from states.flow.decide import Decide
from states.flow.log import Log
from states.flow.set_value import SetValue
from states.flow.wait import Wait


class Give(State, frozen=True, kw_only=True):
    """End at once, or after a time, with the outcome asked for."""

    state_name: ClassVar[str] = "test.Give"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b", "c")
    success: ClassVar[tuple[str, ...]] = ("a", "b")
    outcome: str = "a"
    after_s: float = 0.0

    async def run(self, ctx: Context) -> Outcome:
        if self.after_s:
            await ctx.clock.sleep(self.after_s)
        return Outcome(self.outcome)


class Count(State, frozen=True, kw_only=True):
    """Add to a counter and say when it is full."""

    state_name: ClassVar[str] = "test.Count"
    outcomes: ClassVar[tuple[str, ...]] = ("more", "full")
    outputs: ClassVar[Mapping[str, Any]] = {"count": int}
    up_to: int = 3

    async def run(self, ctx: Context, *, count: int = 0) -> Outcome:
        return Outcome("full" if count + 1 >= self.up_to else "more", {"count": count + 1})


class Hang(State, frozen=True, kw_only=True):
    """Wait for ever; write a line when cleaned up, after a time if so told."""

    state_name: ClassVar[str] = "test.Hang"
    outcomes: ClassVar[tuple[str, ...]] = ("never",)
    cleanup_s: float = 0.0

    async def run(self, ctx: Context) -> Outcome:
        try:
            await asyncio.get_running_loop().create_future()
        finally:
            if self.cleanup_s:
                await ctx.clock.sleep(self.cleanup_s)
            ctx.log("cleaned up")
        return Outcome("never")


class Raise(State, frozen=True, kw_only=True):
    """Raise an exception, the first `times` times."""

    state_name: ClassVar[str] = "test.Raise"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    times: int = 1_000_000

    async def run(self, ctx: Context, *, raised: list[int] | None = None) -> Outcome:
        if ctx.random() < 2.0 and self.times > len(raised or []):
            raise ZeroDivisionError("division by zero")
        return Outcome("done")


class Mutate(State, frozen=True, kw_only=True):
    """Change its input in place, which must not reach the container."""

    state_name: ClassVar[str] = "test.Mutate"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context, *, items: list[int]) -> Outcome:
        items.append(99)
        return Outcome("done")


class Write(State, frozen=True, kw_only=True):
    """Write `value` to the output key."""

    state_name: ClassVar[str] = "test.Write"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    outputs: ClassVar[Mapping[str, Any]] = {"value": object}
    value: object = None
    after_s: float = 0.0
    key: str = "value"

    async def run(self, ctx: Context) -> Outcome:
        if self.after_s:
            await ctx.clock.sleep(self.after_s)
        return Outcome("done", {self.key: self.value})


class Use(State, frozen=True, kw_only=True):
    """Command a resource for a time."""

    state_name: ClassVar[str] = "test.Use"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    robot: str = "left"
    for_s: float = 1.0

    def resources(self) -> tuple[str, ...]:
        return (self.robot,)

    async def run(self, ctx: Context) -> Outcome:
        await ctx.clock.sleep(self.for_s)
        return Outcome("done")


class Stubborn(State, frozen=True, kw_only=True):
    """Take being cancelled for a reason to be done."""

    state_name: ClassVar[str] = "test.Stubborn"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        try:
            await ctx.clock.sleep(1000.0)
        except asyncio.CancelledError:
            ctx.log("ignored")
        return Outcome("done")


class Deaf(State, frozen=True, kw_only=True):
    """Never stop by itself: swallow every cancel and wait on."""

    state_name: ClassVar[str] = "test.Deaf"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    for_s: float = 1000.0

    async def run(self, ctx: Context) -> Outcome:
        due_s = ctx.clock.now_s() + self.for_s
        while ctx.clock.now_s() < due_s:
            try:
                await ctx.clock.sleep(due_s - ctx.clock.now_s())
            except asyncio.CancelledError:
                continue
        return Outcome("done")


class Messy(State, frozen=True, kw_only=True):
    """Fail in the clean-up."""

    state_name: ClassVar[str] = "test.Messy"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        try:
            await ctx.clock.sleep(1000.0)
        except asyncio.CancelledError:
            raise ZeroDivisionError("in the clean-up") from None
        return Outcome("done")


class SelfCancelling(State, frozen=True, kw_only=True):
    """Let a CancelledError out that nobody asked for."""

    state_name: ClassVar[str] = "test.SelfCancelling"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        raise asyncio.CancelledError


CATALOGUE: dict[str, type[State]] = {
    state.state_name: state
    for state in (Give, Count, Hang, Raise, Mutate, Write, Use, Stubborn, Deaf, Messy, SelfCancelling)
}
WITH_FLOW = {**CATALOGUE, **{state.state_name: state for state in (Decide, Log, SetValue, Wait)}}
"""Also what ships to hold a behavior together."""
