"""Shows the way of an arm on `<arm>/planned_path`: proposed, under way, blocked, none."""

from __future__ import annotations

from typing import Literal

import numpy as np

from engine.bus import SkillBus
from engine.bus.topic import Topic
from engine.messages import Vector3
from engine.skills.planning import PathPreview
from robots.arm.motion_runner import MotionRunner
from robots.port import JointTrajectory

_SHOWN = 60


class PathPreviewPublisher:
    """Publishes what one arm is about to go, or goes."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner
        self._topic: Topic[PathPreview] | None = None
        self._shown = PathPreview(robot=runner.name, state="none")

    def register(self, bus: SkillBus) -> None:
        """Make the topic."""
        self._topic = bus.topic(f"{self._runner.name}/planned_path", PathPreview)
        self._topic.publish(self._shown)

    def show(self, trajectory: JointTrajectory, *, state: Literal["proposed", "moving"]) -> None:
        """Show a way."""
        rows = sample_trajectory(trajectory)
        self._publish(
            PathPreview(
                robot=self._runner.name,
                state=state,
                joint_names=self._runner.model.arm_joints,
                joints=rows,
                tool_path=compute_tool_path(self._runner, rows),
            )
        )

    def mark(self, state: Literal["moving", "blocked"], reason: str = "") -> None:
        """Say of the way that is shown that the arm goes it, or cannot for now."""
        shown = self._shown
        if shown.state != "none" and (shown.state, shown.reason) != (state, reason):
            self._publish(
                PathPreview(
                    robot=shown.robot,
                    state=state,
                    joint_names=shown.joint_names,
                    joints=shown.joints,
                    tool_path=shown.tool_path,
                    reason=reason,
                )
            )

    def clear(self) -> None:
        """Show none."""
        if self._shown.state != "none":
            self._publish(PathPreview(robot=self._runner.name, state="none"))

    def _publish(self, preview: PathPreview) -> None:
        self._shown = preview
        if self._topic is not None:
            self._topic.publish(preview)


def sample_trajectory(trajectory: JointTrajectory) -> tuple[tuple[float, ...], ...]:
    """Return configurations along a trajectory, both ends among them, radians."""
    last = len(trajectory.position_rad) - 1
    picked = np.unique(np.linspace(0, last, min(_SHOWN, last + 1)).round().astype(int))
    return tuple(tuple(row) for row in trajectory.position_rad[picked].tolist())


def compute_tool_path(runner: MotionRunner, rows: tuple[tuple[float, ...], ...]) -> tuple[Vector3, ...]:
    """Return the tool centre points of configurations, in the world."""
    kinematics = runner.kinematics
    points: list[Vector3] = []
    for row in rows:
        x, y, z = kinematics.tool_pose(np.array(row)).xyz.tolist()
        points.append((x, y, z))
    return tuple(points)
