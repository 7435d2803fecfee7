"""The admittance as a mass, a damper and a spring, with its ends and its speed."""

from __future__ import annotations

import numpy as np
import pytest

from engine.messages import Vector6
from engine.skills.dmp import Compliance
from robots.control.force.admittance import AdmittanceLoop
from robots.port import Array

STEP_S = 0.001
NONE = np.zeros(6)
ONLY_Y: Vector6 = (0.0, 1.0, 0.0, 0.0, 0.0, 0.0)


def along_y(value: float) -> Array:
    return np.array([0.0, value, 0.0, 0.0, 0.0, 0.0])


def test_a_constant_push_ends_at_the_damper_velocity_after_the_time_of_the_mass() -> None:
    loop = AdmittanceLoop(Compliance(active=ONLY_Y))
    offsets: list[float] = []
    for _ in range(200):
        loop.press(STEP_S, measured=along_y(3.0), target=NONE, feed_forward=NONE)
        offsets.append(float(loop.total[1]))
    # 3 N against 300 N s/m make 10 mm/s, after 4 kg / 300 N s/m = 13 ms.
    assert (offsets[-1] - offsets[-2]) / STEP_S == pytest.approx(0.01, rel=1e-3)
    assert offsets[-1] == pytest.approx(0.01 * (0.2 - 4.0 / 300.0), rel=0.01)


def test_with_a_spring_a_constant_push_ends_at_its_elongation() -> None:
    loop = AdmittanceLoop(Compliance(active=ONLY_Y, stiffness=(0.0, 1000.0, 0.0, 0.0, 0.0, 0.0)))
    for _ in range(4000):
        loop.press(STEP_S, measured=along_y(5.0), target=NONE, feed_forward=NONE)
    assert loop.total[1] == pytest.approx(0.005, rel=1e-3)


def test_axes_that_are_not_active_follow_the_feed_forward_only() -> None:
    loop = AdmittanceLoop(Compliance(active=ONLY_Y))
    learned = np.array([0.001, 0.0, -0.002, 0.0, 0.0, 0.1])
    for _ in range(100):
        loop.press(STEP_S, measured=np.full(6, 20.0), target=NONE, feed_forward=learned)
    assert loop.total[[0, 2, 3, 4, 5]].tolist() == [0.001, -0.002, 0.0, 0.0, 0.1]


def test_the_whole_offset_keeps_its_reach_and_speed_and_comes_back_without_winding_up() -> None:
    loop = AdmittanceLoop(Compliance(active=ONLY_Y, reach_m=0.02, speed_m_s=0.05))
    for step in range(3000):
        before = float(loop.total[1])
        loop.press(STEP_S, measured=along_y(500.0), target=NONE, feed_forward=along_y(0.01 * min(1.0, step / 1000)))
        assert abs(loop.total[1] - before) <= 0.05 * STEP_S + 1e-12
        assert loop.total[1] <= 0.02 + 1e-12
    assert loop.total[1] == pytest.approx(0.02)
    for _ in range(100):
        loop.press(STEP_S, measured=along_y(-3.0), target=NONE, feed_forward=along_y(0.01))
    assert loop.total[1] < 0.0195


def test_giving_way_does_not_press_on_but_yields_to_more_than_is_wanted() -> None:
    loop = AdmittanceLoop(Compliance(active=ONLY_Y))
    for _ in range(300):
        loop.relieve(STEP_S, measured=NONE, target=along_y(-10.0), feed_forward=NONE)
    assert loop.total[1] == 0.0
    for _ in range(300):
        loop.relieve(STEP_S, measured=along_y(-10.9), target=along_y(-10.0), feed_forward=NONE)
    assert loop.total[1] == 0.0
    for _ in range(300):
        loop.relieve(STEP_S, measured=along_y(-30.0), target=along_y(-10.0), feed_forward=NONE)
    assert loop.total[1] < -0.01


def settled_m_s(law: Compliance, felt_n: float, wanted_n: float) -> float:
    """Return the speed along y after the time of the mass, under a constant force."""
    loop = AdmittanceLoop(law)
    before = 0.0
    for _ in range(400):
        before = float(loop.total[1])
        loop.press(STEP_S, measured=along_y(felt_n), target=along_y(wanted_n), feed_forward=NONE)
    return (float(loop.total[1]) - before) / STEP_S


@pytest.mark.parametrize(
    ("felt_n", "speed_m_s"), [(0.0, -0.01), (-0.2, -0.01013), (7.5, -0.025), (12.0, -0.01), (30.0, 0.05)]
)
def test_without_contact_the_tool_approaches_at_the_touch_speed_and_from_half_of_the_force_on_by_its_damping(
    felt_n: float, speed_m_s: float
) -> None:
    """15 N against 300 N s/m would be 50 mm/s."""
    assert settled_m_s(Compliance(active=ONLY_Y), felt_n, 15.0) == pytest.approx(speed_m_s, rel=1e-2)
    assert settled_m_s(Compliance(active=ONLY_Y), -felt_n, -15.0) == pytest.approx(-speed_m_s, rel=1e-2)


def test_a_touch_speed_beyond_that_of_the_damping_changes_nothing() -> None:
    assert settled_m_s(Compliance(active=ONLY_Y, touch_m_s=0.1), 0.0, 15.0) == pytest.approx(-0.05, rel=1e-3)


def test_where_no_force_is_wanted_the_touch_speed_does_not_matter() -> None:
    assert settled_m_s(Compliance(active=ONLY_Y, touch_m_s=0.001), 6.0, 0.0) == pytest.approx(0.02, rel=1e-3)


def test_a_share_of_the_axis_does_not_change_the_touch_speed() -> None:
    half = Compliance(active=(0.0, 0.5, 0.0, 0.0, 0.0, 0.0), touch_m_s=0.004)
    assert settled_m_s(half, 0.0, 15.0) == pytest.approx(-0.004, rel=1e-3)
