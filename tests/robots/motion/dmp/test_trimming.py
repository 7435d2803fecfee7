"""Where a recorded motion begins and ends, with a little rest at either end."""

from __future__ import annotations

import numpy as np
import pytest

from engine.errors import RobotError
from robots.motion.dmp.smoothing import RestEnds
from robots.motion.dmp.trimming import MotionChannel, find_motion_window
from robots.motion.min_jerk import min_jerk
from robots.port import Array

REST = 2e-3
TIMES = np.arange(385) / 128.0


def rest_ends(joint: Array) -> RestEnds:
    """At which ends of its motion a joint is at rest."""
    return find_motion_window(TIMES, [MotionChannel(values=joint[:, None], rest=REST)]).rest_ends


@pytest.mark.parametrize("samples", [1, 2, 9])
def test_too_few_samples_are_refused_before_anything_is_computed(samples: int) -> None:
    times = TIMES[:samples]
    with pytest.raises(RobotError, match=rf"has {samples} samples \(record at least 10 of the motion\)"):
        find_motion_window(times, [MotionChannel(values=np.zeros((samples, 1)), rest=REST)])


def test_the_window_is_that_of_the_motion_whenever_the_recording_began() -> None:
    """A recorder's clock need not start at 0."""
    channel = MotionChannel(values=min_jerk((TIMES - 0.5) / 2.0)[:, None], rest=REST)
    window = find_motion_window(TIMES, [channel])
    assert window == find_motion_window(TIMES + 1024.0, [channel])
    begin_s, end_s = float(TIMES[window.taken][0]), float(TIMES[window.taken][-1])
    assert 0.35 < begin_s < 0.6
    assert 2.4 < end_s < 2.65
    assert window.rest_ends.start
    assert window.rest_ends.end


def test_a_tenth_of_a_second_of_rest_is_rest_and_none_is_none() -> None:
    """At each end by itself."""
    turns = np.sin(TIMES) + 2.0 * TIMES
    assert rest_ends(turns) == RestEnds(start=False, end=False)
    assert rest_ends(min_jerk((TIMES - 0.05) / 2.9)) == RestEnds(start=True, end=True)
    assert rest_ends(min_jerk(0.5 * (TIMES - 0.05) / 2.9)) == RestEnds(start=True, end=False)
    assert rest_ends(min_jerk(0.5 + 0.5 * (TIMES - 0.05) / 2.9)) == RestEnds(start=False, end=True)
