"""Cartesian primitives as motions of an arm: the tool follows them from where it stands, or says why not."""

from __future__ import annotations

import functools

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import RobotError
from engine.messages.demonstrations import Trajectory
from engine.messages.primitives import CartDmp
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform, quaternion_of
from robots.model.transform import product as turned
from robots.motion.dmp import integrate_pose, learn_cart_dmp, plan_cart, plan_cart_dmp, transform_dmp
from robots.motion.dmp.plan_cart import resting_pose
from robots.motion.dmp.quaternions import exp, product
from robots.motion.min_jerk import min_jerk
from robots.motion.tool_path import ToolPath
from robots.port import Array, JointTrajectory
from tests.robots.motion.dmp.demonstrations import seeds
from tests.robots.motion.dmp.test_integration import new_cart_dmp
from tests.robots.panda_arm import BASE, home, panda_kinematics, panda_model, played

LIMITS = panda_model().limits


@functools.cache
def led_tool_from_home(*, move: tuple[float, float, float] = (0.1, 0.2, -0.1), duration_s: float = 2.4) -> CartDmp:
    """A primitive learned on a bow of the tool that starts where the Panda's tool is at home."""
    here = panda_kinematics().tool_pose(home())
    times = np.arange(0.0, duration_s + 0.6, 0.01)
    share = min_jerk((times - 0.3) / duration_s)[:, None]
    xyz = here.xyz + np.array(move) * share + np.array([0.0, 0.0, 0.05]) * np.sin(np.pi * share)
    xyzw = product(exp(share * np.array([0.3, 0.2, 0.6])), here.xyzw)
    rows = tuple(tuple(row) for row in np.hstack((xyz, xyzw)).tolist())
    return learn_cart_dmp(Trajectory(times_s=tuple(times.tolist()), poses=rows)).dmp


def plan(dmp: CartDmp, *, goal: RigidTransform | None = None, frame: RigidTransform | None = None) -> JointTrajectory:
    """Plan for the Panda at home."""
    if frame is None:
        return plan_cart_dmp(panda_kinematics(), dmp, home(), goal=goal)
    return plan_cart_dmp(panda_kinematics(), dmp, home(), goal=goal, frame=frame)


def goal_of(dmp: CartDmp) -> RigidTransform:
    """Where it ends."""
    return RigidTransform.of(dmp.goal[:3], dmp.goal[3:])


def test_the_tool_follows_the_primitive() -> None:
    """Within 0.5 mm and 2 mrad of its roll-out, between the samples too, from rest to rest in tau, within limits."""
    dmp = led_tool_from_home()
    way = plan(dmp)
    path = integrate_pose(dmp)
    assert (way.position_rad[0] == home()).all()
    assert not way.velocity_rad_s[[0, -1]].any()
    assert way.duration_s == pytest.approx(dmp.tau)
    position, velocity, acceleration = played(way, between=3)
    assert (np.abs(velocity) <= np.array(LIMITS.velocity_rad_s) * (1 + 1e-6)).all()
    assert (np.abs(acceleration) <= np.array(LIMITS.acceleration_rad_s2) * (1 + 1e-6)).all()
    shares = (np.arange(len(way.position_rad) - 1)[:, None] + np.linspace(0.0, 1.0, 3)).reshape(-1)
    shares = shares / (len(way.position_rad) - 1)
    for joints, share in list(zip(position, shares, strict=True))[::4]:
        at = int(np.argmin(np.abs(path.shares - share)))
        tool = panda_kinematics().tool_pose(joints)
        span = (share - path.shares[at]) * path.rate[at]
        wanted = RigidTransform(xyz=path.xyz[at] + span[:3], xyzw=turned(quaternion_of(span[3:]), path.xyzw[at]))
        assert tool.distance_m(wanted) < 5e-4
        assert tool.angle_rad(wanted) < 2e-3
    end = panda_kinematics().tool_pose(way.position_rad[-1])
    assert end.distance_m(goal_of(dmp)) < 1e-6
    assert end.angle_rad(goal_of(dmp)) < 1e-6


