"""The tools of a cell document, as an arm with a tool changer needs them."""

from __future__ import annotations

from collections.abc import Mapping

from engine.document import PartSpec, ToolSpec, centre_of_mass
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses
from engine.skills.tool_changer import ChangeableTool


def changeable_tools(parts: Mapping[str, PartSpec]) -> dict[str, ChangeableTool]:
    """Return those of the parts that are tools, by name."""
    return {name: _changeable(name, part, part.tool) for name, part in parts.items() if part.tool is not None}


def _changeable(name: str, part: PartSpec, tool: ToolSpec) -> ChangeableTool:
    plate = Pose(xyz=(0.0, 0.0, part.size_m[-1] / 2.0))
    mass_kg, com_m = centre_of_mass(part.mass_kg, tool)
    return ChangeableTool(
        name=name,
        mass_kg=mass_kg,
        com_m=compose_poses(plate, Pose(xyz=com_m)).xyz,
        tcps={key: compose_poses(plate, at.pose()) for key, at in tool.tcps.items()},
        plate=plate,
    )
