"""Where everything in a cell that moves is measured now, all at one instant."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from robots.model.transform import RigidTransform


@dataclass(frozen=True, kw_only=True)
class MeasuredArm:
    """One arm: its joints (radians, n) and the tool's joints by name (radians or metres)."""

    joints_rad: tuple[float, ...]
    tool_joints: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True, kw_only=True)
class MeasuredPoses:
    """One look at a cell: arms and parts by name; `link(arm, link)` is a link's pose. All poses are in the world."""

    arms: Mapping[str, MeasuredArm]
    parts: Mapping[str, RigidTransform]
    link: Callable[[str, str], RigidTransform]


PoseSource = Callable[[], MeasuredPoses]
"""Looks at the cell now; cheap enough for twenty times a second."""
