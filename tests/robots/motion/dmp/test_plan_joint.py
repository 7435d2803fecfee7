"""Joint primitives as motions of an arm: from where it stands, at rest at both ends, within its limits."""

from __future__ import annotations

import re

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import RobotError
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import JointDmp
from robots.motion.dmp import integrate_joints, learn_joint_dmp, plan_joint_dmp
from robots.motion.dmp.plan_joint import resting_joints
from robots.motion.min_jerk import min_jerk
from robots.port import Array, JointTrajectory
from tests.robots.motion.dmp.demonstrations import led_joints, seeds
from tests.robots.motion.dmp.test_integration import new_joint_dmp
from tests.robots.panda_arm import home, panda_model, played

LIMITS, NAMES = panda_model().limits, panda_model().arm_joints
WAY = np.array([0.5, 0.3, -0.2, 0.4, 0.1, 0.2, -0.3])


def plan(dmp: JointDmp, start: Array, *, goal: Array | None = None, start_reach_rad: float = 0.1) -> JointTrajectory:
    """Plan for the Panda."""
    return plan_joint_dmp(dmp, start, limits=LIMITS, joint_names=NAMES, goal=goal, start_reach_rad=start_reach_rad)


def led_from_home(seed: int = 0, *, duration_s: float = 2.5) -> JointDmp:
    """A primitive learned on a way from home."""
    random = np.random.default_rng(seed)
    times = np.arange(0.0, duration_s + 0.6, 0.01)
    share = min_jerk((times - 0.3) / duration_s)
    joints = home() + WAY * share[:, None] + 0.1 * random.normal(size=7) * np.sin(2.0 * np.pi * share)[:, None]
    rows = tuple(tuple(row) for row in joints.tolist())
    return learn_joint_dmp(Trajectory(times_s=tuple(times.tolist()), joints=rows)).dmp


def duration_s(way: JointTrajectory) -> float:
    """How long it takes."""
    return way.duration_s


@settings(max_examples=20, deadline=None)
@given(seeds, st.floats(-0.09, 0.09), st.booleans())
def test_an_accepted_motion_starts_where_the_arm_is_and_ends_at_the_goal_at_rest(
    seed: int, aside: float, other_goal: bool
) -> None:
    """In tau, within every limit, between the samples as well."""
    dmp = led_from_home(seed)
    random = np.random.default_rng(seed)
    start = home() + aside * random.uniform(-1.0, 1.0, 7)
    goal = np.array(dmp.goal) + random.uniform(-0.15, 0.15, 7) if other_goal else None
    way = plan(dmp, start, goal=goal)
    assert (way.position_rad[0] == start).all()
    assert way.position_rad[-1] == pytest.approx(dmp.goal if goal is None else goal, abs=1e-12)
    assert not way.velocity_rad_s[[0, -1]].any()
    assert duration_s(way) == pytest.approx(dmp.tau)
    position, velocity, acceleration = played(way)
    assert (np.abs(velocity) <= np.array(LIMITS.velocity_rad_s) * (1 + 1e-6)).all()
    assert (np.abs(acceleration) <= np.array(LIMITS.acceleration_rad_s2) * (1 + 1e-6)).all()
    assert (position > np.array(LIMITS.lower_rad)).all()
    assert (position < np.array(LIMITS.upper_rad)).all()


def test_an_arm_at_the_start_follows_the_primitive_itself() -> None:
    """Within a milliradian of its roll-out all the way."""
    dmp = led_from_home()
    way = plan(dmp, np.array(dmp.y0))
    assert np.abs(way.position_rad - integrate_joints(dmp).position).max() < 1e-3


@pytest.mark.parametrize("seed", range(3))
def test_what_moves_at_the_end_of_the_primitive_comes_to_rest_there_without_a_jump(seed: int) -> None:
    """One step before the end almost nothing moves any more, in rate as in position, radians a tau."""
    dmp = learn_joint_dmp(led_joints(seed).recorded).dmp
    assert np.abs(integrate_joints(dmp).rate[-1]).max() > 2e-3
    path = resting_joints(dmp, np.array(dmp.y0))
    assert np.abs(path.rate[-2]).max() < 5e-4
    assert np.abs(path.position[-1] - path.position[-2]).max() < 5e-4 * (path.shares[-1] - path.shares[-2])


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_a_motion_that_is_not_quite_at_rest_at_its_ends_is_brought_to_rest_there(seed: int) -> None:
    """Of any primitive; rates are the slopes of the joints up to both ends, without a jump."""
    dmp = new_joint_dmp(seed, strength=20.0)
    path = resting_joints(dmp, np.array(dmp.y0) + 0.05)
    step = path.shares[1]
    slopes, means = np.diff(path.position, axis=0) / step, (path.rate[1:] + path.rate[:-1]) / 2.0
    assert (path.position[0], path.position[-1]) == (pytest.approx(np.array(dmp.y0) + 0.05), pytest.approx(dmp.goal))
    assert not path.rate[[0, -1]].any()
    assert np.abs(slopes - means).max() < 2e-3 * np.abs(path.rate).max()
    assert np.abs(slopes - means)[-50:].max() < 0.01


