"""A number that is not finite is named, however deep in a reading it is."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

from robots.drivers.finite_values import non_finite_value

NAN, INFINITE = float("nan"), float("inf")


@dataclass(frozen=True)
class State:
    width_m: float
    joints_rad: tuple[float, ...] = ()


@dataclass(frozen=True)
class Reading:
    state: State
    count: int = 0
    words: str = "nan"


@pytest.mark.parametrize(
    ("value", "named"),
    [
        (1.0, ""),
        (Reading(State(0.08, (1.0, 2.0))), ""),
        (NAN, "the reading is nan"),
        (Reading(State(NAN)), "width_m is nan"),
        (Reading(State(0.0, (0.0, -INFINITE))), "joints_rad[1] is -inf"),
        ([0.0, NAN], "the reading[1] is nan"),
    ],
)
def test_the_first_number_that_is_not_finite_is_named(value: object, named: str) -> None:
    assert non_finite_value(value) == named
