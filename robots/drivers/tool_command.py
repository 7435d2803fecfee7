"""What every tool behind a connection checks before it takes a command to move."""

from __future__ import annotations

import math

from engine.errors import RobotError
from robots.drivers.device_motion import DeviceMotion


def require_values(name: str, *, positive: dict[str, float], zero_or_more: dict[str, float]) -> None:
    """Refuse values that are no speeds, forces, times or distances.

    Raises:
        RobotError: a value of a name is not finite or below zero, or zero where it must be positive.
    """
    for what, value in (positive | zero_or_more).items():
        if not math.isfinite(value) or value < 0.0 or (value == 0.0 and what in positive):
            raise RobotError(f"{what} cannot be {value}", where=name)


def require_free(name: str, *, blocked: str, motion: DeviceMotion | None) -> None:
    """Refuse to move a tool that may not, or moves already.

    Args:
        name: The tool.
        blocked: Why it may not move; empty if it may.
        motion: The active motion.

    Raises:
        RobotError: it may not move, or another motion is active.
    """
    if blocked:
        raise RobotError(blocked, where=name, hint=f"clear the cause, then: {enable_words(name)}")
    if motion is not None:
        raise RobotError("another motion is active", where=name, hint="wait for its end or cancel it")


def enable_words(name: str) -> str:
    """Return the command by which a person permits motion."""
    return f'flexcell bus call {name}/enable_device \'{{"reason": "…"}}\''
