"""Why a Franka robot does not do what it is asked: one word for each cause, never a bare False. Loads no library."""

from __future__ import annotations

import re
from collections.abc import Iterable
from enum import Enum, IntEnum


class FrankaFault(Enum):
    """The cause of a failure."""

    REFLEX = "reflex"
    USER_STOP = "user stop"
    GUIDING = "guiding"
    COMMUNICATION = "communication constraints violation"
    MOTION_LIMITS = "motion limits"
    ROBOT_ERROR = "robot error"
    RECOVERING = "error recovery"
    NOT_READY = "not ready"
    SAFETY_FUNCTION = "safety function"
    PREEMPTED = "motion ended"
    WRONG_VERSION = "wrong version"
    FCI_REFUSED = "FCI refused"
    NO_REAL_TIME = "no real-time kernel"
    NO_CLIENT_LIBRARY = "no client library"
    UNREACHABLE_CONTROLLER = "controller unreachable"
    CONTROLLER_SILENT = "controller silent"
    LINK_CUT = "link cut"
    REFUSED = "refused"


class FrankaMode(IntEnum):
    """`robot_mode` of a robot state."""

    OTHER = 0
    IDLE = 1
    MOVE = 2
    GUIDING = 3
    REFLEX = 4
    USER_STOPPED = 5
    AUTOMATIC_ERROR_RECOVERY = 6


_REMEDIES = {
    FrankaFault.REFLEX: "look at what the arm touches and free it, then enable it, which recovers from the error",
    FrankaFault.USER_STOP: "release the user stop (external activation device), then enable it",
    FrankaFault.GUIDING: "release the buttons of the pilot, then enable it",
    FrankaFault.COMMUNICATION: (
        "20 set points in a row were lost: check network, real-time kernel and rights of SCHED_FIFO, then enable it"
    ),
    FrankaFault.MOTION_LIMITS: "the set points exceeded what the robot permits: move slower, then enable it",
    FrankaFault.ROBOT_ERROR: "look at the web interface, then enable it, which recovers from the error",
    FrankaFault.RECOVERING: "wait until the recovery has ended, then enable it",
    FrankaFault.NOT_READY: "unlock the joints and switch to execution in the web interface",
    FrankaFault.SAFETY_FUNCTION: "a safety function is active: look at it in the web interface",
    FrankaFault.PREEMPTED: "enable it",
    FrankaFault.WRONG_VERSION: (
        "this driver speaks to an FR3 with system image 5.9 or newer; a Franka Emika Robot (FER, Panda) speaks an "
        "older protocol, needs libfranka 0.9 and is not driven"
    ),
    FrankaFault.FCI_REFUSED: "activate FCI in the web interface, and end the other client: there can be one",
    FrankaFault.NO_REAL_TIME: "boot a PREEMPT_RT kernel and grant SCHED_FIFO; `real_time: ignore` is for emulators",
    FrankaFault.NO_CLIENT_LIBRARY: "install flexcell[franka]; its wheels need Linux x86-64 with glibc 2.34 or newer",
    FrankaFault.UNREACHABLE_CONTROLLER: "check its address, cable and power",
    FrankaFault.CONTROLLER_SILENT: "check the control cabinet; only reading is restored by itself",
    FrankaFault.LINK_CUT: "check cable and control cabinet; only reading is restored by itself",
}
_FORBIDDING_MODES = {
    FrankaMode.OTHER: FrankaFault.NOT_READY,
    FrankaMode.GUIDING: FrankaFault.GUIDING,
    FrankaMode.USER_STOPPED: FrankaFault.USER_STOP,
    FrankaMode.AUTOMATIC_ERROR_RECOVERY: FrankaFault.RECOVERING,
}
_NAMES = re.compile(r'"([a-z_]+)"')
_COMMUNICATION = "communication_constraints_violation"
_REFLEXES = frozenset({"joint_reflex", "cartesian_reflex"})
_MOTION_WORDS = ("motion_generator", "discontinuity", "velocity_violation", "limits_violation", "pose_deviation")
# The first of these that a message of the library contains is its cause.
_MESSAGES = (
    ("Incompatible library version", FrankaFault.WRONG_VERSION),
    ("incorrect object size", FrankaFault.WRONG_VERSION),
    ("Connection to FCI refused", FrankaFault.FCI_REFUSED),
    ("realtime capabilities", FrankaFault.NO_REAL_TIME),
    ("realtime scheduling", FrankaFault.NO_REAL_TIME),
    ("thread priority", FrankaFault.NO_REAL_TIME),
    ("No module named", FrankaFault.NO_CLIENT_LIBRARY),
    ("GLIBC", FrankaFault.NO_CLIENT_LIBRARY),
    ("User Stop pressed", FrankaFault.USER_STOP),
    ("due to user stop", FrankaFault.USER_STOP),
    ("safety function", FrankaFault.SAFETY_FUNCTION),
    ("aborted by reflex", FrankaFault.REFLEX),
    ("due to reflex", FrankaFault.REFLEX),
    ("manual error recovery required", FrankaFault.ROBOT_ERROR),
    ("preempted", FrankaFault.PREEMPTED),
    ("UDP receive", FrankaFault.CONTROLLER_SILENT),
    ("timeout", FrankaFault.UNREACHABLE_CONTROLLER),
    ("Timeout", FrankaFault.UNREACHABLE_CONTROLLER),
    ("Connection error", FrankaFault.UNREACHABLE_CONTROLLER),
    ("closed connection", FrankaFault.LINK_CUT),
    ("interrupted", FrankaFault.LINK_CUT),
    ("TCP ", FrankaFault.LINK_CUT),
    ("UDP ", FrankaFault.LINK_CUT),
)


def remedy(fault: FrankaFault) -> str:
    """Return what a person can do about it."""
    return _REMEDIES.get(fault, "")


def errors_fault(errors: Iterable[str]) -> FrankaFault:
    """Return the cause that the names of errors of a robot state are about.

    A collision counts before its consequences, and lost set points count before the motion that they have spoiled.
    """
    names = set(errors)
    if names & _REFLEXES:
        return FrankaFault.REFLEX
    if _COMMUNICATION in names:
        return FrankaFault.COMMUNICATION
    if names and all(any(word in name for word in _MOTION_WORDS) for name in names):
        return FrankaFault.MOTION_LIMITS
    return FrankaFault.ROBOT_ERROR


def state_fault(mode: FrankaMode, errors: Iterable[str]) -> FrankaFault | None:
    """Return what forbids motion in a robot state; None where nothing does."""
    names = tuple(errors)
    if mode in _FORBIDDING_MODES:
        return _FORBIDDING_MODES[mode]
    if names:
        return errors_fault(names)
    return FrankaFault.REFLEX if mode is FrankaMode.REFLEX else None


def library_fault(message: str) -> FrankaFault:
    """Return the cause that a message of the library is about."""
    names = reported_errors(message)
    if names:
        return errors_fault(names)
    return next((fault for words, fault in _MESSAGES if words in message), FrankaFault.REFUSED)


def reported_errors(text: str) -> tuple[str, ...]:
    """Return the names of errors in a message of the library, or in an error state as it writes it."""
    return tuple(_NAMES.findall(text))


def named_errors(fault: FrankaFault, errors: Iterable[str]) -> str:
    """Return a cause with the names of the errors behind it."""
    names = ", ".join(errors)
    return f"{fault.value}: {names}" if names else f"{fault.value}: the robot has stopped"
