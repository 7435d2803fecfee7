"""Bumpless transfer between control laws: the difference of their torques fades out."""

from __future__ import annotations

import math

import numpy as np

from robots.port import Array


class TorqueBlend:
    """Call `after` once per control period with the torques of the active law; `start` when the law changes.

    Only the part that a law adds to the common feedforward is blended: the feedforward itself may
    jump from one period to the next as the set point does.
    """

    def __init__(self, *, limit_nm: Array) -> None:
        self._limit_nm = limit_nm
        self._last = np.zeros_like(limit_nm)
        self._difference = np.zeros_like(limit_nm)
        self._duration_s = self._left_s = 0.0
        self._starting = self._given = False

    def start(self, *, duration_s: float) -> None:
        """Blend from the last added torques, if any, to those of the new law within `duration_s`."""
        self._duration_s, self._starting = duration_s, self._given

    def forget(self) -> None:
        """Reset: return the torques of the law unblended."""
        self._left_s, self._starting, self._given = 0.0, False, False

    def after(self, torque_nm: Array, *, feedforward_nm: Array, step_s: float) -> Array:
        """Return the torques to command, from those of the law and their common feedforward; all (n,)."""
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
