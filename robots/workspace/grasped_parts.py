"""Grasped parts: their pose in the hand, their allowed contacts, and whether they are still in the hand."""

from __future__ import annotations

from dataclasses import dataclass, replace

import msgspec

from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.planning.scene.planning_scene import AttachedPart

# A grasped part may slip a little; farther from its pose at the grasp it counts as lost.
_SLIPPED_M, _SLIPPED_RAD = 0.002, 0.02
_LOST_M, _LOST_RAD = 0.03, 0.35


@dataclass(frozen=True, kw_only=True)
class GraspedPart:
    """A part in a hand: `taken` is its pose in the link's frame at attachment; `touches` are contacts still allowed."""

    part: AttachedPart
    link: str
    taken: RigidTransform
    touches: frozenset[str]

    def slipped_to(self, now: RigidTransform) -> GraspedPart | None:
        """Return the grasped part at `now` in the link's frame; None if it is lost."""
        if self.taken.distance_m(now) > _LOST_M or self.taken.angle_rad(now) > _LOST_RAD:
            return None
        known = RigidTransform.from_pose(self.part.pose)
        if known.distance_m(now) <= _SLIPPED_M and known.angle_rad(now) <= _SLIPPED_RAD:
            return self
        return replace(self, part=msgspec.structs.replace(self.part, pose=now.to_pose(self.link)))


@dataclass(frozen=True, kw_only=True)
class ReleasedPart:
    """A released part: the links of the arm that are still near enough to be allowed contact."""

    arm: str
    links: frozenset[str]


class GraspedPartMemo(msgspec.Struct, frozen=True, kw_only=True):
    """A grasped part as stored in a snapshot."""

    part: AttachedPart
    link: str
    taken: Pose
    touches: tuple[str, ...]

    @classmethod
    def of(cls, held: GraspedPart) -> GraspedPartMemo:
        """Return the memo of a grasped part."""
        return cls(
            part=held.part, link=held.link, taken=held.taken.to_pose(held.link), touches=tuple(sorted(held.touches))
        )

    def held(self) -> GraspedPart:
        """Return the grasped part."""
        return GraspedPart(
            part=self.part, link=self.link, taken=RigidTransform.from_pose(self.taken), touches=frozenset(self.touches)
        )


class ReleasedPartMemo(msgspec.Struct, frozen=True, kw_only=True):
    """A released part as stored in a snapshot."""

    part: str
    arm: str
    links: tuple[str, ...]
