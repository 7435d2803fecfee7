"""The last set point that a real arm was sent: the next one is no farther than its joints can go until then."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from robots.drivers.arm.joint_controller import MotionRefused
from robots.port import Array

# A set point may be this much farther: rounding, not a jump.
_ROUNDING_RAD, _ROUNDING_SHARE = 2e-3, 1.1


class SentSetPoint:
    """Belongs to the control loop of one arm.

    Args:
        joints: Their names.
        fastest_rad_s: Their speed limits, (n,).
    """

    def __init__(self, joints: Sequence[str], fastest_rad_s: Sequence[float]) -> None:
        self._joints = joints
        self._fastest_rad_s = np.array(fastest_rad_s)
        self._sent_rad: Array | None = None

    def forget(self) -> None:
        """Take the next set point as it is: motion begins there."""
        self._sent_rad = None

    def note(self, position_rad: Array) -> None:
        """Note that this one, (n,), was sent."""
        self._sent_rad = position_rad.copy()

    def require_next(self, position_rad: Array, *, step_s: float) -> None:
        """Require that a joint can be there, (n,), `step_s` after the last one.

        Raises:
            MotionRefused: no motion leads there; names the joint.
        """
        if self._sent_rad is None:
            return
        most_rad = _ROUNDING_SHARE * self._fastest_rad_s * step_s + _ROUNDING_RAD
        off_rad = np.abs(position_rad - self._sent_rad)
        joint = int((off_rad - most_rad).argmax())
        if not off_rad[joint] <= most_rad[joint]:
            raise MotionRefused(
                f"the next set point of {self._joints[joint]} is {off_rad[joint]:.3g} rad away from the last",
                hint="it was not sent; report it with the log, look at the arm, then enable motion",
            )
