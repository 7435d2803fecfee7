"""Simulated arms wipe a surface that gives way, with the bench of `benchmarks/force_controlled_wiping.py`."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.force_controlled_wiping import FORCE_N, PANDA, UR10, Subject, Wiping, rms, three_passes
from engine.document import RealismName
from engine.skills.arm_control import ControllerName, ControlSettings
from robots.port import MotionEnd
from tests.tiers import nightly

SETTLED_S = 0.8
ARMS_AND_LAWS = pytest.mark.parametrize(
    ("subject", "law"),
    [
        (PANDA, "joint_impedance"),
        (UR10, "cartesian_impedance"),
        nightly(PANDA, "cartesian_impedance"),
        nightly(UR10, "joint_impedance"),
    ],
    ids=["panda-joint", "ur10-cartesian", "panda-cartesian", "ur10-joint"],
)


@pytest.mark.parametrize(("realism", "most_n"), [nightly("ideal", 0.5), ("typical", 0.75)])
@ARMS_AND_LAWS
def test_on_a_flat_surface_ten_newtons_are_kept_while_moving(
    subject: Subject, law: ControllerName, realism: RealismName, most_n: float
) -> None:
    """Within half a newton by an ideal arm; noise and the offset of the sensor add a quarter."""
    settings = ControlSettings(controller=law)
    wiping = Wiping(subject, slope=0.0, length_m=0.12, settings=settings, realism=realism)
    made = wiping.wipe(learned=None, peak_m_s=0.1)
    assert made.report.end is MotionEnd.REACHED
    assert np.abs(made.steady(after_s=SETTLED_S, step_s=0.001)).max() < most_n
    assert made.record.wrenches()[-1, 2] == pytest.approx(FORCE_N, abs=most_n)


@ARMS_AND_LAWS
def test_on_an_unknown_slope_every_pass_presses_better_than_the_one_before(
    subject: Subject, law: ControllerName
) -> None:
    passes = three_passes(
        Wiping(subject, slope=0.05, length_m=0.12, settings=ControlSettings(controller=law)), peak_m_s=0.1
    )
    errors = [rms(made.steady(after_s=SETTLED_S, step_s=0.001)) for made in passes]
    assert errors[0] > 2.0 * errors[1] > 2.0 * errors[2]
    assert np.abs(passes[-1].steady(after_s=SETTLED_S, step_s=0.001)).max() < 0.5
