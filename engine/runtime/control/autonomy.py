"""Levels of autonomy: an outcome passes by itself when it requires less than the run has."""

from __future__ import annotations

from typing import Literal

AutonomyLevel = Literal["off", "low", "high", "full"]
LEVELS: tuple[AutonomyLevel, ...] = ("off", "low", "high", "full")


def passes_by_itself(required: str, level: AutonomyLevel) -> bool:
    """Tell whether an outcome that requires `required` passes by itself in a run at `level`."""
    return LEVELS.index(required) < LEVELS.index(level)  # pyright: ignore[reportArgumentType]
