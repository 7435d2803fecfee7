"""What back ends of an equipment server read and write: values of pins by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

PinValue = bool | float
"""On or off, or the duty of a PWM pin from 0 to 1."""
PinValues = Mapping[str, PinValue]
DUTY_TOLERANCE = 0.01


@dataclass(frozen=True, kw_only=True)
class PinReading:
    """All pins as the hardware has them: inputs as measured, outputs as read back."""

    values: PinValues


@dataclass(frozen=True, kw_only=True)
class PinCommand:
    """Outputs to set, together or in this order."""

    values: PinValues


def differing(commanded: PinValues, read: PinValues) -> list[str]:
    """Return the names of the outputs that are read back with another value than was set."""
    return [name for name, value in commanded.items() if abs(float(read[name]) - float(value)) > DUTY_TOLERANCE]
