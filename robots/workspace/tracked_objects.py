"""Tracked poses of parts and arms: small movements are ignored, so that a scene at rest stays equal."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.workspace.measured_poses import MeasuredArm, MeasuredPoses

_MOVED_M, _TURNED_RAD = 0.001, 0.00873
_JOINT_RAD = 0.002
# A moving tool is updated in steps, one at rest exactly.
_TOOL_STEP, _TOOL_EXACT = 0.004, 0.0005


class TrackedObjects:
    """Keeps the tracked `parts` (poses in the world) and `arms`; `take` returns what has moved."""

    def __init__(self) -> None:
        self.parts: dict[str, Pose] = {}
        self.arms: dict[str, MeasuredArm] = {}
        self._rigid: dict[str, RigidTransform] = {}
        self._tools: dict[str, tuple[tuple[str, float], ...]] = {}

    def take(self, measured: MeasuredPoses) -> tuple[frozenset[str], frozenset[str]]:
        """Update to the measurement; return the parts and the arms that have moved since."""
        parts = frozenset(name for name, pose in measured.parts.items() if self._update_part(name, pose))
        arms = frozenset(name for name, arm in measured.arms.items() if self._update_arm(name, arm))
        return parts, arms

    def forget(self, parts: Iterable[str]) -> None:
        """Forget parts that are no longer in the cell."""
        for name in parts:
            self._rigid.pop(name, None)
            self.parts.pop(name, None)

    def _update_part(self, name: str, pose: RigidTransform) -> bool:
        old = self._rigid.get(name)
        if old is not None and old.distance_m(pose) <= _MOVED_M and old.angle_rad(pose) <= _TURNED_RAD:
            return False
        self._rigid[name], self.parts[name] = pose, pose.to_pose("world")
        return True

    def _update_arm(self, name: str, arm: MeasuredArm) -> bool:
        old, tool_before = self.arms.get(name), self._tools.get(name)
        self._tools[name] = arm.tool_joints
        if old is None:
            self.arms[name] = arm
            return True
        moved = _largest_change(old.joints_rad, arm.joints_rad) > _JOINT_RAD
        turned = _tool_change(old.tool_joints, arm.tool_joints)
        still = tool_before is not None and _tool_change(tool_before, arm.tool_joints) <= _TOOL_EXACT / 2
        tool_moved = turned > _TOOL_STEP or (still and turned > _TOOL_EXACT)
        if not (moved or tool_moved):
            return False
        joints = arm.joints_rad if moved else old.joints_rad
        tool = arm.tool_joints if tool_moved else old.tool_joints
        self.arms[name] = replace(arm, joints_rad=joints, tool_joints=tool)
        return True


def _largest_change(old: tuple[float, ...], new: tuple[float, ...]) -> float:
    return max((abs(a - b) for a, b in zip(old, new, strict=True)), default=0.0)


def _tool_change(old: tuple[tuple[str, float], ...], new: tuple[tuple[str, float], ...]) -> float:
    return max((abs(a - b) for (_, a), (_, b) in zip(old, new, strict=True)), default=0.0)
