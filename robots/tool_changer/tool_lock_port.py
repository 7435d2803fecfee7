"""The port of a tool changer: its output and its sensors. Behind it is a simulation, or pins."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, kw_only=True)
class LockReading:
    """Output and sensors of a lock: `on` presses it shut, `locked` it has a tool, `present` a plate is at the face.

    `tool` is the name that the plate tells by its coded pins; empty where nothing tells it.
    """

    on: bool
    locked: bool
    present: bool
    tool: str = ""


class ToolLockPort(Protocol):
    """Opens and shuts one lock."""

    def switch(self, *, on: bool) -> None:
        """Turn the output on or off; the lock takes its time. Raises RobotError."""
        ...

    def reading(self) -> LockReading:
        """Return output and sensors; raises RobotError where they are not known."""
        ...
