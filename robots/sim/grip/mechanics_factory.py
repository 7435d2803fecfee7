"""Creates the mechanics of the tool on an arm."""

from __future__ import annotations

from robots.control.tool_drives.finger_servo import FingerServo
from robots.sim.grip.finger_mechanics import FingerMechanics, SlidingGear, TurningGear
from robots.sim.grip.magnet_mechanics import MagnetMechanics
from robots.sim.grip.mechanics import ToolMechanics
from robots.sim.grip.soft_hand_mechanics import SoftHandMechanics
from robots.sim.grip.tool_summary import opening_summary
from robots.sim.physics.cell_model import ArmIndices
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics
from robots.sim.physics.tool_indices import FingerIndices, HandIndices, LinkageIndices, MagnetIndices


def new_mechanics(arm: ArmIndices, physics: Physics, contacts: ContactReader) -> ToolMechanics | None:
    """Return the mechanics of an arm's tool, None for a bare flange; the tool keeps its state in `physics`."""
    match arm.tool:
        case FingerIndices() as fingers:
            servo = FingerServo(fingers.model)
            return FingerMechanics(SlidingGear(fingers, physics), servo, contacts, fingers.pad_geoms)
        case LinkageIndices() as linkage:
            gear = TurningGear(linkage, physics)
            opening = opening_summary(linkage.model)
            servo = FingerServo(opening, min_force_n=opening.min_force_n, finger_kg=gear.finger_kg)
            return FingerMechanics(gear, servo, contacts, linkage.pad_geoms)
        case HandIndices() as hand:
            return SoftHandMechanics(hand, physics, contacts, own=arm.bodies)
        case MagnetIndices() as magnet:
            return MagnetMechanics(magnet, physics, contacts, own=arm.bodies)
        case None:
            return None
