"""Inverse kinematics of the arms: reachable poses are reached, the nearest and all solutions, reasons why not."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings

from benchmarks.ik_arms import requests, solves
from engine.errors import RobotError
from robots.model.inverse_kinematics import POSITION_TOLERANCE_M, InverseKinematicsSolver, PoseMatch, analytic
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.transform import RigidTransform
from robots.port import Array
from tests.robots.model.inverse_kinematics.ik_arms import ARMS, SIX_AXES, arm, at_shares, limits, shares
from tests.robots.panda_arm import configurations, home, panda_kinematics

DOWN = (1.0, 0.0, 0.0, 0.0)
TURN = 2.0 * np.pi


@pytest.mark.parametrize("name", ARMS)
def test_random_reachable_poses_are_reached_within_the_limits(name: str) -> None:
    """At least 99.5 % of 300, from anywhere; none is answered wrongly."""
    assert _solved(arm(name), 300) >= 0.995 * 300


@pytest.mark.parametrize("name", ["ur10", "irb4600"])
def test_six_axes_are_solved_without_a_closed_form_too(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where EAIK is not installed."""
    monkeypatch.setattr(analytic, "find_spec", _find_nothing)
    kinematics = arm(name).twin()
    found = InverseKinematicsSolver(kinematics).all_solutions(kinematics.tool_pose(home()[:6] / 2.0))
    assert (found.complete, found.how) == (False, "sampled by 200 descents")
    assert _solved(kinematics, 100) >= 99


@settings(max_examples=60, deadline=None)
@given(shares(), shares())
def test_every_reachable_pose_is_reached_by_a_panda(at: Array, seed: Array) -> None:
    """At limits and singularities too."""
    kinematics = arm("panda")
    target = kinematics.tool_pose(at_shares(kinematics, at))
    assert solves(
        kinematics, target, InverseKinematicsSolver(kinematics).nearest(target, seed=at_shares(kinematics, seed))
    )


@pytest.mark.parametrize("name", SIX_AXES)
@settings(max_examples=60, deadline=None)
@given(shares(), shares())
def test_every_reachable_pose_is_reached_by_six_axes(name: str, at: Array, seed: Array) -> None:
    """At limits and singularities too."""
    kinematics = arm(name)
    target = kinematics.tool_pose(at_shares(kinematics, at))
    assert solves(
        kinematics, target, InverseKinematicsSolver(kinematics).nearest(target, seed=at_shares(kinematics, seed))
    )


@pytest.mark.parametrize("name", ["ur10", "ur10 of the lab", "irb4600"])
@settings(max_examples=40, deadline=None)
@given(shares())
def test_all_solutions_of_six_axes_hold_the_one_that_made_the_pose(name: str, at: Array) -> None:
    """Away from singularities, where a pose has infinitely many; every one solves, and no two are the same."""
    kinematics = arm(name)
    joints = at_shares(kinematics, at)
    found = InverseKinematicsSolver(kinematics).all_solutions(target := kinematics.tool_pose(joints), seed=joints)
    assert all(solves(kinematics, target, row) for row in found.joints)
    if found.complete and kinematics.dexterity(joints) > 0.03:
        assert np.abs(found.joints - joints).max(axis=1).min() < 1e-3
    apart = np.abs(found.joints[:, None] - found.joints[None]).max(axis=2) + np.eye(len(found.joints))
    assert apart.min() > 1e-5


def test_every_turn_within_the_limits_is_a_solution() -> None:
    """Five joints of the UR10 may stand in either of two turns."""
    kinematics = arm("ur10")
    joints = np.array([0.4, -1.2, 1.1, -0.7, 0.9, 0.3])
    found = InverseKinematicsSolver(kinematics).all_solutions(kinematics.tool_pose(joints), seed=joints)
    turned = {tuple(row) for row in np.round((found.joints - joints) / TURN, 6) if (row == row.round()).all()}
    assert found.complete
    assert len(turned) == 32
    assert (np.abs(found.joints[0] - joints) < 1e-6).all()


