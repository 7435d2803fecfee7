"""The mechanisms of two-finger grippers: sliding fingers, fingers on a linkage, and a claw on a servo."""

from __future__ import annotations

from msgspec.structs import replace

from robots.model.mechanism import Mechanism, PadBox, Positive, Text, with_prefix_each


class GripperModel(Mechanism, frozen=True, kw_only=True, tag="parallel"):
    """A parallel gripper with two sliding fingers.

    Each finger joint moves half of the opening; both pads touch when the opening is 0.
    `finger_joints[1]` mimics `finger_joints[0]`.
    """

    hand_link: Text
    finger_joints: tuple[Text, Text]
    finger_links: tuple[Text, Text]
    pads: tuple[PadBox, PadBox]
    max_width_m: Positive
    max_speed_m_s: Positive
    max_force_n: Positive
    armature_kg: Positive = 0.2

    def joint_names(self) -> tuple[str, ...]:
        """Return both finger joints."""
        return self.finger_joints

    def link_names(self) -> tuple[str, ...]:
        """Return the hand, the fingers and the links of the pads."""
        return (self.hand_link, *self.finger_links, *(pad.link for pad in self.pads))

    def joints_at(self, opening_m: float) -> dict[str, float]:
        """Return both finger joints at an opening, or at the nearest possible one."""
        half_m = min(max(0.0, opening_m), self.max_width_m) / 2.0
        return dict.fromkeys(self.finger_joints, half_m)

    def with_prefix(self, prefix: str) -> GripperModel:
        """Return it with `prefix` before its link and joint names."""
        return replace(
            self,
            hand_link=prefix + self.hand_link,
            finger_joints=with_prefix_each(prefix, self.finger_joints),
            finger_links=with_prefix_each(prefix, self.finger_links),
            pads=tuple(pad.with_prefix(prefix) for pad in self.pads),
        )


class TurningFingers(Mechanism, frozen=True, kw_only=True):
    """Two fingers that one joint turns: the base of linkage and claw.

    `driver` turns from `open_rad` (opening `max_width_m`) to `closed_rad` (minimum opening); the joints
    in `followers` turn by their factor of it.
    """

    driver: Text
    followers: dict[str, float]
    finger_links: tuple[Text, Text]
    pads: tuple[PadBox, PadBox]
    open_rad: float
    closed_rad: float
    max_width_m: Positive
    armature_kg_m2: Positive

    def joint_names(self) -> tuple[str, ...]:
        """Return the driver and its followers."""
        return (self.driver, *self.followers)

    def link_names(self) -> tuple[str, ...]:
        """Return the fingers and the links of the pads."""
        return (*self.finger_links, *(pad.link for pad in self.pads))

    def joints_at(self, opening_m: float) -> dict[str, float]:
        """Return driver and followers at an opening, or at the nearest possible one, in proportion to the opening."""
        closed = 1.0 - min(max(0.0, opening_m), self.max_width_m) / self.max_width_m
        driver_rad = self.open_rad + closed * (self.closed_rad - self.open_rad)
        return {self.driver: driver_rad, **{joint: factor * driver_rad for joint, factor in self.followers.items()}}

    def with_prefix(self, prefix: str) -> TurningFingers:
        """Return it with `prefix` before its link and joint names."""
        return replace(
            self,
            driver=prefix + self.driver,
            followers={prefix + joint: factor for joint, factor in self.followers.items()},
            finger_links=with_prefix_each(prefix, self.finger_links),
            pads=tuple(pad.with_prefix(prefix) for pad in self.pads),
        )


class LinkageModel(TurningFingers, frozen=True, kw_only=True, tag="linkage"):
    """A two-finger gripper whose fingers are driven through a linkage by one motor."""

    max_speed_m_s: Positive
    min_force_n: Positive
    max_force_n: Positive


class ClawModel(TurningFingers, frozen=True, kw_only=True, tag="claw"):
    """A claw turned by a hobby servo, both fingers coupled by gears.

    `servo_open_rad` and `servo_closed_rad` are the angles written to the servo for `open_rad` and `closed_rad`.
    """

    servo_open_rad: float
    servo_closed_rad: float
    max_speed_rad_s: Positive
    max_effort_nm: Positive
