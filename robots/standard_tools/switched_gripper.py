"""A gripper with two fingers that outputs open and close: its port and what serves it."""

from __future__ import annotations

import math

from engine.errors import RobotError
from robots.gripper import GripperServer
from robots.port import GripperSample
from robots.switched.switch_motion import SwitchMotion
from robots.switched.switched_drive import SwitchedDrive
from robots.switched.switched_kind import SwitchedKind

_AT_END_M = 1e-6


class SwitchedGripperPort:
    """Implements `robots.port.GripperPort`; opening and force are those that were commanded."""

    def __init__(self, drive: SwitchedDrive) -> None:
        self._drive = drive

    @property
    def max_width_m(self) -> float:
        """Opening when fully open, of the model."""
        return self._drive.tool.max_width_m

    @property
    def max_force_n(self) -> float:
        """Grip force of the model."""
        return self._drive.tool.max_force_n

    def sample(self) -> GripperSample:
        """Return what is known; raises RobotError where the outputs are not."""
        reading = self._drive.reading()
        return GripperSample(
            time_s=reading.time_s,
            width_m=(1.0 - reading.hold_share) * self.max_width_m,
            velocity_m_s=0.0,
            force_n=self.max_force_n if reading.contact else 0.0,
            contacts=(reading.contact, reading.contact),
            evidence=reading.evidence,
        )

    def close_to(self, *, width_m: float, speed_m_s: float, force_n: float) -> SwitchMotion:
        """Open or close; speed and force are those of the gripper.

        Raises:
            RobotError: it may not be switched, is being switched, or shall stop in between.
        """
        for what, value in (("width_m", width_m), ("speed_m_s", speed_m_s), ("force_n", force_n)):
            if not math.isfinite(value) or value < 0.0 or (value == 0.0 and what != "width_m"):
                raise RobotError(f"{what} cannot be {value}", where=self._drive.name)
        if _AT_END_M < width_m < self.max_width_m - _AT_END_M:
            raise RobotError(
                f"an opening of {width_m * 1e3:.1f} mm cannot be commanded",
                where=self._drive.name,
                hint="outputs open and close this gripper fully",
            )
        return self._drive.start(holds=width_m <= _AT_END_M)


class _SwitchedGripperKind:
    """Implements `SwitchedKind` for grippers."""

    def server(self, name: str, drive: SwitchedDrive) -> GripperServer:
        """Return the server of a gripper."""
        return GripperServer(name=name, port=SwitchedGripperPort(drive))


SWITCHED_GRIPPER_KIND: SwitchedKind = _SwitchedGripperKind()
