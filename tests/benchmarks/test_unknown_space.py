"""Tests that the benchmark of unknown space measures each of its steps."""

from __future__ import annotations

from benchmarks.unknown_space import costs


def test_each_step_takes_time_and_less_than_an_image_period() -> None:
    found = costs(1)
    assert len(found) == 4
    assert all(cost_ms < 500.0 for cost_ms in found.values())
    assert sum(found.values()) > 0.0
