"""The measures of a simulated world, kept up to date after every step at little cost."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from robots.control.arm_control_loop import ArmControlLoop
from robots.port import Array
from robots.sim.grip.mechanics import ToolMechanics
from robots.sim.grip.tool_summary import tool_summary
from robots.sim.measures.arm_measures import ArmMeasures
from robots.sim.measures.clearance_measures import ClearanceMeasures
from robots.sim.measures.contact_measures import ContactMeasures
from robots.sim.measures.measure_layout import MeasureLayout
from robots.sim.measures.tool_measures import ToolMeasures
from robots.sim.physics.cell_model import CellModel
from robots.sim.physics.physics import Physics

# Path, speed and lag of arms, and contacts that last; forces on tools and new contacts are those of every step.
_SAMPLE_S = 0.025
# Grips of tools that touch a part.
_GRIP_S = 0.1
_BLOCK_SAMPLES = 20


@dataclass(frozen=True, kw_only=True)
class LoopArm:
    """An arm of the loop, as its measures need it."""

    control: ArmControlLoop
    tool_xyz: Callable[[], Array]
    """Returns the tool centre point in the world at the start of the last step, (3,)."""
    tool_link: int
    """The body of its tool link."""
    beyond_flange: frozenset[int]
    """The bodies of its tool."""


class RunMeasures:
    """Reads the state of the world and changes nothing of it: with it, every step has the same bits.

    Args:
        cell: The world.
        physics: Its physics.
        arms: Its arms.
        tools: The tools of those that have one.
        locks: What tells whether the lock of a tool changer moves, for those that have one.
        step_s: Duration of a step.
    """

    def __init__(
        self,
        cell: CellModel,
        physics: Physics,
        *,
        arms: Mapping[str, LoopArm],
        tools: Mapping[str, ToolMechanics],
        locks: Mapping[str, Callable[[], bool]],
        step_s: float,
    ) -> None:
        summaries = {arm.name: tool_summary(arm.model.tool) for arm in cell.arms}
        self.layout = layout = MeasureLayout(
            {name: summary.kind if summary is not None else None for name, summary in summaries.items()}
        )
        self.summed_up = self._values = layout.new_values()
        """The values as of the last block, contacts and approaches as of their ends; always the same array."""
        self._physics = physics
        self._step_s = step_s
        self._sample_steps = max(1, round(_SAMPLE_S / step_s))
        self._grip_steps = max(1, round(_GRIP_S / step_s))
        self._block_steps = self._sample_steps * _BLOCK_SAMPLES
        self._row = 0
        self._contact_count = 0
        self._arms = [
            ArmMeasures(
                self._values[layout.arms[name]],
                control=arm.control,
                tool_xyz=arm.tool_xyz,
                steps=self._block_steps,
                sample_s=self._sample_steps * step_s,
            )
            for name, arm in arms.items()
        ]
        self._watches = [(layout.jumps[name], arm.control.watch) for name, arm in arms.items()]
        self._wrenches = [(arm.wrenches, arm.wrench) for arm in self._arms]
        self._tools = {
            name: ToolMeasures(
                self._values[layout.tools[name]],
                mechanics=tool,
                summary=summary,
                body=arms[name].tool_link,
                names=cell.body_names,
                parts=cell.parts,
                physics=physics,
            )
            for name, tool in tools.items()
            if (summary := summaries[name]) is not None
        }
        self._contacts = ContactMeasures(
            self._values[layout.contacts],
            cell=cell,
            physics=physics,
            beyond_flange={name: arm.beyond_flange for name, arm in arms.items()},
            moving={**locks, **{name: _moving(tool) for name, tool in tools.items()}},
            step_s=step_s,
        )
        self._clearance = ClearanceMeasures(
            self._values,
            arms=layout.clearances,
            cell_value=layout.cell_clearance,
            cell=cell,
            physics=physics,
            step_s=step_s,
        )

    def step(self, step: int) -> None:
        """Take note of the step just done, which has this number."""
        row = self._row
        for wrenches, wrench in self._wrenches:
            wrenches[row] = wrench
        self._row = row + 1
        contacts, count = self._contacts, self._physics.contact_count
        sampled = not step % self._sample_steps
        if sampled or contacts.pressing or count != self._contact_count:
            self._contact_count = count
            contacts.look(step)
            if contacts.touched:
                # A touch is no clearance, however short it was.
                self._clearance.due = step
        if sampled:
            for arm in self._arms:
                arm.sample()
        if step >= self._clearance.due:
            self._clearance.look(step, contacts.grasps)
        if not step % self._grip_steps:
            self._look_at_grips(step)
        if self._row == self._block_steps:
            self._reduce()

    def values(self) -> Array:
        """Return the values until now, (`layout.size`,)."""
        self._reduce()
        values = self._values.copy()
        values[self.layout.contacts] = self._contacts.totals()
        for place, clearance_m in self._clearance.totals().items():
            values[place] = clearance_m
        return values

    def restart(self, step: int) -> None:
        """Begin again after the world has jumped to another state at this step."""
        self._values[:] = self.layout.new_values()
        self._row = 0
        for arm in self._arms:
            arm.restart()
        for _, watch in self._watches:
            watch.count = 0
        for tool in self._tools.values():
            tool.let_go()
        self._contacts.restart(step)
        self._clearance.restart(step)

    def _look_at_grips(self, step: int) -> None:
        handled = self._contacts.handled
        for name, tool in self._tools.items():
            if name in handled:
                tool.look(step * self._step_s)
            else:
                tool.let_go()

    def _reduce(self) -> None:
        for arm in self._arms:
            arm.reduce(self._row)
        for place, watch in self._watches:
            self._values[place] = watch.count
        self._row = 0


def _moving(tool: ToolMechanics) -> Callable[[], bool]:
    return lambda: tool.drive.number != 0
