"""The distributions that cross-entropy draws from."""

from __future__ import annotations

import math
import random

import pytest

from engine.document.sweep import Factor
from engine.sweep.search.proposal import ListProposal, NumberProposal, written_proposals

MOVED = NumberProposal(mean=1.5, deviation=0.4)
UNEVEN = ListProposal(chances=(0.7, 0.1, 0.2))


@pytest.mark.parametrize("share", [1e-9, 0.25, 0.5, 0.999])
def test_as_written_a_share_stays_as_it_is_with_density_one(share: float) -> None:
    for proposal in written_proposals({"a": Factor(uniform=(0.0, 1.0)), "b": Factor(values=("x", "y", "z"))}):
        assert proposal.draw(share) == pytest.approx(share, rel=1e-6)
        assert proposal.log_density(share) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("proposal", [MOVED, UNEVEN], ids=["numbers", "list"])
def test_the_density_is_that_of_what_is_drawn(proposal: NumberProposal | ListProposal) -> None:
    """The share of draws below 0.9 is the integral of the density up to there."""
    source, runs = random.Random(3), 20_000
    drawn = sum(proposal.draw(source.random()) < 0.9 for _ in range(runs)) / runs
    steps = 20_000
    integral = sum(math.exp(proposal.log_density((i + 0.5) / steps)) for i in range(steps) if (i + 0.5) / steps < 0.9)
    assert drawn == pytest.approx(integral / steps, abs=0.01)


def test_a_distribution_moves_to_its_points_and_stays_wide_while_it_moves() -> None:
    points = [0.97, 0.98, 0.99]
    moving = NumberProposal().fitted(points, [1.0] * 3)
    assert 1.2 < moving.mean < 2.1
    assert moving.deviation > 1.0
    for _ in range(30):
        moving = moving.fitted(points, [1.0] * 3)
    assert moving.mean == pytest.approx(2.09, abs=0.02)
    assert moving.deviation == pytest.approx(0.18, abs=0.02)


def test_no_value_of_a_list_is_given_up() -> None:
    fitted = ListProposal(chances=(0.25,) * 4)
    for _ in range(50):
        fitted = fitted.fitted([0.3], [1.0])
    assert sum(fitted.chances) == pytest.approx(1.0)
    assert fitted.chances[1] > 0.75
    assert min(fitted.chances) >= 0.05
