"""What a SoftHand measures and what it is commanded, in its own units: encoder ticks and milliampere."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class HandReading:
    """What the hand says.

    Attributes:
        active: Whether the motor is on.
        reference_ticks: The position that it follows.
        before_ticks: The position that it followed just before a command since the last reading; without one, as above.
        position_ticks: Its measured position.
        current_ma: Its measured motor current.
    """

    active: bool
    reference_ticks: int
    before_ticks: int
    position_ticks: int
    current_ma: int


@dataclass(frozen=True, kw_only=True)
class HandReference:
    """Follow a position."""

    ticks: int


@dataclass(frozen=True, kw_only=True)
class HandActivation:
    """Switch the motor on or off."""

    on: bool


HandCommand = HandReference | HandActivation
