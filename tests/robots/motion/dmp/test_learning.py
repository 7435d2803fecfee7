"""Primitives learned from demonstrations end at their goals, follow them, and say how well."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.errors import RobotError
from engine.messages.demonstrations import Trajectory
from robots.motion.dmp import integrate_joints, integrate_pose, learn_cart_dmp, learn_joint_dmp
from robots.motion.dmp.quaternions import conjugate, exp, log, product, toward
from robots.motion.min_jerk import min_jerk
from robots.port import Array
from tests.robots.motion.dmp.demonstrations import interpolated, led_joints, led_tool, seeds
from tests.tiers import examples

TENTH_OF_A_DEGREE = math.radians(0.1)


def angle_rad(first: Array, second: Array) -> float:
    """The angle between two orientations, whichever sign the quaternions have."""
    return float(np.linalg.norm(log(product(toward(first, second), conjugate(second)))))


@settings(max_examples=examples(10, nightly=50), deadline=None)
@given(seeds, st.floats(0.8, 8.0), st.sampled_from([0.002, 0.01]))
def test_a_joint_primitive_ends_where_the_demonstration_did(seed: int, duration_s: float, period_s: float) -> None:
    """Within 0.1°, and it is never more than 3 mrad off on the way."""
    led = led_joints(seed, duration_s=duration_s, period_s=period_s)
    learned = learn_joint_dmp(led.recorded)
    path = integrate_joints(learned.dmp)
    assert np.abs(path.position[-1] - led.truth[-1]).max() < TENTH_OF_A_DEGREE
    assert learned.fit.max_rad < 3e-3
    assert learned.fit.end_rad < TENTH_OF_A_DEGREE


@settings(max_examples=examples(10, nightly=50), deadline=None)
@given(seeds, st.floats(0.8, 8.0), st.floats(0.0, 4.0))
def test_a_cartesian_primitive_ends_where_the_demonstration_did(seed: int, duration_s: float, turn_rad: float) -> None:
    """Within 1 mm and 0.1°, also past half a turn and with quaternions of either sign."""
    led = led_tool(seed, duration_s=duration_s, turn_rad=turn_rad)
    learned = learn_cart_dmp(led.recorded)
    path = integrate_pose(learned.dmp)
    assert np.linalg.norm(path.xyz[-1] - led.truth[-1, :3]) < 1e-3
    assert angle_rad(path.xyzw[-1], led.truth[-1, 3:]) < TENTH_OF_A_DEGREE
    assert learned.fit.max_m < 2e-3
    assert learned.fit.max_rad < 1e-2


@settings(max_examples=10, deadline=None)
@given(seeds, st.floats(1e-5, 1e-3))
def test_noise_is_smoothed_and_not_learned(seed: int, noise_rad: float) -> None:
    """The rolled out motion is nearer to the truth than the samples are, and its end much nearer."""
    led = led_joints(seed, noise_rad=noise_rad)
    learned = learn_joint_dmp(led.recorded)
    path = integrate_joints(learned.dmp)
    times = np.array(led.recorded.times_s)
    taken = (times >= learned.fit.cut.start_s - 1e-9) & (times <= learned.fit.cut.end_s + 1e-9)
    shares = (times[taken] - learned.fit.cut.start_s) / learned.dmp.tau
    rolled = interpolated(shares, path.shares, path.position)
    error = np.sqrt(((rolled - led.truth[taken]) ** 2).mean())
    assert error < max(0.7 * noise_rad, 3e-4)
    assert np.abs(path.position[-1] - led.truth[-1]).max() < max(2.5 * noise_rad, 1e-3)


@settings(max_examples=examples(10, nightly=40), deadline=None)
@given(seeds, st.floats(0.0, 5e-4))
def test_the_reported_error_is_that_of_the_rolled_out_motion(seed: int, noise_rad: float) -> None:
    """Root mean square and maximum over the samples that were used, and the joint that has it."""
    led = led_joints(seed, noise_rad=noise_rad)
    learned = learn_joint_dmp(led.recorded, kernels=20)
    times, cut = np.array(led.recorded.times_s), learned.fit.cut
    taken = (times >= cut.start_s - 1e-9) & (times <= cut.end_s + 1e-9)
    path = integrate_joints(learned.dmp)
    shares = (times[taken] - cut.start_s) / learned.dmp.tau
    rolled = interpolated(shares, path.shares, path.position)
    error = np.abs(rolled - np.array(led.recorded.joints)[taken])
    assert learned.fit.max_rad == pytest.approx(error.max())
    assert learned.fit.rms_rad == pytest.approx(np.sqrt((error**2).mean()))
    assert learned.fit.joint == int(error.max(axis=0).argmax())


@settings(max_examples=10, deadline=None)
@given(seeds, st.floats(0.2, 2.0), st.floats(0.0, 5e-4))
def test_rest_at_both_ends_is_cut_off(seed: int, rest_s: float, noise_rad: float) -> None:
    """The primitive takes as long as the motion did, but for slow beginnings and a little rest."""
    led = led_joints(seed, rest_s=rest_s, noise_rad=noise_rad)
    learned = learn_joint_dmp(led.recorded)
    assert led.moving_s - 0.4 < learned.dmp.tau < led.moving_s + 0.25
    assert learned.dmp.dy0 == pytest.approx((0.0,) * 7, abs=1e-9)
    whole = learn_joint_dmp(led.recorded, trim=False)
    assert whole.dmp.tau == pytest.approx(led.moving_s + 2.0 * rest_s, abs=0.02)


def test_more_kernels_follow_more_closely() -> None:
    """The number asked for is the number taken; the error falls with it."""
    led = led_joints(3)
    fits = [learn_joint_dmp(led.recorded, kernels=number).fit for number in (6, 12, 24, 48)]
    assert [fit.kernels for fit in fits] == [6, 12, 24, 48]
    errors = [fit.rms_rad for fit in fits]
    assert errors == sorted(errors, reverse=True)
    assert errors[-1] < errors[0] / 20


def test_many_kernels_are_fitted_at_more_points() -> None:
    """Twenty waves in one motion are followed within 0.4 mrad, which takes more points than for 40 kernels."""
    times = np.arange(0.0, 2.0, 0.004)
    share = times / times[-1]
    joints = np.column_stack([min_jerk(share), 0.05 * np.sin(40.0 * np.pi * share) * np.sin(np.pi * share)])
    recorded = Trajectory(times_s=tuple(times.tolist()), joints=tuple(tuple(row) for row in joints.tolist()))
    assert learn_joint_dmp(recorded, kernels=130, trim=False).fit.max_rad < 4e-4


def test_noise_does_not_make_the_fit_take_many_kernels() -> None:
    """Kernels that only follow the noise are not worth their while."""
    assert learn_joint_dmp(led_joints(5, noise_rad=1e-3).recorded).fit.kernels <= 40


def test_a_recording_that_begins_in_motion_is_learned_with_its_speed() -> None:
    """`dy0` is what the arm did at the first sample."""
    times = np.linspace(0.0, 2.0, 201)
    joints = np.column_stack([0.5 * times - 0.125 * times**2, np.sin(times)])
    recorded = Trajectory(times_s=tuple(times.tolist()), joints=tuple(tuple(row) for row in joints.tolist()))
    learned = learn_joint_dmp(recorded)
    assert learned.dmp.dy0 == pytest.approx((0.5, 1.0), abs=5e-3)
    assert learned.fit.max_rad < 2e-3


def test_a_tool_that_is_in_motion_at_both_ends_is_learned_with_its_poses_and_speeds() -> None:
    """`y0` and `goal` are where it was at the first and at the last sample."""
    times = np.linspace(0.0, 1.0, 51)
    xyz, turns = times[:, None] * np.array([0.3, -0.1, 0.2]), times[:, None] * np.array([0.0, 0.8, 0.0])
    poses = np.hstack((xyz, exp(turns)))
    learned = learn_cart_dmp(Trajectory(times_s=tuple(times.tolist()), poses=tuple(map(tuple, poses.tolist()))))
    assert learned.dmp.dy0 == pytest.approx((0.3, -0.1, 0.2, 0.0, 0.8, 0.0), abs=1e-6)
    assert learned.dmp.y0 == pytest.approx(poses[0], abs=1e-6)
    assert learned.dmp.goal == pytest.approx(poses[-1], abs=1e-6)
    assert learned.fit.max_m < 2e-3


@pytest.mark.parametrize("turn_rad", [1.0, 4.0])
def test_the_reported_error_of_a_tool_is_that_of_the_rolled_out_motion(turn_rad: float) -> None:
    """Root mean square and maximum of places and angles, and both at the end, past half a turn too."""
    led = led_tool(2, noise_m=2e-4, noise_rad=1e-3, turn_rad=turn_rad)
    learned = learn_cart_dmp(led.recorded, kernels=20)
    path, times, cut = integrate_pose(learned.dmp), np.array(led.recorded.times_s), learned.fit.cut
    taken = (times >= cut.start_s - 1e-9) & (times <= cut.end_s + 1e-9)
    shares = (times[taken] - cut.start_s) / learned.dmp.tau
    recorded = np.array(led.recorded.poses)[taken]
    away = np.linalg.norm(interpolated(shares, path.shares, path.xyz) - recorded[:, :3], axis=1)
    turns = interpolated(shares, path.shares, path.xyzw)
    pairs = zip(turns / np.linalg.norm(turns, axis=1, keepdims=True), recorded[:, 3:], strict=True)
    angles = np.array([angle_rad(one, other) for one, other in pairs])
    fit = learned.fit
    assert (fit.max_m, fit.rms_m) == pytest.approx((away.max(), np.sqrt((away**2).mean())))
    assert (fit.max_rad, fit.rms_rad) == pytest.approx((angles.max(), np.sqrt((angles**2).mean())), rel=1e-5)
    assert fit.end_m == pytest.approx(np.linalg.norm(path.xyz[-1] - np.array(learned.dmp.goal[:3])), rel=1e-6)
    assert fit.end_rad == pytest.approx(angle_rad(path.xyzw[-1], np.array(learned.dmp.goal[3:])), rel=1e-6)


def test_a_recording_may_begin_at_any_time() -> None:
    """What was cut off counts from its first sample."""
    times = np.arange(320) / 128.0
    joints = tuple((angle, -angle) for angle in min_jerk((times - 0.25) / 2.0).tolist())
    recordings = [Trajectory(times_s=tuple((times + since_s).tolist()), joints=joints) for since_s in (0.0, 512.0)]
    early, late = map(learn_joint_dmp, recordings)
    assert late == early


def test_uneven_samples_with_a_gap_are_learned() -> None:
    """A recorder that lost a tenth of a second leaves the rest as it is."""
    led = led_joints(8)
    kept = [k for k in range(len(led.recorded.times_s)) if not 150 <= k < 160 and k % 7 != 3]
    recorded = Trajectory(
        times_s=tuple(led.recorded.times_s[k] for k in kept), joints=tuple(led.recorded.joints[k] for k in kept)
    )
    path = integrate_joints(learn_joint_dmp(recorded).dmp)
    assert np.abs(path.position[-1] - led.truth[-1]).max() < TENTH_OF_A_DEGREE


def test_a_whole_turn_of_the_tool_is_refused() -> None:
    """There the way to the goal is not defined."""
    with pytest.raises(RobotError, match="in the recording, which one primitive cannot represent"):
        learn_cart_dmp(led_tool(1, turn_rad=7.0).recorded)


def test_the_last_sample_counts_for_how_far_the_tool_turns() -> None:
    """Also where it still turns fast."""
    turns = np.linspace(0.0, 6.1, 12)[:, None] * np.array([0.0, 0.0, 1.0])
    poses = np.hstack((np.zeros((12, 3)), exp(turns)))
    recorded = Trajectory(times_s=tuple(k / 10 for k in range(12)), poses=tuple(map(tuple, poses.tolist())))
    with pytest.raises(RobotError, match="the tool turns by 350° in the recording"):
        learn_cart_dmp(recorded)


@pytest.mark.parametrize(
    ("recorded", "words"),
    [
        (Trajectory(times_s=(0.0, 1.0), joints=((0.0,), (1.0,))), "the recording has 2 samples"),
        (
            Trajectory(times_s=tuple(k / 50 for k in range(100)), joints=((0.3, 0.1),) * 100),
            "nothing moves in the recording",
        ),
        (
            Trajectory(times_s=tuple(k / 50 for k in range(100)), poses=((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0),) * 100),
            "the recording has no joints",
        ),
    ],
)
def test_what_cannot_be_learned_from_is_refused_with_the_reason(recorded: Trajectory, words: str) -> None:
    with pytest.raises(RobotError, match=words):
        learn_joint_dmp(recorded)
