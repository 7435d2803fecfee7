"""The correction at the ends of a primitive: it begins as given, fades out, and its rate is its slope."""

from __future__ import annotations

import numpy as np
import pytest

from robots.motion.dmp.boundary_conditions import fade, fade_in, is_negligible

SHARES = np.linspace(0.0, 1.0, 2001)
VALUE, RATE, PUSH = np.array([0.3, -0.1]), np.array([-1.5, 0.4]), np.array([8.0, 3.0])


def test_a_correction_begins_as_given_and_is_gone_after_its_width() -> None:
    """Its rate is the slope of its values everywhere, so the arm is commanded no velocity that it does not have."""
    values, rates = fade(SHARES, 0.4, value=VALUE, rate=RATE, push=PUSH)
    assert values[0] == pytest.approx(VALUE)
    assert rates[0] == pytest.approx(RATE)
    assert np.gradient(rates, SHARES, axis=0, edge_order=2)[0] == pytest.approx(PUSH, rel=0.01)
    assert np.abs(values[SHARES >= 0.4]).max() == pytest.approx(0.0, abs=1e-12)
    assert np.abs(rates[SHARES >= 0.4]).max() == pytest.approx(0.0, abs=1e-12)
    assert np.abs(np.gradient(values, SHARES, axis=0) - rates)[1:-1].max() < 2e-3


def test_without_a_push_a_correction_begins_without_acceleration() -> None:
    plain = fade(SHARES, 0.4, value=VALUE, rate=RATE)
    assert np.array_equal(plain, fade(SHARES, 0.4, value=VALUE, rate=RATE, push=np.zeros(2)))


def test_a_correction_of_the_end_is_one_of_the_start_backwards() -> None:
    values, rates = fade_in(SHARES, 0.25, value=VALUE, rate=RATE, push=PUSH)
    assert (values[-1], rates[-1]) == (pytest.approx(VALUE), pytest.approx(RATE))
    assert np.gradient(rates, SHARES, axis=0, edge_order=2)[-1] == pytest.approx(PUSH, rel=0.01)
    assert np.abs(values[SHARES <= 0.75]).max() == pytest.approx(0.0, abs=1e-12)
    assert np.abs(np.gradient(values, SHARES, axis=0) - rates)[1:-1].max() < 2e-3


@pytest.mark.parametrize(
    ("value", "rate", "push", "negligible"),
    [(0.01, 0.0, 0.0, True), (0.011, 0.0, 0.0, False), (0.0, 0.1, 0.0, True), (0.0, 0.11, 0.0, False),
     (0.0, 0.0, 1.0, True), (0.0, 0.0, -1.1, False)],
)  # fmt: skip
def test_an_end_is_at_rest_when_its_error_and_what_becomes_of_it_are_small(
    value: float, rate: float, push: float, negligible: bool
) -> None:
    """A rate counts as far as the attractor lets it lead: its pole is at half of `a_z`."""
    ends = [np.array([0.0, each]) for each in (value, rate, push)]
    assert is_negligible(ends[0], ends[1], ends[2], a_z=20.0, least=0.01) is negligible
