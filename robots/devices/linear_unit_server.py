"""Skill server of a linear unit: where its carriage is, and how the robot on it pulls its base along."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from random import Random

from engine.bus import SkillBus
from engine.document import LinearUnitSpec
from engine.errors import SkillFailed
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import compose_poses, invert_pose, rotate_vector
from engine.skills.linear_units import BasePull, LinearUnitReading, PlanBasePull, ReadLinearUnit
from engine.wording import did_you_mean
from robots.scene.sim_scene import ArmPlacement

# A tool centre point this far from an anchor, in metres, does not hold it.
_AT_ANCHOR_M = 0.02


class LinearUnitServer:
    """Serves a linear unit under the name of its device.

    Args:
        name: The name of the device in the cell.
        unit: The linear unit as written.
        home: Where the document has the carriage in the world.
        pose_of: Returns the pose of one of its fixtures in the world.
        arm: Returns where the arm on the carriage stands, as everybody in the cell knows it.
        frames: The poses of the named frames in the world.
        noise: Draws the noise of the scale.
    """

    def __init__(
        self,
        name: str,
        unit: LinearUnitSpec,
        *,
        home: Pose,
        pose_of: Callable[[str], Pose],
        arm: Callable[[], ArmPlacement],
        frames: Mapping[str, Pose],
        noise: Random,
    ) -> None:
        self._name = name
        self._unit = unit
        self._home = home
        self._rail = unit.direction(home)
        self._pose_of = pose_of
        self._arm = arm
        self._frames = frames
        self._noise = noise

    def register(self, bus: SkillBus) -> None:
        """Advertise the skills."""
        bus.advertise_service(ReadLinearUnit, self._read, namespace=self._name)
        bus.advertise_service(PlanBasePull, self._plan, namespace=self._name)

    async def _read(self, request: ReadLinearUnit) -> LinearUnitReading:
        scale, place_m = self._unit.scale, self._place_m(self._pose_of(self._unit.carriage))
        return LinearUnitReading(
            place_m=place_m,
            scale_m=place_m + self._noise.gauss(0.0, scale.noise_m) if scale is not None else None,
            target_m=self._target_m(request.place, request.place_m),
            base=self._arm().base,
        )

    async def _plan(self, request: PlanBasePull) -> BasePull:
        unit, arm = self._unit, self._arm()
        goal_m, start_m = self._target_m(request.place, request.place_m), self._known_m(arm)
        held = compose_poses(invert_pose(arm.base), request.tool)
        along = _in_frame(arm.base, self._rail)
        anchor, away_m = self._nearest_anchor(request.tool)
        refused = unit.beyond_travel(goal_m)
        if not refused and away_m > _AT_ANCHOR_M:
            refused = f"the tool centre point is {1e3 * away_m:.0f} mm from the nearest anchor, {anchor}"
        frame = f"{arm.name}/{arm.robot().base_link}"
        # The base goes along the rail, so the anchor goes back along it in the frame of the base.
        goal = tuple(at - (goal_m - start_m) * one for at, one in zip(held.xyz, along, strict=True))
        return BasePull(
            refused=refused,
            robot=unit.robot,
            anchor=anchor,
            start_m=start_m,
            goal_m=goal_m,
            start=Pose(xyz=held.xyz, xyzw=held.xyzw, frame=frame),
            goal=Pose(xyz=(goal[0], goal[1], goal[2]), xyzw=held.xyzw, frame=frame),
            along=along,
            carried_kg=unit.carried_kg,
            has_scale=unit.scale is not None,
            released=unit.released,
            locked=unit.locked,
        )

    def _target_m(self, place: str, place_m: float) -> float:
        """Return a place in metres; raises SkillFailed for a name that the unit does not have."""
        if not place:
            return place_m
        if place not in self._unit.places:
            hint = did_you_mean(place, self._unit.places)
            raise SkillFailed(f"{self._name} has no place {place}", where=self._name, hint=hint)
        return self._unit.places[place]

    def _place_m(self, carriage: Pose) -> float:
        moved = (now - before for now, before in zip(carriage.xyz, self._home.xyz, strict=True))
        return sum(one * along for one, along in zip(moved, self._rail, strict=True))

    def _known_m(self, arm: ArmPlacement) -> float:
        """Return the place at which everybody in the cell knows the base to be."""
        return self._place_m(self._pose_of(arm.on))

    def _nearest_anchor(self, tool: Pose) -> tuple[str, float]:
        away = {name: math.dist(tool.xyz, self._frames[frame].xyz) for name, frame in self._unit.anchors.items()}
        return min(away.items(), key=lambda one: one[1])


def _in_frame(base: Pose, direction: Vector3) -> Vector3:
    """Return a direction of the world in the axes of a base."""
    return rotate_vector(invert_pose(base).xyzw, direction)
