"""The reference frames for poses of one arm: the world, the arm's base, and the named frames of the cell."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from engine.errors import RobotError
from engine.messages import Pose
from engine.wording import did_you_mean
from robots.model.arm_base import ArmBase
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.scene.sim_scene import LOOSE_HINT

WORLD = "world"
# Beyond any cell; larger values may overflow in calculations.
_FARTHEST_M = 1e6


class ToolFrames:
    """Converts poses of messages to transforms in the world.

    Args:
        arm: Name of the arm on the bus.
        base_link: Base link of its model; the base frame is named `<arm>/<base_link>`.
        base: Pose of the base in the world.
        named: Poses of the frames of the cell in the world; looked up at each use, as modules come and go.
    """

    def __init__(
        self, *, arm: str, base_link: str, base: RigidTransform | ArmBase, named: Mapping[str, Pose] | None = None
    ) -> None:
        self._arm = arm
        self.base_frame = f"{arm}/{base_link}"
        self._base = ArmBase.of(base)
        self._named: Mapping[str, Pose] = named if named is not None else {}
        self.loose = False
        """True while the base may move: then only poses in its own frame can be reached."""

    @property
    def base(self) -> RigidTransform:
        """Pose of the base in the world now."""
        return self._base.pose

    def axes(self, frame: str, *, tool: RigidTransform) -> Array:
        """Return the axes of `world`, `base` or `tool` in the world as columns, (3, 3); `tool` is the tool's pose."""
        if frame == "tool":
            return tool.rotation
        return self.base.rotation if frame == "base" else np.eye(3)

    def to_world(self, pose: Pose) -> RigidTransform:
        """Return the pose in the world.

        Raises:
            RobotError: the frame is unknown, the numbers are not a pose, or the base is loose and the frame is not its.
        """
        try:
            given = RigidTransform.from_pose(pose)
        except ValueError as error:
            raise RobotError(str(error), where=self._arm, hint="xyzw is a unit quaternion") from error
        farthest = max(map(abs, pose.xyz))
        if farthest > _FARTHEST_M:
            raise RobotError(
                f"a coordinate of {farthest:.3g} m is out of reach", where=self._arm, hint="xyz is in meters"
            )
        if pose.frame == self.base_frame:
            return self.base.then(given)
        if self.loose:
            raise RobotError(
                f"the base of {self._arm} is released, and the frame {pose.frame} is not on it",
                where=self._arm,
                hint=LOOSE_HINT,
            )
        if pose.frame == WORLD:
            return given
        if pose.frame in self._named:
            return RigidTransform.from_pose(self._named[pose.frame]).then(given)
        raise RobotError(
            f"the frame {pose.frame!r} is not known to this arm",
            where=self._arm,
            hint=did_you_mean(pose.frame, (WORLD, self.base_frame, *self._named)),
        )
