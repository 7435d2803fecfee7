"""Why a controller of Universal Robots does not do what it is asked: one word for each cause, never a bare False."""

from __future__ import annotations

from enum import Enum

from engine.errors import RobotError


class UrFault(Enum):
    """The cause of a failure."""

    PROTECTIVE_STOP = "protective stop"
    SAFEGUARD_STOP = "safeguard stop"
    EMERGENCY_STOP = "emergency stop"
    SAFETY_VIOLATION = "safety violation"
    SAFETY_FAULT = "safety fault"
    POWER_OFF = "power off"
    LOCAL_CONTROL = "local control"
    IN_USE = "inputs in use"
    NO_CLIENT_LIBRARY = "no client library"
    UNREACHABLE_CONTROLLER = "controller unreachable"
    PROGRAM_ENDED = "program ended"
    NOT_ENABLED = "motion not enabled"
    REFUSED = "refused"
    STOPPED = "stopped"
    LINK_CUT = "link cut"
    CONTROLLER_SILENT = "controller silent"
    PROCESS_SILENT = "process silent"
    PROCESS_ENDED = "process ended"


_REMEDIES = {
    UrFault.PROTECTIVE_STOP: "look at its cause, wait 5 s, and unlock it at the teach pendant or dashboard",
    UrFault.SAFEGUARD_STOP: "close the safeguard",
    UrFault.EMERGENCY_STOP: "release the button, then switch on power and release the brakes",
    UrFault.SAFETY_VIOLATION: "look at the log of the controller; it needs a restart of its safety system",
    UrFault.SAFETY_FAULT: "look at the log of the controller; it needs a restart",
    UrFault.POWER_OFF: "switch on power and release the brakes",
    UrFault.LOCAL_CONTROL: "choose remote control on the teach pendant",
    UrFault.IN_USE: "end the other client, EtherNet/IP, PROFINET or Modbus unit that writes the same registers",
    UrFault.NO_CLIENT_LIBRARY: "install flexcell[ur]; its wheels end at Python 3.12 on Linux x86-64",
    UrFault.UNREACHABLE_CONTROLLER: "check its address, cable and power",
    UrFault.PROGRAM_ENDED: "look at the log of the controller: a pose out of reach or the watchdog ends a program",
    UrFault.NOT_ENABLED: "enable motion; after a lost link it has to be enabled again",
    UrFault.LINK_CUT: "check cable and controller; only reading is restored by itself",
    UrFault.CONTROLLER_SILENT: "check the controller; only reading is restored by itself",
    UrFault.PROCESS_SILENT: "only reading is restored by itself; enable motion again",
    UrFault.PROCESS_ENDED: "only reading is restored by itself; enable motion again",
}
# The first of these bits of `safety_status_bits` that is set is the cause.
_SAFETY_BITS = (
    (9, UrFault.SAFETY_FAULT),
    (8, UrFault.SAFETY_VIOLATION),
    (7, UrFault.EMERGENCY_STOP),
    (6, UrFault.EMERGENCY_STOP),
    (5, UrFault.EMERGENCY_STOP),
    (4, UrFault.SAFEGUARD_STOP),
    (2, UrFault.PROTECTIVE_STOP),
)
_SAFETY_WORDS = {
    "FAULT": UrFault.SAFETY_FAULT,
    "VIOLATION": UrFault.SAFETY_VIOLATION,
    "ROBOT_EMERGENCY_STOP": UrFault.EMERGENCY_STOP,
    "SYSTEM_EMERGENCY_STOP": UrFault.EMERGENCY_STOP,
    "SAFEGUARD_STOP": UrFault.SAFEGUARD_STOP,
    "AUTOMATIC_MODE_SAFEGUARD_STOP": UrFault.SAFEGUARD_STOP,
    "PROTECTIVE_STOP": UrFault.PROTECTIVE_STOP,
}
_RUNNING_MODE = 7


class UrFaultError(RobotError):
    """A failure of a controller with its cause."""

    def __init__(self, fault: UrFault, message: str, *, where: str) -> None:
        super().__init__(f"{fault.value}: {message}", where=where, hint=_REMEDIES.get(fault))
        self.fault = fault


def safety_fault(safety_bits: int, robot_mode: int) -> UrFault | None:
    """Return what forbids motion, from RTDE's `safety_status_bits` and `robot_mode`; None where nothing does."""
    for bit, fault in _SAFETY_BITS:
        if safety_bits >> bit & 1:
            return fault
    return None if robot_mode == _RUNNING_MODE else UrFault.POWER_OFF


def dashboard_fault(safety_status: str) -> UrFault | None:
    """Return what forbids motion, from the dashboard's answer to `safetystatus`; None where it says nothing of it."""
    return _SAFETY_WORDS.get(safety_status.rpartition(":")[2].strip())


def library_fault(message: str) -> UrFault:
    """Return the cause that a message of the client library is about."""
    for words, fault in (
        ("already in use", UrFault.IN_USE),
        ("enable remote control", UrFault.LOCAL_CONTROL),
        ("verify the IP", UrFault.UNREACHABLE_CONTROLLER),
        ("No module named", UrFault.NO_CLIENT_LIBRARY),
        ("Failed to start control script", UrFault.PROGRAM_ENDED),
    ):
        if words in message:
            return fault
    return UrFault.REFUSED
