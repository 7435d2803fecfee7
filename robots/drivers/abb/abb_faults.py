"""Why an ABB controller does not move or cannot be reached: one name for each cause, with what to do."""

from __future__ import annotations

from enum import Enum

from robots.drivers.abb.simple_message import OperatingMode, RobotStatus, Tristate
from robots.io.wire.link_error import LinkError


class AbbFault(Enum):
    """The cause of a failure; its value begins each message."""

    EMERGENCY_STOP = "emergency stop"
    GUARD_STOP = "guard stop"
    MANUAL_MODE = "manual mode"
    CONTROLLER_ERROR = "controller error"
    DRIVES_OFF = "drives off"
    PROGRAM_STOPPED = "program stopped"
    MOTION_NOT_POSSIBLE = "motion not possible"
    UNKNOWN_STATUS = "unknown status"
    EGM_STOPPED = "EGM stopped"
    LINK_CUT = "link cut"
    SILENT = "controller silent"
    GARBAGE = "garbage"
    REFUSED = "refused"
    NOT_AT_TARGET = "not at target"
    OFF_THE_PATH = "off the path"
    FOREIGN_MOTION = "foreign motion"
    ENGINE_SILENT = "engine silent"


REMEDIES = {
    AbbFault.EMERGENCY_STOP: "release the button and switch the motors on at the controller",
    AbbFault.GUARD_STOP: "close the gate or clear the safeguard",
    AbbFault.MANUAL_MODE: "turn the mode selector to automatic",
    AbbFault.CONTROLLER_ERROR: "read the event log on the FlexPendant",
    AbbFault.DRIVES_OFF: "switch the motors on at the controller",
    AbbFault.PROGRAM_STOPPED: "look why it stopped",
    AbbFault.MOTION_NOT_POSSIBLE: "start the program on the FlexPendant",
    AbbFault.UNKNOWN_STATUS: "configure the system outputs that ROS_stateServer reads",
    AbbFault.EGM_STOPPED: "check that the program FlexcellEgm runs, its limits of speed, and the event log",
    AbbFault.LINK_CUT: "check cable, address and ports, and that the programs of the controller run",
    AbbFault.SILENT: "check that its programs run and that no other client is connected: each port serves one",
    AbbFault.GARBAGE: "check `byte_order`, the ports, and that the controller runs the server programs of abb_driver",
    AbbFault.REFUSED: "read the event log on the FlexPendant",
    AbbFault.NOT_AT_TARGET: "read the event log on the FlexPendant; compare its joint limits with the model",
    AbbFault.OFF_THE_PATH: "check `coupled_joints`, the calibration, and that nothing else commands the arm",
    AbbFault.FOREIGN_MOTION: "end the other client or program that moves the arm",
    AbbFault.ENGINE_SILENT: "look for what blocks the event loop",
}
"""What a person does about each."""


class AbbLinkError(LinkError):
    """A failure on the wire with its cause."""

    def __init__(self, fault: AbbFault, detail: str) -> None:
        super().__init__(f"{fault.value}: {detail}")
        self.fault = fault


def status_fault(status: RobotStatus) -> tuple[AbbFault, str] | None:
    """Return why the controller does not move as it says itself, with details; None if it can."""
    if status.e_stopped is Tristate.YES:
        return AbbFault.EMERGENCY_STOP, "the emergency stop is active"
    if status.in_error is Tristate.YES or status.error_code > 0:
        return AbbFault.CONTROLLER_ERROR, f"error code {status.error_code}"
    if status.mode is OperatingMode.MANUAL:
        return AbbFault.MANUAL_MODE, "the mode selector is in manual"
    if status.drives_powered is Tristate.NO:
        return AbbFault.DRIVES_OFF, "the motors are off"
    if status.motion_possible is Tristate.NO:
        return AbbFault.MOTION_NOT_POSSIBLE, "the motion task does not run"
    unknown = [name for name, value in _needed(status) if value == Tristate.UNKNOWN]
    if unknown:
        return AbbFault.UNKNOWN_STATUS, f"the controller does not say {', '.join(unknown)}"
    return None


def _needed(status: RobotStatus) -> tuple[tuple[str, int], ...]:
    return (
        ("e_stopped", status.e_stopped),
        ("mode", status.mode),
        ("drives_powered", status.drives_powered),
        ("motion_possible", status.motion_possible),
        ("in_motion", status.in_motion),
    )
