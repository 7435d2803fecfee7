"""The parts in hands: where they are in the hand, what they may touch meanwhile, and whether they are still there."""

from __future__ import annotations

from dataclasses import dataclass, replace

import msgspec

from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.planning.scene.planning_scene import AttachedPart

# A part slips a little while it is gripped; farther from where it was taken it is lost.
_SLIPPED_M, _SLIPPED_RAD = 0.002, 0.02
_LOST_M, _LOST_RAD = 0.03, 0.35


@dataclass(frozen=True, kw_only=True)
class GraspedPart:
    """A part in a hand: `taken` is its pose in the link's frame when it was attached; `touches` are still allowed."""

    part: AttachedPart
    link: str
    taken: RigidTransform
    touches: frozenset[str]

    def slipped_to(self, now: RigidTransform) -> GraspedPart | None:
        """Return what is held when the part is at `now` in the link's frame; None where it is lost."""
        if self.taken.distance_m(now) > _LOST_M or self.taken.angle_rad(now) > _LOST_RAD:
            return None
        known = RigidTransform.from_pose(self.part.pose)
        if known.distance_m(now) <= _SLIPPED_M and known.angle_rad(now) <= _SLIPPED_RAD:
            return self
        return replace(self, part=msgspec.structs.replace(self.part, pose=now.to_pose(self.link)))


@dataclass(frozen=True, kw_only=True)
class ReleasedPart:
    """A part that was let go of: the links of the arm that are still so near that touching is allowed."""

    arm: str
    links: frozenset[str]


class GraspedPartMemo(msgspec.Struct, frozen=True, kw_only=True):
    """A held part, to know again."""

    part: AttachedPart
    link: str
    taken: Pose
    touches: tuple[str, ...]

    @classmethod
    def of(cls, held: GraspedPart) -> GraspedPartMemo:
        """Return the memo of a held part."""
        return cls(
            part=held.part, link=held.link, taken=held.taken.to_pose(held.link), touches=tuple(sorted(held.touches))
        )

    def held(self) -> GraspedPart:
        """Return the held part."""
        return GraspedPart(
            part=self.part, link=self.link, taken=RigidTransform.from_pose(self.taken), touches=frozenset(self.touches)
        )


class ReleasedPartMemo(msgspec.Struct, frozen=True, kw_only=True):
    """A part that was let go of, to know again."""

    part: str
    arm: str
    links: tuple[str, ...]
