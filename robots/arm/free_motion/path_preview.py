"""Publishes the path of an arm on `<arm>/planned_path`: proposed, moving, blocked, none."""

from __future__ import annotations

from typing import Literal

import numpy as np

from engine.bus import SkillBus, Topic
from engine.messages import Vector3
from engine.skills.planning import PathPreview
from robots.arm.execution.motion_runner import MotionRunner
from robots.port import JointTrajectory

_SAMPLES = 60


class PathPreviewPublisher:
    """Publishes the path that one arm plans to follow, or follows."""

    def __init__(self, runner: MotionRunner) -> None:
        self._runner = runner
        self._topic: Topic[PathPreview] | None = None
        self._shown = PathPreview(robot=runner.name, state="none")

    def register(self, bus: SkillBus) -> None:
        """Create the topic."""
        self._topic = bus.topic(f"{self._runner.name}/planned_path", PathPreview)
        self._topic.publish(self._shown)

    def show(self, trajectory: JointTrajectory, *, state: Literal["proposed", "moving"]) -> None:
        """Publish a path."""
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
        """Mark the published path as followed, or as blocked with the reason."""
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
        """Publish that there is no path."""
        if self._shown.state != "none":
            self._publish(PathPreview(robot=self._runner.name, state="none"))

    def _publish(self, preview: PathPreview) -> None:
        self._shown = preview
        if self._topic is not None:
            self._topic.publish(preview)


def sample_trajectory(trajectory: JointTrajectory) -> tuple[tuple[float, ...], ...]:
    """Return configurations along a trajectory including both ends, radians."""
    last = len(trajectory.position_rad) - 1
    indices = np.unique(np.linspace(0, last, min(_SAMPLES, last + 1)).round().astype(int))
    return tuple(tuple(row) for row in trajectory.position_rad[indices].tolist())


def compute_tool_path(runner: MotionRunner, rows: tuple[tuple[float, ...], ...]) -> tuple[Vector3, ...]:
    """Return the positions of the tool center point at the configurations, in the world."""
    kinematics = runner.kinematics
    points: list[Vector3] = []
    for row in rows:
        x, y, z = kinematics.tool_pose(np.array(row)).xyz.tolist()
        points.append((x, y, z))
    return tuple(points)
