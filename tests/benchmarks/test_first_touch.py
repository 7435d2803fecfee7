"""Peaks of the first touch in physics: the bars of guarded and pressing motions."""

from __future__ import annotations

import pytest

from benchmarks.first_touch import DESIRED_N, PANDA, PEAK_N, PRESS_GAP_M, UR10, Subject, TouchRig
from robots.port import MotionEnd
from tests.tiers import nightly

FAST_M_S = 0.05


@pytest.mark.virtual
@pytest.mark.parametrize("subject", [PANDA, nightly(UR10)], ids=lambda subject: subject.model)
def test_a_guarded_motion_meets_a_rigid_surface_no_harder_than_its_peak(subject: Subject) -> None:
    """At its speed alone it would be many times as hard."""
    unlimited = TouchRig(subject, stiffness_n_m=None).touch(FAST_M_S)
    limited = TouchRig(subject, stiffness_n_m=None).touch(FAST_M_S, peak_n=PEAK_N)
    assert limited.report.contact
    assert 5.0 < limited.peak_n <= PEAK_N
    assert unlimited.peak_n > 4.0 * PEAK_N
    assert limited.duration_s < 3.5


@pytest.mark.virtual
@pytest.mark.parametrize("subject", [PANDA, nightly(UR10)], ids=lambda subject: subject.model)
def test_force_control_that_begins_above_a_rigid_surface_touches_it_with_little_more_than_is_wanted(
    subject: Subject,
) -> None:
    """By its damping alone it would touch at 50 mm/s, and again and again."""
    damped = TouchRig(subject, stiffness_n_m=None, gap_m=PRESS_GAP_M)
    gentle = TouchRig(subject, stiffness_n_m=None, gap_m=PRESS_GAP_M)
    pressed = gentle.press()
    assert pressed.report.end is MotionEnd.REACHED
    assert pressed.forces_n[-1] == pytest.approx(DESIRED_N, abs=1.0)
    assert pressed.peak_n < 25.0
    assert damped.press(touch_m_s=0.05).peak_n > 45.0
