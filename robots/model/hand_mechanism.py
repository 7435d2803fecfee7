"""The mechanism of a soft hand: one motor, one tendon, springs in all joints."""

from __future__ import annotations

from msgspec.structs import replace

from engine.document import StrictModel
from robots.model.mechanism import Mechanism, Positive, Text


class SynergyJoint(StrictModel, frozen=True, kw_only=True):
    """One joint of a soft hand: radius of its pulley on the tendon (0 without one), spring and damper."""

    name: Text
    radius_m: float = 0.0
    stiffness_nm_rad: Positive
    damping_nms_rad: Positive

    def with_prefix(self, prefix: str) -> SynergyJoint:
        """Return it with `prefix` before its name."""
        return replace(self, name=prefix + self.name)


class SynergyModel(Mechanism, frozen=True, kw_only=True, tag="synergy"):
    """A soft hand: one motor pulls one tendon that runs over all flexion joints.

    Closing by a share s winds up s * `travel_m` of tendon; a blocked finger stops while the
    others continue. Passive joints (abduction) have springs only.
    """

    palm_link: Text
    fingers: tuple[tuple[str, ...], ...]
    """Links of each finger from knuckle to tip, thumb first."""
    flexion: tuple[SynergyJoint, ...]
    passive: tuple[SynergyJoint, ...] = ()
    travel_m: Positive
    travel_speed_m_s: Positive
    max_force_n: Positive

    def joint_names(self) -> tuple[str, ...]:
        """Return the flexion joints, then the passive ones."""
        return tuple(joint.name for joint in (*self.flexion, *self.passive))

    def link_names(self) -> tuple[str, ...]:
        """Return the palm and the links of the fingers."""
        return (self.palm_link, *(link for finger in self.fingers for link in finger))

    def with_prefix(self, prefix: str) -> SynergyModel:
        """Return it with `prefix` before its link and joint names."""
        return replace(
            self,
            palm_link=prefix + self.palm_link,
            fingers=tuple(tuple(prefix + link for link in finger) for finger in self.fingers),
            flexion=tuple(joint.with_prefix(prefix) for joint in self.flexion),
            passive=tuple(joint.with_prefix(prefix) for joint in self.passive),
        )
