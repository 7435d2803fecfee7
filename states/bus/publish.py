"""bus.Publish: publishes a value on a topic of the cell."""

from __future__ import annotations

from typing import Annotated, ClassVar

from msgspec import Meta

from engine.state import Context, Outcome, State, nothing_to_undo
from states.bus.bus_parameter_types import CellTopicName


class Publish(State, frozen=True, kw_only=True):
    """Publish a value on a topic that the cell document declares under `topics`."""

    state_name: ClassVar[str] = "bus.Publish"
    outcomes: ClassVar[tuple[str, ...]] = ("published",)
    success: ClassVar[tuple[str, ...]] = ("published",)
    undo = nothing_to_undo

    topic: CellTopicName
    value: Annotated[object, Meta(description="Any value of the type of the topic, or an expression")]

    async def run(self, ctx: Context) -> Outcome:
        """Publish the value."""
        await ctx.publish(self.topic, self.value)
        return Outcome("published")
