"""Measured poses of everything that moves in a cell, at one instant."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from robots.model.transform import RigidTransform


@dataclass(frozen=True, kw_only=True)
class MeasuredArm:
    """One arm: its joints (radians, n), the tool's joints by name (radians or meters), and the part in the tool.

    `holds` is the name of the part, by contact, or as the world lets it follow a tool with a driver; empty for none.
    """

    joints_rad: tuple[float, ...]
    tool_joints: tuple[tuple[str, float], ...] = ()
    holds: str = ""


@dataclass(frozen=True, kw_only=True)
class MeasuredPoses:
    """One measurement of a cell: arms and parts by name; `link(arm, link)` is a link's pose. Poses are in the world.

    `joined` are the parts and fixtures to which something is joined, by name.
    """

    arms: Mapping[str, MeasuredArm]
    parts: Mapping[str, RigidTransform]
    link: Callable[[str, str], RigidTransform]
    joined: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])

    def joined_parts(self, part: str) -> frozenset[str]:
        """Return the parts that are joined to a part, also by others between them."""
        found, new = {part}, {part}
        while new:
            new = {other for name in new for other in self.joined.get(name, ()) if other in self.parts} - found
            found |= new
        return frozenset(found - {part})


PoseSource = Callable[[], MeasuredPoses]
"""Measures the cell now; cheap enough for 20 Hz."""
