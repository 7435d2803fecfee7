"""No bump when a control law takes over from another: the difference of their torques fades out."""

from __future__ import annotations

import math

import numpy as np

from robots.port import Array


class TorqueBlend:
    """Call `after` once per control period with the torques of the law in force; `start` when that changes.

    Only what a law adds to the feedforward that all laws have in common is blended: that one may
    change from one period to the next as the set point does.
    """

    def __init__(self, *, limit_nm: Array) -> None:
        self._limit_nm = limit_nm
        self._last = np.zeros_like(limit_nm)
        self._difference = np.zeros_like(limit_nm)
        self._duration_s = self._left_s = 0.0
        self._starting = self._given = False

    def start(self, *, duration_s: float) -> None:
        """Go on from what was added last, if anything was, and be at what the new law adds after `duration_s`."""
        self._duration_s, self._starting = duration_s, self._given

    def forget(self) -> None:
        """Give the torques of the law as they are from now on, as if none had been given before."""
        self._left_s, self._starting, self._given = 0.0, False, False

    def after(self, torque_nm: Array, *, feedforward_nm: Array, step_s: float) -> Array:
        """Return the torques to command, for those of the law and what of them all laws have in common; all (n,)."""
        if self._starting:
            self._difference = self._last - (torque_nm - feedforward_nm)
            self._left_s, self._starting = self._duration_s, False
        if self._left_s > 0.0:
            fade = 0.5 - 0.5 * math.cos(math.pi * self._left_s / self._duration_s)
            torque_nm = np.minimum(np.maximum(torque_nm + fade * self._difference, -self._limit_nm), self._limit_nm)
            self._left_s = max(0.0, self._left_s - step_s)
        np.subtract(torque_nm, feedforward_nm, out=self._last)
        self._given = True
        return torque_nm
