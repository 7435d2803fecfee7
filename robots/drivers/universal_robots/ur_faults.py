"""Why a controller of Universal Robots does not do what it is asked: one word for each cause, never a bare False."""

from __future__ import annotations

from enum import Enum

from robots.drivers.arm.joint_controller import ControllerLost, MotionRefused


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
    PROGRAM_PAUSED = "program paused"
    PROGRAM_NOT_READY = "program not ready"
    WRONG_VERSION = "wrong version"
    REFUSED = "refused"
    LINK_CUT = "link cut"
    LINK_SLOW = "link slow"


_REMEDIES = {
    UrFault.PROTECTIVE_STOP: "look at its cause, wait 5 s, and unlock it at the teach pendant or dashboard",
    UrFault.SAFEGUARD_STOP: "close the safeguard",
    UrFault.EMERGENCY_STOP: "release the button, then switch on power and release the brakes",
    UrFault.SAFETY_VIOLATION: "look at the log of the controller; it needs a restart of its safety system",
    UrFault.SAFETY_FAULT: "look at the log of the controller; it needs a restart",
    UrFault.POWER_OFF: "switch on power and release the brakes",
    UrFault.LOCAL_CONTROL: "choose remote control on the teach pendant",
    UrFault.IN_USE: "end the other client, EtherNet/IP, PROFINET or Modbus unit that writes the same registers",
    UrFault.NO_CLIENT_LIBRARY: (
        "choose `client: script`, or install flexcell[ur], whose wheels end at Python 3.12 on Linux x86-64"
    ),
    UrFault.UNREACHABLE_CONTROLLER: "check its address, cable and power",
    UrFault.PROGRAM_ENDED: "look at the log of the controller: a pose out of reach or the watchdog ends a program",
    UrFault.PROGRAM_PAUSED: "stop the program at the teach pendant, then enable the arm",
    UrFault.PROGRAM_NOT_READY: (
        "look at the log of the controller, and enable the arm again; "
        "where controller or network are slow, give the program more time: `start_s`"
    ),
    UrFault.WRONG_VERSION: "it needs PolyScope 3.5 or newer with the service RTDE",
    UrFault.LINK_SLOW: "check the network: the controller needs one of its own",
    UrFault.LINK_CUT: "check cable and controller; only reading is restored by itself",
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


def remedy(fault: UrFault) -> str:
    """Return what a person can do about it."""
    return _REMEDIES.get(fault, "")


def safety_fault(safety_bits: int, robot_mode: int) -> UrFault | None:
    """Return what forbids motion, from RTDE's `safety_status_bits` and `robot_mode`; None where nothing does."""
    for bit, fault in _SAFETY_BITS:
        if safety_bits >> bit & 1:
            return fault
    return None if robot_mode == _RUNNING_MODE else UrFault.POWER_OFF


def controller_words(robot_mode: int, safety_bits: int, *, is_running: bool, is_paused: bool) -> str:
    """Return what a controller says of itself by RTDE: whether a program runs, and what permits or forbids motion."""
    program = "is paused" if is_paused else "runs" if is_running else "does not run"
    fault = safety_fault(safety_bits, robot_mode)
    return f"the controller says that a program {program}, and {fault.value if fault else 'that the arm may move'}"


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
        ("Failed to start control script", UrFault.PROGRAM_NOT_READY),
    ):
        if words in message:
            return fault
    return UrFault.REFUSED


def stop_words(fault: UrFault) -> str:
    """Return what a reading says of a controller that does not move."""
    return f"{fault.value}: the controller has stopped the arm"


def refused(fault: UrFault, message: str) -> MotionRefused:
    """Return what to raise where the controller does not move."""
    return MotionRefused(f"{fault.value}: {message}", hint=remedy(fault))


def lost(fault: UrFault, message: str) -> ControllerLost:
    """Return what to raise where the controller is lost."""
    return ControllerLost(f"{fault.value}: {message}", hint=remedy(fault))
