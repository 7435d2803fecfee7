"""Everything that the future of a world depends on as one flat array of numbers: its image."""

from __future__ import annotations

from robots.sim.snapshot import ArmSummary

_FINGER_FIELDS = 4


class ImageLayout:
    """Where each quantity lies in an image.

    First the steps done, then the physics as MuJoCo hands it out, then for each arm its set point
    and for each gripper what its fingers do: set point, target, speed, force.
    """

    def __init__(self, arms: tuple[ArmSummary, ...], *, state_size: int) -> None:
        self.steps = 0
        self.physics = slice(1, 1 + state_size)
        at = self.physics.stop
        self.set_points: dict[str, slice] = {}
        self.fingers: dict[str, slice] = {}
        for arm in arms:
            self.set_points[arm.name] = slice(at, at + len(arm.joints))
            at += len(arm.joints)
            if arm.gripper_width_m:
                self.fingers[arm.name] = slice(at, at + _FINGER_FIELDS)
                at += _FINGER_FIELDS
        self.size = at
