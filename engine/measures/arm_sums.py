"""What one arm does in a run, summed up from where it is and what presses on its tool."""

from __future__ import annotations

import math
from collections.abc import Sequence

from engine.messages.measures import Measure

ARM_MEASURES = (
    Measure(name="path_m", unit="m", reduction="sum"),
    Measure(name="joint_path_rad", unit="rad", reduction="sum"),
    Measure(name="speed_max_m_s", unit="m/s", reduction="largest"),
    Measure(name="tracking_error_max_rad", unit="rad", reduction="largest"),
    Measure(name="force_max_n", unit="N", reduction="largest"),
    Measure(name="torque_max_nm", unit="N m", reduction="largest"),
)
"""The measures of an arm, without its name."""

_NOTHING = math.nan


class ArmSums:
    """Sums up the samples of one arm, simulated or real; what it is told nothing of is NaN."""

    def __init__(self) -> None:
        self._path_m = self._speed_m_s = _NOTHING
        self._joint_path_rad = self._error_rad = _NOTHING
        self._force_n = self._torque_nm = _NOTHING
        self._xyz: Sequence[float] | None = None
        self._joints_rad: Sequence[float] | None = None

    @property
    def values(self) -> tuple[float, ...]:
        """The sums until now, in the order of `ARM_MEASURES`."""
        return (
            self._path_m,
            self._joint_path_rad,
            self._speed_m_s,
            self._error_rad,
            self._force_n,
            self._torque_nm,
        )

    def leave_tool(self) -> None:
        """Take note that the next tool centre point is no movement from the last one: it is another one."""
        self._xyz = None

    def leave(self) -> None:
        """Take note that the next sample is no movement from the last one."""
        self._xyz = self._joints_rad = None

    def move_tool(self, xyz: Sequence[float], passed_s: float) -> None:
        """Add where the tool centre point is, in the world, so long after the last time."""
        if self._xyz is None:
            length_m = 0.0
        else:
            length_m = math.dist(self._xyz, xyz)
            self._speed_m_s = _larger(self._speed_m_s, length_m / passed_s)
        self._path_m = _added(self._path_m, length_m)
        self._xyz = xyz

    def move_joints(self, position_rad: Sequence[float]) -> None:
        """Add where the joints are."""
        before = self._joints_rad
        turned_rad = math.fsum(map(abs, map(float.__sub__, position_rad, before))) if before is not None else 0.0
        self._joint_path_rad = _added(self._joint_path_rad, turned_rad)
        self._joints_rad = position_rad

    def lag(self, set_point_rad: Sequence[float], position_rad: Sequence[float]) -> None:
        """Take note of how far the joints are behind their set points."""
        self._error_rad = _larger(self._error_rad, max(map(abs, map(float.__sub__, set_point_rad, position_rad))))

    def press(self, force_n: float, torque_nm: float) -> None:
        """Take note of the amounts of force and torque on the tool."""
        self._force_n, self._torque_nm = _larger(self._force_n, force_n), _larger(self._torque_nm, torque_nm)


def _larger(value: float, other: float) -> float:
    """Return the larger one, the other one where the value is NaN: `max` keeps its first argument then."""
    return max(other, value)


def _added(value: float, more: float) -> float:
    """Return the sum, what is added where the value is NaN."""
    return more if math.isnan(value) else value + more
