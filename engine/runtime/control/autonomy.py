"""Autonomy levels: an outcome passes without confirmation when it requires less than the level of the run."""

from __future__ import annotations

from typing import Literal

AutonomyLevel = Literal["off", "low", "high", "full"]
LEVELS: tuple[AutonomyLevel, ...] = ("off", "low", "high", "full")


def passes_by_itself(required: str, level: AutonomyLevel) -> bool:
    """Return whether an outcome that requires `required` passes without confirmation in a run at `level`."""
    return LEVELS.index(required) < LEVELS.index(level)  # pyright: ignore[reportArgumentType]
