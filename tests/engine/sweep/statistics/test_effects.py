"""Effects of factors on success and duration."""

from __future__ import annotations

import pytest

from engine.sweep.statistics.effects import correlation, factor_effect, quantile


def test_a_factor_that_decides_success_has_a_strong_correlation_and_levels_that_differ() -> None:
    values = [index / 100 for index in range(100)]
    effect = factor_effect(
        "parameters.luck",
        values,
        [value < 0.5 for value in values],
        [1.0 + value for value in values],
        confidence=0.95,
    )
    assert effect.with_success is not None
    assert effect.with_success < -0.8
    assert effect.with_duration == pytest.approx(1.0)
    assert [(level.runs, level.successes) for level in effect.levels] == [(25, 25), (25, 25), (25, 0), (25, 0)]
    assert effect.spread == 1.0


def test_an_effect_without_a_direction_shows_in_the_levels_only() -> None:
    values = [-2.0, -1.0, 0.0, 1.0, 2.0] * 20
    successes = [abs(value) < 2.0 for value in values]
    effect = factor_effect(
        "displace.bolt.x_m",
        values,
        successes,
        [1.0] * 100,
        confidence=0.95,
    )
    assert effect.with_success == pytest.approx(0.0, abs=1e-9)
    assert effect.spread == 1.0
    assert [level.label for level in effect.levels] == ["-2", "-1", "0", "1", "2"]


def test_values_without_an_order_have_levels_and_no_correlation() -> None:
    effect = factor_effect(
        "faults",
        ["none", "slip.yaml", "none"],
        [True, False, True],
        [1.0, 2.0, 1.0],
        confidence=0.95,
    )
    assert (effect.with_success, effect.with_duration) == (None, None)
    assert [(level.label, level.successes, level.runs) for level in effect.levels] == [
        ("none", 2, 2),
        ("slip.yaml", 0, 1),
    ]


def test_what_always_succeeds_has_no_correlation_with_success() -> None:
    effect = factor_effect("parameters.a", [1, 2, 3], [True] * 3, [1.0, 2.0, 3.0], confidence=0.95)
    assert effect.with_success is None


@pytest.mark.parametrize(("first", "second"), [([1.0, 2.0], [1.0, 2.0]), ([1.0] * 5, [1.0, 2.0, 3.0, 4.0, 5.0])])
def test_what_does_not_vary_has_no_correlation(first: list[float], second: list[float]) -> None:
    assert correlation(first, second) is None


@pytest.mark.parametrize(("share", "value"), [(0.0, 1.0), (0.5, 2.5), (1.0, 4.0), (0.25, 1.75)])
def test_a_quantile_is_linear_between_values(share: float, value: float) -> None:
    assert quantile([1.0, 2.0, 3.0, 4.0], share) == pytest.approx(value)


def test_few_runs_with_a_number_of_their_own_are_levels_of_quarters() -> None:
    numbers = [0.1, 0.9, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8]
    effect = factor_effect("parameters.a", numbers, [True] * 8, [1.0] * 8, confidence=0.95)
    assert [level.runs for level in effect.levels] == [2, 2, 2, 2]
