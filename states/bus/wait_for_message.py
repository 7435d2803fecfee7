"""bus.WaitForMessage: waits until a topic has a message that meets a condition."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.errors import Cause
from engine.state import Context, Outcome, State, nothing_to_undo
from states.bus.bus_parameter_types import MessageCondition, TopicName
from states.bus.message_condition import compile_condition
from states.time_limit import LongestWait, ended_within


class WaitForMessage(State, frozen=True, kw_only=True):
    """Wait for the next message of a topic that meets a condition; no message is missed while it waits.

    In a branch of a concurrency container beside other work, it ends that work where the condition of the container
    names its outcome.
    """

    state_name: ClassVar[str] = "bus.WaitForMessage"
    outcomes: ClassVar[tuple[str, ...]] = ("received", "timeout")
    success: ClassVar[tuple[str, ...]] = ("received",)
    outputs: ClassVar[Mapping[str, Any]] = {"message": dict[str, object]}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"timeout": ("message",)}
    undo = nothing_to_undo

    topic: TopicName
    condition: MessageCondition = ""
    timeout_s: LongestWait | None = None
    accept_latest: Annotated[
        bool, Meta(description="Whether a message from before the state was entered may meet the condition")
    ] = False

    def __post_init__(self) -> None:
        compile_condition(self.condition)

    async def run(self, ctx: Context) -> Outcome:
        """Return the message, or the timeout."""
        try:
            received = await ended_within(ctx, self._message(ctx), self.timeout_s)
        except TimeoutError:
            return self._timeout(ctx)
        return Outcome("received", {"message": received})

    def _timeout(self, ctx: Context) -> Outcome:
        matching = f" with {self.condition}" if self.condition else ""
        message = f"{self.topic} had no message{matching} within {self.timeout_s:g} s"
        return Outcome("timeout", cause=Cause(message=message, where=ctx.path, kind=self.state_name))

    async def _message(self, ctx: Context) -> object:
        met = compile_condition(self.condition)
        if self.accept_latest:
            latest = await ctx.latest_data(self.topic)
            if met(latest):
                return latest
        return await ctx.next_data(self.topic, met)
