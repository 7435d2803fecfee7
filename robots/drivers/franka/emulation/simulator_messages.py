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
    report_steps: int = 50
    """A report is written after so many steps of a millisecond."""


class RobotReport(msgspec.Struct, frozen=True, kw_only=True):
    """Where one robot is; `touched` are the parts that its fingers touch."""

    position_rad: tuple[float, ...]
    fastest_rad_s: float
    """Speed of the fastest joint."""
    width_m: float
    touched: tuple[str, ...] = ()


class SimulatorInput(msgspec.Struct, frozen=True, kw_only=True):
    """What is changed in it: the width of the box, 0 for none, and parts that another world keeps, or frees by None."""

    object_m: float | None = None
    parts: dict[str, Pose | None] = {}


class FrankaCellSetup(msgspec.Struct, frozen=True, kw_only=True):
    """What the process of the cabinets of a cell is started with: their addresses by arm, and the cell."""

    hosts: dict[str, str]
    scene: SimScene
    report_steps: int


class FrankaCellReady(msgspec.Struct, frozen=True, kw_only=True):
    """The first line of that process: where the cabinets listen, by arm, or why they do not."""

    places: dict[str, dict[str, str | int]] = {}
    refused: str = ""
    hint: str = ""
    number: int | None = None
    """Of the error of the operating system, where it is one."""


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
