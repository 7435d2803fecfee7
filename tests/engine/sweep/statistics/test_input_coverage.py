"""What runs have covered of what is varied."""

from __future__ import annotations

import pytest

from engine.document.sweep import Factor, Normal
from engine.sweep.statistics.input_coverage import FactorCoverage, PairCoverage, input_coverage

SPEED, FAULTS = "parameters.speed", "faults"
FACTORS = {SPEED: Factor(uniform=(0.0, 2.0)), FAULTS: Factor(values=("none", "slip.yaml"))}


def test_parts_of_a_distribution_are_equally_likely_and_those_of_a_list_are_its_values() -> None:
    runs = [{SPEED: speed, FAULTS: "none"} for speed in (0.1, 0.15, 0.5, 1.9)]
    found = input_coverage(FACTORS, runs)
    speed, faults = found.factors
    assert (speed.parts, speed.covered, speed.share) == (10, 3, 0.3)
    assert speed.gap == pytest.approx((0.5, 1.9))
    assert speed.gap_share == pytest.approx(0.7)
    assert faults == FactorCoverage(address=FAULTS, parts=2, covered=1, gap=None, gap_share=None)
    assert found.pairs == [PairCoverage(first=SPEED, second=FAULTS, parts=20, covered=3)]


def test_a_pair_may_be_empty_where_both_factors_are_covered() -> None:
    diagonal = [{"a": (index + 0.5) / 10, "b": (index + 0.5) / 10, "c": 0.5} for index in range(10)]
    found = input_coverage({name: Factor(uniform=(0.0, 1.0)) for name in "abc"}, diagonal)
    assert [each.share for each in found.factors] == [1.0, 1.0, 0.1]
    assert [(each.first, each.second, each.share) for each in found.pairs] == [
        ("a", "b", 0.1),
        ("a", "c", 0.1),
        ("b", "c", 0.1),
    ]


def test_a_gap_in_the_tail_of_a_distribution_is_as_wide_as_it_is_likely() -> None:
    factor = Factor(normal=Normal(deviation=1.0))
    (found,) = input_coverage({"x": factor}, [{"x": value} for value in (-2.0, -1.0, -0.5, 0.0)]).factors
    assert found.gap is not None
    assert found.gap[0] == pytest.approx(0.0, abs=1e-9)
    assert found.gap_share == pytest.approx(0.5)


def test_without_a_run_nothing_is_covered_and_the_gap_is_everything() -> None:
    found = input_coverage(FACTORS, [])
    assert [each.covered for each in found.factors] == [0, 0]
    assert found.factors[0].gap == pytest.approx((0.0, 2.0), abs=1e-9)
    assert [each.covered for each in found.pairs] == [0]


def test_a_value_that_a_factor_does_not_have_covers_nothing() -> None:
    factors = {"parameters.a": Factor(values=(1, 2, 4)), "parameters.b": Factor(uniform=(0.0, 1.0))}
    runs = [{"parameters.a": a, "parameters.b": b} for a, b in [(1, "fast"), (4, 0.3), (4, 0.3), (8, 0.3)]]
    assert [(each.covered, each.parts) for each in input_coverage(factors, runs).factors] == [(2, 3), (1, 10)]