def test_without_forces_the_tool_is_drawn_to_its_goal_as_by_a_damped_spring() -> None:
    """At every sample, also where that falls between two steps of the integration."""
    none = (0.0,) * led_tool_from_home().N
    dmp = msgspec.structs.replace(
        led_tool_from_home(), tau=15.0, w1=none, w2=none, w3=none, w4=none, w5=none, w6=none, dy0=(0.0,) * 6
    )
    way, start, end = plan(dmp), RigidTransform.of(dmp.y0[:3], dmp.y0[3:]), goal_of(dmp)
    passed = np.linspace(0.0, dmp.a_z / 2.0, len(way.position_rad))
    for joints, left in zip(way.position_rad, (1.0 + passed) * np.exp(-passed), strict=True):
        tool = panda_kinematics().tool_pose(joints)
        assert tool.xyz == pytest.approx(end.xyz + left * (start.xyz - end.xyz), abs=2e-6)
        assert tool.angle_rad(end) == pytest.approx(left * start.angle_rad(end), abs=1e-3)


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_a_motion_that_is_not_quite_at_rest_at_its_ends_is_brought_to_rest_there(seed: int) -> None:
    """Of any primitive; rates are the slopes of the places up to both ends, without a jump of the acceleration."""
    dmp = msgspec.structs.replace(new_cart_dmp(seed, strength=20.0), dy0=(0.1, -0.2, 0.1, 0.2, 0.1, -0.1))
    path = resting_pose(dmp, RigidTransform.of(dmp.y0[:3], dmp.y0[3:]))
    step = path.shares[1]
    slopes, means = np.diff(path.xyz, axis=0) / step, (path.rate[1:, :3] + path.rate[:-1, :3]) / 2.0
    assert path.xyz[-1] == pytest.approx(dmp.goal[:3])
    assert path.rate[[0, -1]] == pytest.approx(np.zeros((2, 6)), abs=1e-9)
    assert np.abs(slopes - means).max() < 2e-3 * np.abs(path.rate).max()
    # What pushes in the end may be next to nothing by chance (seed 230).
    least = 1e-5 * np.abs(path.rate).max()
    assert np.abs(path.rate[-2]).max() < 0.3 * step * np.abs(path.push[-1]).max() + least


offsets = st.tuples(*[st.floats(-0.1, 0.1)] * 3).map(np.array)


@settings(max_examples=6, deadline=None)
@given(offsets, offsets, st.sampled_from([1.0, -1.0]))
def test_another_goal_is_reached_in_the_same_time(shift: np.ndarray, turn: np.ndarray, sign: float) -> None:
    """Exactly, whichever sign its quaternion has; a motion that the arm cannot make is refused."""
    dmp = led_tool_from_home()
    old = goal_of(dmp)
    goal = RigidTransform(xyz=old.xyz + shift, xyzw=sign * turned(quaternion_of(turn), old.xyzw))
    way = plan(dmp, goal=goal)
    end = panda_kinematics().tool_pose(way.position_rad[-1])
    assert end.distance_m(goal) < 1e-6
    assert end.angle_rad(goal) < 1e-5
    assert way.duration_s == pytest.approx(dmp.tau)


@settings(max_examples=6, deadline=None)
@given(st.tuples(*[st.floats(-0.015, 0.015)] * 3), st.tuples(*[st.floats(-0.1, 0.1)] * 3))
def test_a_start_beside_the_primitives_own_fades_out(
    shift: tuple[float, float, float], turn: tuple[float, float, float]
) -> None:
    """The arm starts where it stands and ends at the goal."""
    dmp = led_tool_from_home()
    there = RigidTransform(xyz=np.array(dmp.y0[:3]), xyzw=np.array([0.0, 0.0, 0.0, 1.0]))
    move = RigidTransform(xyz=there.xyz + np.array(shift), xyzw=quaternion_of(np.array(turn)))
    beside = transform_dmp(dmp, move.then(there.inverse()), frame="world")
    way = plan(beside)
    assert (way.position_rad[0] == home()).all()
    assert panda_kinematics().tool_pose(way.position_rad[-1]).distance_m(goal_of(beside)) < 1e-6


