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