@pytest.mark.parametrize("name", SIX_AXES)
def test_the_nearest_solution_is_the_first_of_all(name: str) -> None:
    """By the time of the slowest joint."""
    kinematics = arm(name)
    inverse, speed = InverseKinematicsSolver(kinematics), np.array(kinematics.limits.velocity_rad_s)
    for request in requests(kinematics, 40, seed=2):
        nearest = inverse.nearest(request.target, seed=request.seed)
        first = inverse.all_solutions(request.target, seed=request.seed).joints[0]
        times = [np.max(np.abs(joints - request.seed) / speed) for joints in (nearest, first)]
        assert times[0] <= times[1] + 1e-6


def test_a_redundant_arm_gives_a_sample_that_is_called_one() -> None:
    """Of the infinitely many, for values of one joint."""
    kinematics = panda_kinematics()
    found = InverseKinematicsSolver(kinematics).all_solutions(kinematics.tool_pose(home()))
    assert (found.complete, found.how) == (False, "sampled: closed form for 64 values of panda_joint7")
    assert len(found.joints) > 30
    assert all(solves(kinematics, kinematics.tool_pose(home()), row) for row in found.joints)


@settings(max_examples=15, deadline=None)
@given(configurations(margin_rad=0.3))
def test_a_pose_close_by_is_reached_by_a_small_motion(joints: Array) -> None:
    """The elbow stays where it is, unless the arm is next to a singularity."""
    kinematics = panda_kinematics()
    if kinematics.dexterity(joints) < 0.1:
        return
    here = kinematics.tool_pose(joints)
    there = RigidTransform(xyz=here.xyz + 0.005, xyzw=here.xyzw)
    try:
        found = InverseKinematicsSolver(kinematics).nearest(there, seed=joints)
    except RobotError:
        return  # the random pose was at the rim of the workspace
    assert np.abs(found - joints).max() < 0.2


@pytest.mark.parametrize("name", SIX_AXES)
def test_an_arm_with_its_wrist_singular_does_not_spin_it(name: str) -> None:
    """The closed form knows one of infinitely many solutions there; the arm stays next to where it is."""
    kinematics = arm(name)
    joints = np.array([0.3, -0.9, 0.7, 1.9, 0.0, -1.4])
    found = InverseKinematicsSolver(kinematics).nearest(kinematics.tool_pose(joints), seed=joints)
    assert np.abs(found - joints).max() < 0.05


@pytest.mark.parametrize("name", ARMS)
def test_the_same_request_has_the_same_answer(name: str) -> None:
    """Starts are drawn by the request."""
    kinematics = arm(name)
    for request in requests(kinematics, 10, seed=4):
        first, second = (
            InverseKinematicsSolver(k).nearest(request.target, seed=request.seed)
            for k in (kinematics, kinematics.twin())
        )
        assert (first == second).all()


@pytest.mark.parametrize("name", ARMS)
def test_a_pose_next_to_the_joints_is_followed(name: str) -> None:
    """Exactly, or not at all."""
    kinematics = arm(name)
    inverse = InverseKinematicsSolver(kinematics)
    lower, upper = limits(kinematics)
    random = np.random.default_rng(3)
    for _ in range(20):
        joints = random.uniform(lower, upper)
        target = kinematics.tool_pose(joints + random.uniform(-0.01, 0.01, len(joints)))
        found = inverse.track(target, seed=joints)
        if kinematics.dexterity(joints) > 0.05:
            assert found is not None
            assert np.abs(found - joints).max() < 0.2
    far = RigidTransform(xyz=np.array([0.0, 0.0, 9.0]), xyzw=np.array(DOWN))
    assert inverse.track(far, seed=(lower + upper) / 2.0) is None


