"""The collision reflex: the arm stops when an external force or torque exceeds its threshold (RCY 4.1)."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from engine.skills.arm_control import ControlSettings
from robots.control.arm_state import ArmState


class CollisionReflex:
    """Compares external forces with the thresholds; `reason` is empty until one is exceeded; clearing it re-arms."""

    def __init__(self, *, joints: tuple[str, ...], touching: Callable[[], str]) -> None:
        self._joints = joints
        self._touching = touching
        self._torque_nm = np.full(len(joints), np.inf)
        self._force_n = math.inf
        self._watching = False
        self.reason = ""

    def watch(self, settings: ControlSettings) -> None:
        """Set the thresholds."""
        torque, force = settings.collision_torque_nm, settings.collision_force_n
        self._torque_nm = np.array(torque) if torque else np.full(len(self._joints), np.inf)
        self._force_n = math.inf if force is None else force
        self._watching = bool(torque) or force is not None

    def trips(self, state: ArmState) -> bool:
        """Return whether a threshold is exceeded for the first time since `reason` was empty."""
        if not self._watching or self.reason:
            return False
        excess = np.abs(state.external_nm) / self._torque_nm
        worst = int(np.argmax(excess))
        x, y, z = state.wrench[:3].tolist()
        force = math.hypot(x, y, z)
        if excess[worst] > 1.0:
            felt, bound = abs(float(state.external_nm[worst])), float(self._torque_nm[worst])
            excess_nm = f"{felt:.1f} N m > {bound:g} N m on {self._joints[worst]}"
            self.reason = self._describe(f"external torque limit exceeded: {excess_nm}")
        elif force > self._force_n:
            excess_n = f"{force:.1f} N > {self._force_n:g} N at the tool"
            self.reason = self._describe(f"external force limit exceeded: {excess_n}")
        return bool(self.reason)

    def _describe(self, exceeded: str) -> str:
        contact = self._touching()
        return exceeded + (f"; {contact}" if contact else "")
