"""Values of factors at probabilities."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.sweep import Factor, Normal
from engine.sweep.design.distributions import levels, nominal, share_of, value_at

SHARES = st.floats(0.001, 0.999)
CONTINUOUS = st.sampled_from(
    [Factor(uniform=(-2.0, 5.0)), Factor(log_uniform=(0.01, 100.0)), Factor(normal=Normal(mean=3.0, deviation=0.5))]
)


@given(CONTINUOUS, SHARES)
def test_the_share_of_a_value_is_where_it_was_taken(factor: Factor, share: float) -> None:
    assert share_of(factor, value_at(factor, share)) == pytest.approx(share, abs=1e-6)


@given(CONTINUOUS, SHARES, SHARES)
def test_values_grow_with_their_share(factor: Factor, first: float, second: float) -> None:
    low, high = sorted((first, second))
    below, above = value_at(factor, low), value_at(factor, high)
    assert isinstance(below, float)
    assert isinstance(above, float)
    assert below <= above


@given(st.floats(0.0, 1.0))
def test_integers_stay_in_their_range_and_the_ends_are_as_likely_as_the_rest(share: float) -> None:
    factor = Factor(uniform=(1.0, 3.0), integer=True)
    value = value_at(factor, share)
    assert value in (1, 2, 3)
    assert isinstance(value, int)
    assert value_at(factor, 0.3) == 1
    assert value_at(factor, 0.7) == 3


@given(st.floats(0.0, 1.0))
def test_values_of_a_list_are_equally_likely(share: float) -> None:
    factor = Factor(values=("a", "b", "c", "d"))
    assert value_at(factor, share) == "abcd"[min(int(4 * share), 3)]


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_an_unbounded_distribution_is_finite_at_its_ends(share: float) -> None:
    value = value_at(Factor(normal=Normal(deviation=1.0)), share)
    assert isinstance(value, float)
    assert math.isfinite(value)


def test_levels_are_the_middles_of_equally_likely_parts() -> None:
    assert levels(Factor(uniform=(0.0, 10.0), levels=5)) == (1.0, 3.0, 5.0, 7.0, 9.0)
    assert levels(Factor(uniform=(1.0, 2.0), levels=5, integer=True)) == (1, 2)
    assert levels(Factor(values=(7, 8))) == (7, 8)


@pytest.mark.parametrize(
    ("factor", "value"),
    [
        (Factor(uniform=(0.0, 4.0)), 2.0),
        (Factor(values=("none", "slip.yaml")), "none"),
        (Factor(log_uniform=(0.01, 1.0)), 0.1),
    ],
)
def test_the_nominal_value_of_a_distribution_is_its_median_and_of_a_list_the_first(
    factor: Factor, value: object
) -> None:
    assert nominal(factor) == pytest.approx(value) if isinstance(value, float) else nominal(factor) == value
