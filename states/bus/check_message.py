"""bus.CheckMessage: branches on the latest message of a topic."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.errors import Cause
from engine.state import Context, Outcome, State, nothing_to_undo
from states.bus.bus_parameter_types import MessageCondition, TopicName
from states.bus.message_condition import compile_condition


class CheckMessage(State, frozen=True, kw_only=True):
    """Branch on the latest message of a topic; waits for the first one.

    In a behavior tree it is evaluated again at every message of the topic.
    """

    state_name: ClassVar[str] = "bus.CheckMessage"
    outcomes: ClassVar[tuple[str, ...]] = ("true", "false")
    success: ClassVar[tuple[str, ...]] = ("true",)
    outputs: ClassVar[Mapping[str, Any]] = {"message": dict[str, object]}
    observes: ClassVar[bool] = True
    undo = nothing_to_undo

    topic: TopicName
    condition: MessageCondition

    def __post_init__(self) -> None:
        if not self.condition.strip():
            raise ValueError("the condition is empty, so that every message would meet it")
        compile_condition(self.condition)

    async def run(self, ctx: Context) -> Outcome:
        """Return whether the latest message meets the condition."""
        message = await ctx.latest_data(self.topic)
        if compile_condition(self.condition)(message):
            return Outcome("true", {"message": message})
        because = Cause(message=f"{self.topic} is {message}", where=ctx.path, kind=self.state_name)
        return Outcome("false", {"message": message}, cause=because)