def test_a_primitive_given_in_the_arms_frame_or_moved_by_its_task_transformation_is_the_same_motion() -> None:
    """Said in the base frame, and said elsewhere and brought here by `tasktrans`."""
    dmp = led_tool_from_home()
    plain = plan(dmp)
    in_base = transform_dmp(dmp, BASE.inverse(), frame="left/panda_link0")
    assert np.abs(plan(in_base, frame=BASE).position_rad - plain.position_rad).max() < 1e-6
    away = RigidTransform(xyz=np.array([0.3, -0.2, 0.1]), xyzw=quaternion_of(np.array([0.4, -0.9, 1.2])))
    back = away.inverse()
    matrix = np.vstack((np.hstack((back.rotation, back.xyz[:, None])), [0.0, 0.0, 0.0, 1.0]))
    elsewhere = msgspec.structs.replace(
        transform_dmp(dmp, away, frame="world"), tasktrans=tuple(matrix.reshape(-1).tolist())
    )
    assert np.abs(plan(elsewhere).position_rad - plain.position_rad).max() < 1e-6
    start = RigidTransform.from_pose(elsewhere.start)
    assert start.distance_m(RigidTransform.of(dmp.y0[:3], dmp.y0[3:])) < 1e-9
    assert start.angle_rad(RigidTransform.of(dmp.y0[:3], dmp.y0[3:])) < 1e-7


def test_too_fast_is_refused_and_the_tau_it_asks_for_suffices() -> None:
    """Joint, time and limit are in the message."""
    dmp = msgspec.structs.replace(led_tool_from_home(), tau=0.4)
    with pytest.raises(RobotError, match=r"panda_joint\d would need .* at t=0\.\d+ s, limit") as refusal:
        plan(dmp)
    least_s = float(str(refusal.value.hint).rpartition("least ")[2].removesuffix(" s"))
    assert least_s > 0.4
    # The knots lie elsewhere on a slower motion, so the least time is exact within a few percent only.
    plan(msgspec.structs.replace(dmp, tau=1.05 * least_s))


@pytest.mark.parametrize(
    ("move", "words"),
    [
        ((0.7, 0.3, 0.0), "the movement (passes a singularity|leaves the workspace)"),
        ((0.0, 0.0, -1.2), "the movement (passes|leaves|cannot)|would leave its range"),
    ],
)
def test_a_path_that_the_arm_cannot_follow_is_refused(move: tuple[float, float, float], words: str) -> None:
    with pytest.raises(RobotError, match=words):
        plan(led_tool_from_home(move=move, duration_s=5.0))


def test_how_far_a_short_path_can_be_followed_is_a_share_of_its_own_length(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 10 cm as of metres: the end is at 1, which messages show as 100%."""
    paths: list[ToolPath] = []

    def refused(_kinematics: ArmKinematics, _start: Array, path: ToolPath) -> Array:
        paths.append(path)
        raise RobotError("refused")

    monkeypatch.setattr(plan_cart, "follow_tool_path", refused)
    with pytest.raises(RobotError, match="refused"):
        plan(led_tool_from_home(move=(0.1, 0.0, 0.0)))
    (path,) = paths
    assert (path.shares[0], path.shares[-1]) == (0.0, pytest.approx(1.0))
    assert (np.diff(path.shares) >= 0.0).all()


def test_a_tool_elsewhere_is_refused_with_the_distance() -> None:
    """With the place where the primitive starts."""
    dmp = led_tool_from_home()
    away = msgspec.structs.replace(dmp, y0=(dmp.y0[0] + 0.2, *dmp.y0[1:]))
    with pytest.raises(
        RobotError, match=r"the tool is 0\.200 m and 0\.00 rad from the start \(.*\) of the movement primitive"
    ):
        plan(away)
