"""Arms of Universal Robots: Denavit-Hartenberg parameters and joint speeds; and the software of both series."""

from __future__ import annotations

import math
from dataclasses import dataclass

JOINT_RANGE_RAD = 2.0 * math.pi
"""Each joint turns twice, to either side of zero."""


@dataclass(frozen=True, slots=True)
class ArmGeometry:
    """Nominal Denavit-Hartenberg parameters and joint speeds of one arm, as its maker publishes them."""

    d1_m: float
    a2_m: float
    a3_m: float
    d4_m: float
    d5_m: float
    d6_m: float
    joint_speed_rad_s: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class ControllerSeries:
    """What differs between controllers: software version and control frequency."""

    version: tuple[int, int, int, int]
    dashboard_version: str
    cycle_hz: int


def _speeds(*degrees: int) -> tuple[float, ...]:
    return tuple(math.radians(value) for value in degrees)


ARMS = {
    "ur3": ArmGeometry(0.1519, -0.24365, -0.21325, 0.11235, 0.08535, 0.0819, _speeds(180, 180, 180, 360, 360, 360)),
    "ur5": ArmGeometry(0.089159, -0.425, -0.39225, 0.10915, 0.09465, 0.0823, _speeds(180, 180, 180, 180, 180, 180)),
    "ur10": ArmGeometry(0.1273, -0.612, -0.5723, 0.163941, 0.1157, 0.0922, _speeds(120, 120, 180, 180, 180, 180)),
    "ur3e": ArmGeometry(0.15185, -0.24355, -0.2132, 0.13105, 0.08535, 0.0921, _speeds(180, 180, 180, 360, 360, 360)),
    "ur5e": ArmGeometry(0.1625, -0.425, -0.3922, 0.1333, 0.0997, 0.0996, _speeds(180, 180, 180, 180, 180, 180)),
    "ur10e": ArmGeometry(0.1807, -0.6127, -0.57155, 0.17415, 0.11985, 0.11655, _speeds(120, 120, 180, 180, 180, 180)),
}
SERIES = {
    "cb3": ControllerSeries((3, 15, 8, 106339), "URSoftware 3.15.8.106339 (Mar 30 2022)", 125),
    "e": ControllerSeries((5, 15, 2, 1176), "URSoftware 5.15.2.1176 (Feb 20 2024)", 500),
}
