"""Grasped parts: their pose in the hand, their allowed contacts, and whether they are still in the hand."""

from __future__ import annotations

import msgspec

from engine.messages import Pose
from robots.model.transform import RigidTransform
from robots.planning.scene.planning_scene import AttachedPart

# A grasped part may slip a little; farther from its pose at the grasp it counts as lost.
_SLIPPED_M, _SLIPPED_RAD = 0.002, 0.02
_LOST_M, _LOST_RAD = 0.03, 0.35


class GraspedPart(msgspec.Struct, frozen=True, kw_only=True, omit_defaults=True):
    """A part in a hand: `taken` is its pose in the link's frame at attachment; `touches` are contacts still allowed.

    `by_contact` if nobody has attached it: it is in the hand as long as the tool is measured to hold it.
    """

    part: AttachedPart
    link: str
    taken: Pose
    touches: frozenset[str]
    by_contact: bool = False

    def slipped_to(self, now: RigidTransform) -> GraspedPart | None:
        """Return the grasped part at `now` in the link's frame; None if it is lost."""
        taken = RigidTransform.from_pose(self.taken)
        if not self.by_contact and (taken.distance_m(now) > _LOST_M or taken.angle_rad(now) > _LOST_RAD):
            return None
        known = RigidTransform.from_pose(self.part.pose)
        if known.distance_m(now) <= _SLIPPED_M and known.angle_rad(now) <= _SLIPPED_RAD:
            return self
        part = msgspec.structs.replace(self.part, pose=now.to_pose(self.link))
        return msgspec.structs.replace(self, part=part)


class ReleasedPart(msgspec.Struct, frozen=True, kw_only=True):
    """A released part: the links of the arm that are still near enough to be allowed contact."""

    part: str
    arm: str
    links: frozenset[str]