def test_the_tools_axis_alone_can_be_matched() -> None:
    """The turn about it is free: a pose beyond the wrist's range is reached turned."""
    kinematics = panda_kinematics()
    inverse = InverseKinematicsSolver(kinematics)
    target = RigidTransform.of((-0.15, 0.1, 0.2), (0.6, -0.8, 0.0, 0.0))
    joints = inverse.nearest(target, seed=home(), match=PoseMatch.AXIS)
    pose = kinematics.tool_pose(joints)
    assert pose.distance_m(target) < POSITION_TOLERANCE_M
    assert np.linalg.norm(pose.rotation[:, 2] - target.rotation[:, 2]) < 1e-4
    turned = inverse.nearest(target, seed=home())
    assert np.abs(joints - home()).max() < np.abs(turned - home()).max() - 0.1


def test_an_arm_of_two_joints_matches_positions() -> None:
    """Both solutions are found; a full pose is refused with advice, an impossible position with its distance."""
    kinematics = arm("servo_arm")
    inverse = InverseKinematicsSolver(kinematics)
    joints = np.array([1.1, -0.8])
    target = kinematics.tool_pose(joints)
    assert np.abs(inverse.nearest(target, seed=joints + 0.1, match=PoseMatch.POSITION) - joints).max() < 1e-3
    assert np.abs(inverse.nearest(target, seed=joints + 0.1) - joints).max() < 1e-3
    assert len(inverse.all_solutions(target, match=PoseMatch.POSITION).joints) >= 1
    with pytest.raises(RobotError, match=r"not in this orientation.*2 joints cannot choose its orientation"):
        inverse.nearest(RigidTransform(xyz=target.xyz, xyzw=np.array([0.5, 0.5, 0.5, 0.5])), seed=joints)
    above = RigidTransform(xyz=target.xyz + kinematics.base.rotation[:, 2], xyzw=target.xyzw)
    with pytest.raises(RobotError, match=r"is out of reach by 0\.\d\d\d m"):
        inverse.nearest(above, seed=joints, match=PoseMatch.POSITION)


@pytest.mark.parametrize(
    ("xyz", "xyzw", "words"),
    [
        ((1.2, 0.0, 0.4), DOWN, r"\(1.200, 0.000, 0.400\) is out of reach by 0\.8\d\d m"),
        ((0.2, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0), r"not in this orientation: .* with panda_joint\d at its \w+ limit"),
    ],
)
def test_an_unreachable_pose_tells_what_is_missing(
    xyz: tuple[float, float, float], xyzw: tuple[float, float, float, float], words: str
) -> None:
    """By how far, or which joint is at its limit; of all solutions as of the nearest."""
    inverse = InverseKinematicsSolver(panda_kinematics())
    with pytest.raises(RobotError, match=words):
        inverse.nearest(RigidTransform.of(xyz, xyzw), seed=home())
    with pytest.raises(RobotError, match=words):
        inverse.all_solutions(RigidTransform.of(xyz, xyzw))


@pytest.mark.parametrize("seed", [np.zeros(6), np.full(7, np.nan)])
def test_a_seed_that_is_no_configuration_is_refused(seed: Array) -> None:
    """The compiled loops would read beyond it."""
    inverse = InverseKinematicsSolver(panda_kinematics())
    with pytest.raises(RobotError, match="is not a configuration of panda"):
        inverse.nearest(RigidTransform.of((0.0, 0.0, 0.3), DOWN), seed=seed)


def _find_nothing(_name: str) -> None:
    """Say that no package is installed."""


def _solved(kinematics: ArmKinematics, count: int) -> int:
    """Return how many random requests are answered, after checking every answer."""
    inverse = InverseKinematicsSolver(kinematics)
    answered = 0
    for request in requests(kinematics, count):
        try:
            joints = inverse.nearest(request.target, seed=request.seed)
        except RobotError:
            continue
        assert solves(kinematics, request.target, joints)
        answered += 1
    return answered
