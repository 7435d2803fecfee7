"""Measured poses of everything that moves in a cell, at one instant."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

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
    """One measurement of a cell: arms and parts by name; `link(arm, link)` is a link's pose. Poses are in the world."""

    arms: Mapping[str, MeasuredArm]
    parts: Mapping[str, RigidTransform]
    link: Callable[[str, str], RigidTransform]


PoseSource = Callable[[], MeasuredPoses]
"""Measures the cell now; cheap enough for 20 Hz."""
