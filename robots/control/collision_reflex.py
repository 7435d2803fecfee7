"""When an arm stops by itself: something pulls at it harder than it was told to bear (RCY 4.1)."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from robots.control.arm_state import ArmState
from robots.port import ArmSettings


class CollisionReflex:
    """Compares what is felt with the thresholds; `reason` is empty until one was exceeded, and may be cleared."""

    def __init__(self, *, joints: tuple[str, ...], touching: Callable[[], str]) -> None:
        self._joints = joints
        self._touching = touching
        self._torque_nm = np.full(len(joints), np.inf)
        self._force_n = math.inf
        self._watching = False
        self.reason = ""

    def watch(self, settings: ArmSettings) -> None:
        """Take the thresholds."""
        torque, force = settings.collision_torque_nm, settings.collision_force_n
        self._torque_nm = np.array(torque) if torque else np.full(len(self._joints), np.inf)
        self._force_n = math.inf if force is None else force
        self._watching = bool(torque) or force is not None

    def trips(self, state: ArmState) -> bool:
        """Tell whether a threshold is exceeded for the first time since `reason` was empty."""
        if not self._watching or self.reason:
            return False
        excess = np.abs(state.external_nm) / self._torque_nm
        worst = int(np.argmax(excess))
        x, y, z = state.wrench[:3].tolist()
        force = math.hypot(x, y, z)
        if excess[worst] > 1.0:
            felt, bound = abs(float(state.external_nm[worst])), float(self._torque_nm[worst])
            self.reason = self._words(f"{self._joints[worst]} feels {felt:.1f} N m", f"{bound:g} N m")
        elif force > self._force_n:
            self.reason = self._words(f"the tool feels {force:.1f} N", f"{self._force_n:g} N")
        return bool(self.reason)

    def _words(self, felt: str, threshold: str) -> str:
        contact = self._touching()
        return f"{felt} from outside, its threshold is {threshold}" + (f"; {contact}" if contact else "")
