"""Primitives run step by step: as rolled out, to new goals, at another speed, waiting for an arm held back."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robots.motion.dmp import (
    OnlineCartDmp,
    OnlineJointDmp,
    PhaseStopping,
    integrate_joints,
    integrate_pose,
    learn_cart_dmp,
    learn_joint_dmp,
)
from robots.motion.dmp.quaternions import conjugate, exp, log, product
from robots.port import Array
from tests.robots.motion.dmp.demonstrations import interpolated, led_joints, led_tool, seeds

STEP_S = 0.002


@settings(max_examples=5, deadline=None)
@given(seeds)
def test_steps_lead_along_the_rolled_out_path(seed: int) -> None:
    """Joints within 2 mrad, poses within 2 mm and 5 mrad, at the same times."""
    joints = learn_joint_dmp(led_joints(seed, duration_s=1.0).recorded, kernels=15).dmp
    path, running = integrate_joints(joints), OnlineJointDmp(joints)
    for share in (0.25, 0.5, 1.0):
        while running.share < share - 1e-9:
            running.step(STEP_S)
        wanted = interpolated(np.array([running.share]), path.shares, path.position)[0]
        assert running.position == pytest.approx(wanted, abs=2e-3 * 5)
    pose = learn_cart_dmp(led_tool(seed, duration_s=1.0).recorded, kernels=15).dmp
    way, tool = integrate_pose(pose), OnlineCartDmp(pose)
    while tool.share < 0.5:
        tool.step(STEP_S)
    at = int(np.argmin(np.abs(way.shares - tool.share)))
    assert tool.xyz == pytest.approx(way.xyz[at], abs=5e-3)
    assert np.linalg.norm(log(product(tool.xyzw, conjugate(way.xyzw[at])))) < 2e-2


@settings(max_examples=5, deadline=None)
@given(seeds, st.floats(0.1, 0.8), st.floats(0.2, 1.5))
def test_an_arm_held_back_stops_the_phase_and_goes_on_when_let_go(seed: int, share: float, held_s: float) -> None:
    """While it is held the movement waits near it, however long; afterwards it ends at its goal."""
    dmp = learn_joint_dmp(led_joints(seed, duration_s=2.0).recorded, kernels=15).dmp
    running = OnlineJointDmp(dmp, stopping=PhaseStopping())
    free = _follow(running, until=share)
    held = running.position.copy()
    phase = running.phase
    for _ in range(round(held_s / STEP_S)):
        running.step(STEP_S, actual=held)
    assert running.share - share < 0.15 + 0.02 * held_s
    assert 0.0 < running.phase < phase
    path = integrate_joints(dmp)
    at = int(np.argmin(np.abs(path.shares - share)))
    drive = float((np.abs(path.rate[at]) + np.abs(path.push[at]) / dmp.a_z).max())
    assert np.abs(running.position - held).max() < 1.3 * drive / PhaseStopping().a_py + 0.01
    later = _follow(running, until=1.0)
    for _ in range(round(0.5 * dmp.tau / STEP_S)):
        running.step(STEP_S, actual=running.position)
    assert running.position == pytest.approx(dmp.goal, abs=2e-3)
    assert free + later > 0.6 * dmp.tau / STEP_S


@settings(max_examples=5, deadline=None)
@given(seeds)
def test_the_phase_falls_as_published_with_the_error(seed: int) -> None:
    """tau ẋ = -a_x x / (1 + a_px e)."""
    dmp = learn_joint_dmp(led_joints(seed).recorded, kernels=10).dmp
    running = OnlineJointDmp(dmp, stopping=PhaseStopping(a_px=50.0, a_py=0.0))
    lag = np.zeros(7)
    lag[2] = 0.1
    running.step(STEP_S, actual=running.position + lag)
    assert np.log(running.phase) == pytest.approx(-dmp.a_x * STEP_S / dmp.tau / (1.0 + 50.0 * 0.1))


def test_a_tool_held_back_stops_the_phase() -> None:
    """Held in place or only in its turn."""
    dmp = learn_cart_dmp(led_tool(4, duration_s=2.0).recorded, kernels=15).dmp
    for keeps_place in (True, False):
        running = OnlineCartDmp(dmp, stopping=PhaseStopping())
        while running.share < 0.4:
            running.step(STEP_S, actual=(running.xyz, running.xyzw))
        xyz, xyzw = running.xyz.copy(), running.xyzw.copy()
        for _ in range(500):
            running.step(STEP_S, actual=(xyz if keeps_place else running.xyz, -xyzw))
        assert running.share < 0.6
        while running.share < 1.3:
            running.step(STEP_S, actual=(running.xyz, running.xyzw))
        assert running.xyz == pytest.approx(dmp.goal[:3], abs=1e-3)
        assert abs(float(running.xyzw @ np.array(dmp.goal[3:]))) == pytest.approx(1.0, abs=1e-6)


def test_an_arm_that_lags_pulls_the_motion_to_itself_as_published() -> None:
    """By `a_py` times its distance in each step, place and turn alike."""
    dmp = learn_cart_dmp(led_tool(4, duration_s=2.0).recorded, kernels=15).dmp
    one, other = (OnlineCartDmp(dmp, stopping=PhaseStopping(a_py=20.0)) for _ in range(2))
    for _ in range(100):
        one.step(STEP_S)
        other.step(STEP_S)
    lag, turn = np.array([0.01, -0.02, 0.005]), np.array([0.0, 0.03, -0.01])
    one.step(STEP_S)
    other.step(STEP_S, actual=(other.xyz + lag, product(exp(turn), other.xyzw)))
    share = 20.0 * STEP_S / dmp.tau
    assert other.xyz - one.xyz == pytest.approx(share * lag, abs=1e-9)
    assert log(product(other.xyzw, conjugate(one.xyzw))) == pytest.approx(share * turn, abs=1e-6)


@settings(max_examples=5, deadline=None)
@given(seeds, st.floats(0.0, 0.9))
def test_a_new_goal_on_the_way_is_reached_smoothly(seed: int, share: float) -> None:
    """No step of the velocity is greater than ten times the greatest one without the change."""
    dmp = learn_joint_dmp(led_joints(seed, duration_s=2.0).recorded, kernels=15).dmp
    running = OnlineJointDmp(dmp)
    random = np.random.default_rng(seed)
    goal = np.array(dmp.goal) + random.uniform(-0.3, 0.3, 7)
    speeds: list[Array] = []
    while running.share < 2.0:
        if running.share >= share:
            running.set_goal(goal)
        running.step(STEP_S)
        speeds.append(running.velocity)
    assert running.position == pytest.approx(goal, abs=1e-3)
    jump = np.abs(np.diff(np.array(speeds), axis=0)).max()
    assert jump < 0.3 * (dmp.a_z / 2.0 / dmp.tau) ** 2 * STEP_S + 0.02


def test_the_duration_can_change_on_the_way() -> None:
    """Half as fast from the middle on: the same way in one and a half times the time."""
    dmp = msgspec.structs.replace(learn_joint_dmp(led_joints(6).recorded, kernels=15).dmp, tau=1.0)
    running = OnlineJointDmp(dmp)
    first = _follow(running, until=0.5)
    running.tau_s = 2.0
    second = _follow(running, until=1.0)
    assert first * STEP_S == pytest.approx(0.5, abs=0.002)
    assert second * STEP_S == pytest.approx(1.0, abs=0.004)
    assert running.position == pytest.approx(integrate_joints(dmp).position[-1], abs=5e-3)


def _follow(running: OnlineJointDmp, *, until: float) -> int:
    """Let the arm follow perfectly; return the number of steps."""
    steps = 0
    while running.share < until - 1e-9:
        running.step(STEP_S, actual=running.position)
        steps += 1
    return steps
