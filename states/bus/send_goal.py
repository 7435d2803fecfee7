"""bus.SendGoal: sends a goal to any action of the bus by its address."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import msgspec

from engine.skill import NamedAction
from engine.state import Context, Outcome, State, goal_cause
from states.bus.bus_parameter_types import Fields, SkillAddress, split_address


class SendGoal(State, frozen=True, kw_only=True):
    """Send a goal to an action by its address, where no state of its own exists, and wait for its end."""

    state_name: ClassVar[str] = "bus.SendGoal"
    outcomes: ClassVar[tuple[str, ...]] = ("succeeded", "failed")
    success: ClassVar[tuple[str, ...]] = ("succeeded",)
    outputs: ClassVar[Mapping[str, Any]] = {"result": object}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("result",)}

    action: SkillAddress
    goal: Fields = {}

    def resources(self) -> tuple[str, ...]:
        """Return the namespace of the action."""
        return (split_address(self.action)[0],)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return the outcome of its end; on preemption the device comes to rest first."""
        namespace, name = split_address(self.action)
        goal = NamedAction(name=name, fields=self.goal)
        end = await ctx.perform(goal, to=namespace)
        if end.status == "succeeded":
            return Outcome("succeeded", {"result": msgspec.to_builtins(end.result)})
        what = f"{self.action} did not succeed"
        return Outcome("failed", cause=goal_cause(what, goal, end, to=namespace, where=ctx.path, kind=self.state_name))
