"""Skill server of a hexapod: where its platform is, and where a tool moves it within the limits of its legs."""

from __future__ import annotations

from collections.abc import Callable

from engine.bus import SkillBus
from engine.document import HexapodSpec, leg_lengths_m, path_beyond_limits
from engine.errors import RobotError, SkillFailed
from engine.messages import Pose
from engine.messages.pose_algebra import compose_poses, invert_pose
from engine.skills.hexapods import HexapodMove, HexapodReading, PlanHexapodMove, ReadHexapod
from engine.wording import did_you_mean


class HexapodServer:
    """Serves a hexapod under the name of its device.

    Args:
        name: The name of the device in the cell.
        hexapod: The hexapod as written.
        pose_of: Returns the pose of one of its fixtures in the world; raises RobotError where it is not in the cell.
    """

    def __init__(self, name: str, hexapod: HexapodSpec, *, pose_of: Callable[[str], Pose]) -> None:
        self._name = name
        self._hexapod = hexapod
        self._pose_of = pose_of

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills."""
        bus.advertise_service(ReadHexapod, self._read, namespace=self._name)
        bus.advertise_service(PlanHexapodMove, self._plan, namespace=self._name)

    async def _read(self, request: ReadHexapod) -> HexapodReading:
        base, platform = self._plates(request.pose)
        return HexapodReading(
            platform=platform,
            target=compose_poses(base, self._hexapod.pose(request.pose)),
            lengths_m=leg_lengths_m(self._hexapod, compose_poses(invert_pose(base), platform)),
        )

    async def _plan(self, request: PlanHexapodMove) -> HexapodMove:
        base, platform = self._plates(request.pose)
        goal = self._hexapod.pose(request.pose)
        held = compose_poses(invert_pose(platform), request.tool)
        start = compose_poses(invert_pose(base), platform)
        end = compose_poses(base, goal)
        return HexapodMove(
            refused=path_beyond_limits(self._hexapod, start, goal, tool=held),
            start=platform,
            platform=end,
            tool=compose_poses(end, held),
            released=self._hexapod.released,
            locked=self._hexapod.locked,
            bodies=self._hexapod.bodies,
        )

    def _plates(self, pose: str) -> tuple[Pose, Pose]:
        """Return where base and platform are in the world, once it is known that there is such a pose."""
        if pose not in self._hexapod.poses:
            hint = did_you_mean(pose, self._hexapod.poses)
            raise SkillFailed(f"{self._name} has no pose {pose}", where=self._name, hint=hint)
        try:
            return self._pose_of(self._hexapod.base), self._pose_of(self._hexapod.platform)
        except RobotError as error:
            raise SkillFailed(f"{self._name} is not in the cell", where=self._name, hint=error.hint) from error
