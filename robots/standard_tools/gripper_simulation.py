"""What simulates grippers with two fingers, whether they slide, turn on a linkage, or on a servo."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

from engine.messages import GripperState
from robots.control.tool_drives.finger_servo import FingerServo
from robots.gripper import GripperServer, ToolServer
from robots.model.finger_mechanisms import ClawModel, GripperModel, LinkageModel
from robots.model.tool_model import ToolModel
from robots.port.grasp_check import grasp_evidence
from robots.sim.grip.mechanics import ToolMechanics
from robots.sim.grip.tool_reading import ToolReading
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.physics.cell_model import ArmIndices
from robots.sim.physics.contacts import ContactReader
from robots.sim.physics.physics import Physics
from robots.sim.physics.tool_body import ToolIndices
from robots.sim.ports.tool_ports import ToolLine
from robots.sim.world.sim_world import SimWorld
from robots.standard_tools.finger_body import (
    FingerIndices,
    LinkageIndices,
    finger_indices,
    finish_fingers,
    finish_linkage,
    linkage_indices,
)
from robots.standard_tools.finger_mechanics import FingerMechanics, SlidingGear, TurningGear
from robots.standard_tools.gripper_port import SimGripperPort, gripper_sample
from robots.standard_tools.tool_simulation import ToolSimulation

# Both pads press at least this hard on the same part before it counts as held.
_HELD_N = 1.0


class GripperSimulation:
    """Implements `ToolSimulation` for grippers."""

    def finish(self, spec: Any, tool: ToolModel) -> None:
        """Add motors and pads."""
        match _fingers(tool):
            case GripperModel() as sliding:
                finish_fingers(spec, sliding)
            case turning:
                finish_linkage(spec, turning)

    def indices(self, model: Any, arm: str, tool: ToolModel, *, ferrous: Iterable[str]) -> ToolIndices:
        """Return the addresses of joints, motors and pads."""
        match _fingers(tool):
            case GripperModel() as sliding:
                return finger_indices(model, arm, sliding)
            case turning:
                return linkage_indices(model, arm, turning)

    def mechanics(self, arm: ArmIndices, physics: Physics, contacts: ContactReader) -> ToolMechanics:
        """Return a servo on the gear of the fingers."""
        match arm.tool:
            case FingerIndices() as fingers:
                servo = FingerServo(fingers.model)
                return FingerMechanics(SlidingGear(fingers, physics), servo, contacts, fingers.pad_geoms)
            case LinkageIndices() as linkage:
                gear = TurningGear(linkage, physics)
                opening = _opening_summary(linkage.model)
                servo = FingerServo(opening, min_force_n=opening.min_force_n, finger_kg=gear.finger_kg)
                return FingerMechanics(gear, servo, contacts, linkage.pad_geoms)
            case _:
                raise TypeError(f"{arm.name} carries no gripper")

    def summary(self, tool: ToolModel) -> ToolSummary:
        """Return the range of the fingers; the contacts are the pads, left then right."""
        return _opening_summary(_fingers(tool))

    def port(self, line: ToolLine) -> SimGripperPort:
        """Return the port of a gripper."""
        return SimGripperPort(line)

    def state(self, reading: ToolReading, tool: ToolSummary, *, parts: Collection[str]) -> GripperState:
        """Return the measured state; a part that both pads press on is held."""
        sample = gripper_sample(reading)
        left, right = sample.contacts
        held = left == right and left in parts and sample.force_n >= _HELD_N
        return GripperState(
            time_s=sample.time_s,
            width_m=sample.width_m,
            force_n=sample.force_n,
            held=held,
            part=left if held else "",
            by=grasp_evidence(sample),
        )

    def server(self, name: str, world: SimWorld, arm: str) -> ToolServer:
        """Return the server of a gripper."""
        return GripperServer(name=name, port=world.gripper(arm))


def _fingers(tool: ToolModel) -> GripperModel | LinkageModel | ClawModel:
    match tool.mechanism:
        case GripperModel() | LinkageModel() | ClawModel() as fingers:
            return fingers
        case other:
            raise TypeError(f"{tool.name} has no fingers but a {type(other).__name__}")


def _opening_summary(fingers: GripperModel | LinkageModel | ClawModel) -> ToolSummary:
    """Return the summary of a gripper with two fingers."""
    speed_m_s, force_n, least_n = 0.0, 0.0, 0.0
    match fingers:
        case GripperModel():
            speed_m_s, force_n = fingers.max_speed_m_s, fingers.max_force_n
        case LinkageModel():
            speed_m_s, force_n, least_n = fingers.max_speed_m_s, fingers.max_force_n, fingers.min_force_n
        case ClawModel():
            # A servo has an angle, a speed and a torque; the fingers convert them to lengths and forces.
            travel_m_rad = fingers.max_width_m / abs(fingers.closed_rad - fingers.open_rad)
            speed_m_s, force_n = fingers.max_speed_rad_s * travel_m_rad, fingers.max_effort_nm / travel_m_rad
    return ToolSummary(
        kind="gripper",
        contacts=2,
        max_width_m=fingers.max_width_m,
        max_speed_m_s=speed_m_s,
        min_force_n=least_n,
        max_force_n=force_n,
    )


GRIPPER_SIMULATION: ToolSimulation = GripperSimulation()
