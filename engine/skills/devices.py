"""Skill of real devices: a person permits motion, after a connection was lost or a fault occurred."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.messages.device_state import DeviceState
from engine.skill import Service

LEAST_REASON = 3
"""A reason has so many characters at least."""


class EnableDevice(Service[DeviceState], frozen=True, kw_only=True):
    """Permit motion: activates the device, clears its faults, and returns its state. Its fingers or joints may move.

    Refused while a run commands the device, so no behavior enables a device by itself. The reason is logged.
    """

    reason: Annotated[
        str,
        Meta(
            min_length=LEAST_REASON,
            max_length=500,
            # Blanks are no reason.
            pattern=r"\S.*\S",
            description="Why it is permitted, in words, for the log",
        ),
    ]
    by: Annotated[str, Meta(max_length=100, description="Who permits it, for the log")] = ""
