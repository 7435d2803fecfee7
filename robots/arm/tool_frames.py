"""The frames in which one arm's poses may be given: the world and the arm's base."""

from __future__ import annotations

from engine.errors import RobotError
from engine.messages import Pose
from robots.model.rigid import Rigid

WORLD = "world"


class ToolFrames:
    """Converts poses between messages and world numbers.

    Args:
        arm: Name of the arm on the bus.
        base_link: Base link of its model; the base frame is named `<arm>/<base_link>`.
        base: Pose of the base in the world.
    """

    def __init__(self, *, arm: str, base_link: str, base: Rigid) -> None:
        self._arm = arm
        self.base_frame = f"{arm}/{base_link}"
        self.base = base

    def to_world(self, pose: Pose) -> Rigid:
        """Return the pose in the world.

        Raises:
            RobotError: its frame is not known here, or its numbers are not a pose.
        """
        try:
            given = Rigid.from_pose(pose)
        except ValueError as error:
            raise RobotError(str(error), where=self._arm, hint="xyzw is a unit quaternion") from error
        if pose.frame == WORLD:
            return given
        if pose.frame == self.base_frame:
            return self.base.then(given)
        raise RobotError(
            f"the frame {pose.frame!r} is not known to this arm",
            where=self._arm,
            hint=f"give the pose in {WORLD!r} or {self.base_frame!r}",
        )
