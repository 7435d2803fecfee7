"""magnet.On: switches a magnet on and checks whether it holds a part."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.cause_chain import wrap_cause
from engine.errors import Cause
from engine.skills.part_label import PartLabel, part_label, wrong_part
from engine.state import Context, Outcome, State, goal_cause
from robots.magnet.magnet_parameter_types import MagnetName, magnet_address
from robots.magnet.magnet_skills import MagnetSwitch


class On(State, frozen=True, kw_only=True):
    """Switch a magnet on: `held` when it pulls on a part in contact with its face, else `missed`.

    `missed` also when it holds another part than `part`; a magnet that cannot name what it touches reports
    `by: current`. After `missed` it stays on. Always writes `held`; writes the pull force `pull_n` if the magnet
    measured it.
    """

    state_name: ClassVar[str] = "magnet.On"
    outcomes: ClassVar[tuple[str, ...]] = ("held", "missed", "failed")
    success: ClassVar[tuple[str, ...]] = ("held",)
    outputs: ClassVar[Mapping[str, Any]] = {"held": bool, "pull_n": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("pull_n",)}

    magnet: MagnetName
    part: PartLabel = ""

    def resources(self) -> tuple[str, ...]:
        """Return the magnet."""
        return (magnet_address(self.magnet),)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and return whether the magnet holds the part."""
        address = magnet_address(self.magnet)
        goal = MagnetSwitch(on=True)
        failure = f"the magnet of {self.magnet} does not hold {part_label(self.part)}"
        end = await ctx.perform(goal, to=address)
        if end.status != "succeeded" or end.result is None:
            cause = goal_cause(failure, goal, end, to=address, where=ctx.path, kind=self.state_name)
            return Outcome("failed", {"held": False}, cause)
        where = f"{address}/{goal.skill_name()}"
        wrong = wrong_part(self.part, end.result.part, where=where)
        held = end.result.held and wrong is None
        outputs = {"held": held, "pull_n": end.result.pull_n}
        if held:
            return Outcome("held", outputs)
        because = wrong or Cause(
            message=end.result.reason or "nothing is held and the magnet gave no reason", where=where
        )
        return Outcome("missed", outputs, wrap_cause(failure, because, where=ctx.path, kind=self.state_name))
