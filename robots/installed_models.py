"""The built-in models and planners: the entry point `standard` of `flexcell.models`."""

from __future__ import annotations

from engine.cell import RobotModels, RobotSummary, ToolKind
from engine.document import Cell
from engine.skills.arm_target import StaticCell
from robots.model.mechanics.link_names import link_names
from robots.model.registry import model_of_entry, robot_names, tool_names
from robots.model.tool_model import MagnetModel, SynergyModel, ToolModel
from robots.planning.planner_names import PLANNERS


class InstalledModels:
    """The built-in model folders and those that a cell references by path."""

    def robots(self) -> tuple[str, ...]:
        """Return the names of the built-in arms."""
        return robot_names()

    def tools(self) -> tuple[str, ...]:
        """Return the names of the built-in tools."""
        return tool_names()

    def planners(self) -> tuple[str, ...]:
        """Return the names of the motion planners."""
        return PLANNERS

    def summary(self, cell: Cell, robot: str) -> RobotSummary:
        """Return the capabilities of a robot of the cell; raises CellError or DocumentError for an invalid model."""
        model = model_of_entry(cell.document.robots[robot], cell.resolve)
        return RobotSummary(
            base_link=model.base_link,
            links=link_names(model),
            joints=tuple(zip(model.limits.lower_rad, model.limits.upper_rad, strict=True)),
            tool=_kind(model.tool),
            digital_outputs=model.digital_outputs,
        )

    def drawn(self, cell: Cell) -> StaticCell:
        """Return the static cell, in which targets of the arms are checked for reachability."""
        # A check without targets needs no collision library.
        from robots.planning.search.reachability import ReachabilityChecker

        return ReachabilityChecker(cell)


def _kind(tool: ToolModel | None) -> ToolKind | None:
    if tool is None:
        return None
    if isinstance(tool.mechanism, MagnetModel):
        return "magnet"
    return "hand" if isinstance(tool.mechanism, SynergyModel) else "gripper"


MODELS: RobotModels = InstalledModels()
