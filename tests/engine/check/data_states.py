"""States that write and read userdata and choose their outcomes by chance, so that runs take all paths."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.state import Context, Outcome, State


async def chosen(ctx: Context, outcomes: tuple[str, ...]) -> str:
    """Let a second pass and pick an outcome."""
    await ctx.clock.sleep(1.0)
    return outcomes[int(ctx.random() * len(outcomes))]


class Put(State, frozen=True, kw_only=True):
    """Write a value, or do not."""

    state_name: ClassVar[str] = "data.Put"
    outcomes: ClassVar[tuple[str, ...]] = ("done", "none")
    success: ClassVar[tuple[str, ...]] = ("done",)
    outputs: ClassVar[Mapping[str, Any]] = {"value": object}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"none": ("value",)}

    value: Annotated[object, Meta(extra_json_schema={"output": "value"})]

    async def run(self, ctx: Context) -> Outcome:
        """Write it with `done` only."""
        name = await chosen(ctx, self.outcomes)
        return Outcome(name, {"value": self.value} if name == "done" else {})


class Number(State, frozen=True, kw_only=True):
    """Read a number."""

    state_name: ClassVar[str] = "data.Number"
    outcomes: ClassVar[tuple[str, ...]] = ("low", "high")
    success: ClassVar[tuple[str, ...]] = ("high",)

    async def run(self, ctx: Context, *, x: float) -> Outcome:
        """Choose."""
        return Outcome(await chosen(ctx, self.outcomes))


class Text(State, frozen=True, kw_only=True):
    """Read text, as a parameter."""

    state_name: ClassVar[str] = "data.Text"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    success: ClassVar[tuple[str, ...]] = ("done",)

    text: str

    async def run(self, ctx: Context) -> Outcome:
        """Choose."""
        return Outcome(await chosen(ctx, self.outcomes))


class Choose(State, frozen=True, kw_only=True):
    """Read nothing."""

    state_name: ClassVar[str] = "data.Choose"
    outcomes: ClassVar[tuple[str, ...]] = ("a", "b")
    success: ClassVar[tuple[str, ...]] = ("a",)

    async def run(self, ctx: Context) -> Outcome:
        """Choose."""
        return Outcome(await chosen(ctx, self.outcomes))


CATALOGUE: dict[str, type[State]] = {state.state_name: state for state in (Put, Number, Text, Choose)}
