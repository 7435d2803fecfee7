"""Autonomy: which outcomes pass without the operator."""

from __future__ import annotations

from typing import get_args

from engine.runtime.control.autonomy import LEVELS, AutonomyLevel, passes_by_itself


def test_an_outcome_passes_by_itself_below_the_level_of_the_run_only() -> None:
    passing = {level: [required for required in LEVELS if passes_by_itself(required, level)] for level in LEVELS}
    assert passing == {"off": [], "low": ["off"], "high": ["off", "low"], "full": ["off", "low", "high"]}


def test_every_level_is_among_those_that_are_compared() -> None:
    assert get_args(AutonomyLevel) == LEVELS
