"""Configurations along the remaining path of a moving arm, about 0.1 m apart, and their reservation."""

from __future__ import annotations

import numpy as np

from robots.arm.execution.motion_runner import MotionRunner
from robots.model.mechanics.kinematics import ArmKinematics
from robots.port import Array, JointTrajectory
from robots.workspace.workspace import Workspace

_APART_M, _APART_RAD = 0.1, 0.25
_SAMPLE_S = 0.04
_MOST = 24


class LookaheadPath:
    """Configurations of one trajectory, each with the trajectory's own time."""

    def __init__(self, trajectory: JointTrajectory, kinematics: ArmKinematics) -> None:
        stride = max(1, round(_SAMPLE_S / trajectory.dt_s))
        last = len(trajectory.position_rad) - 1
        samples = [*range(0, last, stride), last]
        kept: list[int] = []
        tool: Array | None = None
        for sample in samples:
            joints = np.array(trajectory.position_rad[sample])
            position = kinematics.tool_pose(joints).xyz
            rotation = np.abs(joints - trajectory.position_rad[kept[-1]]).max() if kept else np.inf
            if tool is None or np.linalg.norm(position - tool) > _APART_M or rotation > _APART_RAD or sample == last:
                kept.append(sample)
                tool = position
        if len(kept) > _MOST:
            kept = [kept[i] for i in np.linspace(0, len(kept) - 1, _MOST).round().astype(int).tolist()]
        self._times_s = [sample * trajectory.dt_s for sample in kept]
        self._rows = [tuple(float(q) for q in trajectory.position_rad[sample]) for sample in kept]

    def after(self, passed_s: float) -> tuple[tuple[float, ...], ...]:
        """Return the configurations after an instant of the trajectory's own time, radians, n each."""
        return tuple(row for at, row in zip(self._times_s, self._rows, strict=True) if at > passed_s)


class PathReservation:
    """Reserves the remaining path of one motion in the shared workspace, so that other arms avoid it.

    Args:
        runner: The arm's motion runner.
        workspace: Holds the reservations.
        made: False for a motion without monitoring, which reserves nothing.
    """

    def __init__(self, runner: MotionRunner, workspace: Workspace, *, made: bool) -> None:
        self._runner = runner
        self._workspace = workspace
        self._made = made
        self._trajectory: JointTrajectory | None = None
        self._ahead: LookaheadPath | None = None
        self._rows = 0

    def renew(self, trajectory: JointTrajectory) -> None:
        """Reserve another path from the next update on."""
        self._trajectory, self._ahead = trajectory, None

    def update(self, passed_s: float) -> None:
        """Reserve the remaining path after an instant of its own time."""
        if not self._made or self._trajectory is None or not self._workspace.shared:
            return
        if self._ahead is None:
            self._ahead = LookaheadPath(self._trajectory, self._runner.kinematics)
        rows = self._ahead.after(passed_s)
        if len(rows) != self._rows:
            self._rows = len(rows)
            self._workspace.claim(self._runner.name, rows)

    def withdraw(self) -> None:
        """Release the reservation."""
        if self._rows:
            self._rows = 0
            self._workspace.claim(self._runner.name, ())
