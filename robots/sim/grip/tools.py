"""Makes the mechanics of whatever tool is on an arm."""

from __future__ import annotations

from robots.control.finger_servo import FingerServo
from robots.sim.cell_model import ArmIndices
from robots.sim.contacts import ContactReader
from robots.sim.grip.fingers import Fingers, SlidingGear, TurningGear
from robots.sim.grip.magnet import Magnet
from robots.sim.grip.mechanics import Mechanics
from robots.sim.grip.soft_hand import SoftHand
from robots.sim.grip.tool_indices import FingerIndices, HandIndices, LinkageIndices, MagnetIndices
from robots.sim.physics import Physics
from robots.sim.tool_summary import opening_summary


def new_mechanics(arm: ArmIndices, physics: Physics, contacts: ContactReader) -> Mechanics | None:
    """Return what moves the tool of an arm, None for a bare flange; the tool stands as it is in `physics`."""
    match arm.tool:
        case FingerIndices() as fingers:
            servo = FingerServo(fingers.model)
            return Fingers(SlidingGear(fingers, physics), servo, contacts, fingers.pad_geoms)
        case LinkageIndices() as linkage:
            gear = TurningGear(linkage, physics)
            opening = opening_summary(linkage.model)
            servo = FingerServo(opening, min_force_n=opening.min_force_n, finger_kg=gear.finger_kg)
            return Fingers(gear, servo, contacts, linkage.pad_geoms)
        case HandIndices() as hand:
            return SoftHand(hand, physics, contacts, own=arm.bodies)
        case MagnetIndices() as magnet:
            return Magnet(magnet, physics, contacts, own=arm.bodies)
        case None:
            return None
