"""The control program that the script client uploads, and the registers by which both talk."""

from __future__ import annotations

from enum import IntEnum
from pathlib import Path

PROGRAM = Path(__file__).with_name("flexcell_control.script")
STOP_RAD_S2 = 4.0
STILL_RAD_S, STILL_DISTANCE_RAD = 0.001, 0.005
"""An arm that is slower stands still, and follows no single set point that is farther off."""
# Later than the program ends by itself, and later than it has stopped the arm.
_STOPPED_S = 1.0
INPUT_INTS = 7
INPUT_DOUBLES = 16
OUTPUT_INTS = 6
INPUTS = (
    *(f"input_int_register_{index}" for index in range(INPUT_INTS)),
    *(f"input_double_register_{index}" for index in range(INPUT_DOUBLES)),
)
INPUT_TYPES = ("INT32",) * INPUT_INTS + ("DOUBLE",) * INPUT_DOUBLES
STATE_OUTPUTS = tuple(f"output_int_register_{index}" for index in range(OUTPUT_INTS))


class ControlRequest(IntEnum):
    """What the program does with a set point."""

    REST = 0
    FOLLOW = 1
    END = 2


class ControlState(IntEnum):
    """What the program says of itself."""

    RUNNING = 1
    ENDED_BY_REQUEST = 2
    NO_SET_POINT = 3
    TOO_FAR = 4


def control_program(
    *,
    session: int,
    step_s: float,
    silence_limit_s: float,
    distance_limit_rad: float,
    lookahead_s: float,
    servo_gain: float,
) -> str:
    """Return the program of one session.

    Args:
        session: Its number; the program follows set points of this session only.
        step_s: Control period.
        silence_limit_s: Time without a new set point after which the program stops the arm and ends; a second later the
            controller ends it where it is paused.
        distance_limit_rad: A set point that is farther off the arm, in one joint, ends it too.
        lookahead_s: Of `servoj`.
        servo_gain: Of `servoj`.
    """
    # A line in front of the program would be executed as a program of its own.
    text = PROGRAM.read_text(encoding="utf-8").partition("\ndef ")[2]
    values: dict[str, float] = {
        "session": session,
        "step_s": step_s,
        "silence_limit_s": silence_limit_s,
        "distance_limit_rad": distance_limit_rad,
        "lookahead_s": lookahead_s,
        "servo_gain": servo_gain,
        "stop_rad_s2": STOP_RAD_S2,
        "still_rad_s": STILL_RAD_S,
        "still_distance_rad": STILL_DISTANCE_RAD,
        "rtde_watchdog_hz": 1.0 / (silence_limit_s + _STOPPED_S),
    }
    for name, value in values.items():
        text = text.replace(f"{{{{{name}}}}}", str(value))
    return f"def {text}"
