"""The registers of an emulated gripper over fingers that are not its own."""

from __future__ import annotations

from dataclasses import dataclass, field

from robots.drivers.emulation.plant import ToolMeasurement
from robots.drivers.robotiq.emulation.emulated_gripper import EmulatedGripper
from robots.drivers.robotiq.gripper_registers import ACTIVATE, GripperCommand, ObjectStatus

CLOSE = GripperCommand(activate=True, go=True, position=255, speed=255, force=150)
STOP = GripperCommand(activate=True, go=False, position=255, speed=255, force=150)


OPEN = ToolMeasurement(closed_share=0.0, moving=False, blocked=False)


@dataclass
class Fingers:
    """Fingers of a world that a test moves; `done` is what they were told."""

    reading: ToolMeasurement = field(default_factory=lambda: OPEN)
    done: list[str] = field(default_factory=list[str])

    def close_to(self, closed_share: float, *, speed_share: float = 1.0, force_share: float = 1.0) -> None:
        self.done.append(f"close to {closed_share:.2f} at {speed_share:.2f} with {force_share:.2f}")
        self.reading = ToolMeasurement(closed_share=0.0, moving=True, blocked=False)

    def stop(self) -> None:
        self.done.append("stop")

    def home(self) -> None:
        self.done.append("home")

    def measured(self) -> ToolMeasurement:
        return self.reading


def active(fingers: Fingers) -> EmulatedGripper:
    gripper = EmulatedGripper(lambda: 0.0, fingers, activation_s=0.0)
    gripper.command(ACTIVATE)
    assert gripper.status().active
    fingers.done.clear()
    return gripper


def test_it_is_active_only_when_the_fingers_have_found_their_ends() -> None:
    fingers = Fingers(reading=ToolMeasurement(closed_share=0.5, moving=True, blocked=False))
    gripper = EmulatedGripper(lambda: 0.0, fingers, activation_s=0.0)
    gripper.command(ACTIVATE)
    assert fingers.done == ["home"]
    assert not gripper.status().active
    fingers.reading = ToolMeasurement(closed_share=0.0, moving=False, blocked=False)
    assert gripper.status().active


def test_the_object_status_is_that_of_stopped_fingers_and_ends_when_the_object_is_gone() -> None:
    fingers = Fingers()
    gripper = active(fingers)
    gripper.command(CLOSE)
    assert fingers.done == ["close to 1.00 at 1.00 with 0.62"]
    assert gripper.status().contact is ObjectStatus.MOVING
    fingers.reading = ToolMeasurement(closed_share=0.41, moving=False, blocked=True)
    status = gripper.status()
    assert (status.contact, status.position) == (ObjectStatus.CONTACT_CLOSING, 96)
    fingers.reading = ToolMeasurement(closed_share=1.0, moving=False, blocked=False)
    assert gripper.status().contact is ObjectStatus.AT_POSITION


def test_a_stop_and_a_fault_reach_the_fingers() -> None:
    fingers = Fingers()
    gripper = active(fingers)
    gripper.command(CLOSE)
    gripper.command(STOP)
    assert fingers.done[-1] == "stop"
    gripper.command(CLOSE)
    gripper.fault = 8
    gripper.advance()
    assert fingers.done[-1] == "stop"
    gripper.fault = 0
    gripper.advance()
    assert fingers.done[-1].startswith("close")
