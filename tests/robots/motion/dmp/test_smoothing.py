"""The spline through a recording: at rest where the arm was, as fast as it was elsewhere, and not through its noise."""

from __future__ import annotations

import numpy as np
import pytest

from robots.motion.dmp.smoothing import RestEnds, smooth


@pytest.mark.parametrize(("samples", "pieces"), [(10, 1), (12, 2), (15, 3), (60, 18), (100, 20)])
def test_each_piece_has_samples_enough_of_its_own(samples: int, pieces: int) -> None:
    """Three more for every further piece; never more pieces than were allowed."""
    shares = np.linspace(0.0, 1.0, samples)
    motion = smooth(shares, shares[:, None], intervals=20, rest_ends=RestEnds(start=False, end=False))
    assert motion.pieces == pieces


@pytest.mark.parametrize("samples", [10, 16, 200])
@pytest.mark.parametrize(("start", "end"), [(False, False), (True, False), (False, True), (True, True)])
def test_a_motion_is_at_rest_at_the_ends_where_it_was_and_moves_at_the_others(
    samples: int, start: bool, end: bool
) -> None:
    """Without rate and acceleration there, however few samples there are."""
    shares = np.linspace(0.0, 1.0, samples)
    motion = smooth(shares, (shares + 0.5 * shares**2)[:, None], intervals=20, rest_ends=RestEnds(start=start, end=end))
    _, rates, pushes = motion.at(np.array([0.0, 1.0]))
    at_rest = [abs(rate) < 1e-9 and abs(push) < 1e-6 for rate, push in zip(rates[:, 0], pushes[:, 0], strict=True)]
    assert at_rest == [start, end]
    if not (start or end):
        assert rates[:, 0] == pytest.approx([1.0, 2.0], abs=1e-6)
