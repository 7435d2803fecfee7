"""What the process of the simulated robots is started with, and what it reports; JSON, one object a line."""

from __future__ import annotations

import msgspec

from engine.messages import Pose, Vector3
from robots.scene.sim_scene import SimScene

Quaternion = tuple[float, float, float, float]


class RobotSetup(msgspec.Struct, frozen=True, kw_only=True):
    """One robot: its address, where its base is, and its joints at the start; empty for those of franky-sim."""

    host: str
    base: Pose = Pose(xyz=(0.0, 0.0, 0.0))
    start_rad: tuple[float, ...] = ()


class SimulatorSetup(msgspec.Struct, frozen=True, kw_only=True):
    """The robots, and the fixtures and parts around them; without a scene one robot with a box between its fingers."""

    robots: tuple[RobotSetup, ...]
    scene: SimScene | None = None


class RobotReport(msgspec.Struct, frozen=True, kw_only=True):
    """Where one robot is; `touched` are the parts that its fingers touch."""

    position_rad: tuple[float, ...]
    fastest_rad_s: float
    """Speed of the fastest joint."""
    width_m: float
    touched: tuple[str, ...] = ()


class PartReport(msgspec.Struct, frozen=True, kw_only=True):
    """Where a part is."""

    xyz: Vector3
    xyzw: Quaternion


class SimulatorReport(msgspec.Struct, frozen=True, kw_only=True):
    """The state of the simulator; `late_s` is by how much its time is behind real time since its start."""

    time_s: float
    late_s: float
    robots: tuple[RobotReport, ...]
    parts: dict[str, PartReport] = {}