@settings(max_examples=15, deadline=None)
@given(seeds, st.floats(1.0, 6.0))
def test_a_longer_tau_is_the_same_way(seed: int, factor: float) -> None:
    """The positions do not change, and the speeds fall."""
    dmp = led_from_home(seed)
    slow = msgspec.structs.replace(dmp, tau=dmp.tau * factor)
    one, other = plan(dmp, home()), plan(slow, home())
    assert np.abs(one.position_rad - other.position_rad).max() < 1e-9
    assert np.abs(one.velocity_rad_s / factor - other.velocity_rad_s).max() < 1e-9


def test_too_fast_names_joint_time_and_limit_and_the_tau_it_asks_for_suffices() -> None:
    """RCL 4.3: rejected before execution."""
    dmp = msgspec.structs.replace(led_from_home(), tau=0.3)
    with pytest.raises(RobotError) as refusal:
        plan(dmp, home())
    found = re.fullmatch(
        r"(panda_joint\d) would need [\d.]+ rad/s²? at t=([\d.]+) s, limit [\d.]+, to arrive after 0.3 s"
        r" \(give it a tau of at least ([\d.]+) s\)",
        str(refusal.value),
    )
    assert found, str(refusal.value)
    assert 0.0 <= float(found[2]) <= 0.3
    least_s = float(found[3])
    plan(msgspec.structs.replace(dmp, tau=least_s), home())
    with pytest.raises(RobotError):
        plan(msgspec.structs.replace(dmp, tau=0.95 * least_s), home())


def test_an_arm_elsewhere_is_refused_with_joint_and_distance() -> None:
    """Unless it is told that it may start from there."""
    dmp = led_from_home()
    start = home().copy()
    start[1] += 0.2
    words = r"panda_joint2 is at -0\.\d+ rad, 0\.\d+ rad from the start -0\.\d+ rad of the .* \(at most 0\.1\)"
    with pytest.raises(RobotError, match=words) as refusal:
        plan(dmp, start)
    assert refusal.value.hint == "move the joints to the start y0 first"
    assert (plan(dmp, start, start_reach_rad=0.5).position_rad[0] == start).all()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (
            {"goal": (3.0, *(0.0, 0.0, -2.0, 0.0, 1.6, 0.8))},
            r"panda_joint1 would leave its range at t=\d\.\d+ s: \d\.\d+ rad, range ",
        ),
        ({"w": ((1e9,) * 10,) * 7}, "is not at rest at its goal after 8 tau"),
        ({"goal": (0.1,), "y0": (0.0,), "dy0": (0.0,), "w": ((0.0,) * 10,)}, "the movement primitive has 1 joints"),
    ],
)
def test_what_cannot_be_done_is_refused_with_the_reason(change: dict[str, object], words: str) -> None:
    """A joint limit, weights beyond all measure, another arm's primitive."""
    dmp = msgspec.convert({**msgspec.to_builtins(_with_ten_kernels()), **change}, JointDmp)
    with pytest.raises(RobotError, match=words):
        plan(dmp, home())


def test_a_goal_that_is_no_number_is_refused() -> None:
    goal = home()
    goal[2] = np.nan
    with pytest.raises(RobotError, match="the goal has a value that is not finite"):
        plan(led_from_home(), home(), goal=goal)


def test_a_task_transformation_maps_start_way_and_goal() -> None:
    """Mirrored joints make the mirrored motion, and the arm must stand at the mirrored start."""
    dmp = led_from_home()
    mirror = np.diag([-1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    mapped = msgspec.structs.replace(dmp, tasktrans=tuple(mirror.reshape(-1).tolist()))
    start = mirror @ np.array(dmp.y0)
    assert mapped.start == pytest.approx(tuple(start))
    way, plain = plan(mapped, start), plan(dmp, np.array(dmp.y0))
    assert way.position_rad == pytest.approx(plain.position_rad @ mirror, abs=1e-9)


def _with_ten_kernels() -> JointDmp:
    times = np.arange(0.0, 3.1, 0.01)
    joints = home() + WAY * min_jerk((times - 0.3) / 2.5)[:, None]
    rows = tuple(tuple(row) for row in joints.tolist())
    return learn_joint_dmp(Trajectory(times_s=tuple(times.tolist()), joints=rows), kernels=10).dmp
