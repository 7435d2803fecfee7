"""The attractors are solved as published: against a fine integration, over time scales, and with other goals."""

from __future__ import annotations

from itertools import pairwise

import msgspec
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.messages.primitives import CartDmp, JointDmp
from robots.motion.dmp import GaussianKernels, GoalChange, integrate_joints, integrate_pose
from robots.motion.dmp.quaternions import conjugate, exp, log, product
from robots.port import Array
from tests.robots.motion.dmp.demonstrations import seeds
from tests.tiers import examples

A_Z, A_X = 48.0, 2.0


def new_joint_dmp(seed: int, *, joints: int = 3, kernels: int = 15, strength: float = 300.0) -> JointDmp:
    """A primitive of random weights."""
    random = np.random.default_rng(seed)
    basis = GaussianKernels.evenly(kernels, a_x=A_X)
    goal, y0, dy0 = random.uniform(-1.0, 1.0, (3, joints)).tolist()
    return JointDmp(
        N=kernels, a_z=A_Z, a_x=A_X, tau=float(random.uniform(0.5, 5.0)),
        goal=tuple(goal), y0=tuple(y0), dy0=tuple(dy0),
        c=tuple(basis.c.tolist()), sigma=tuple(basis.sigma.tolist()),
        w=tuple(tuple(row) for row in (strength * random.normal(size=(joints, kernels))).tolist()),
    )  # fmt: skip


def new_cart_dmp(seed: int, *, kernels: int = 15, strength: float = 200.0) -> CartDmp:
    """A primitive of random weights; start and goal are less than half a turn apart."""
    random = np.random.default_rng(seed)
    basis = GaussianKernels.evenly(kernels, a_x=A_X)
    first = random.normal(size=4)
    first /= np.linalg.norm(first)
    last = product(exp(random.uniform(-1.2, 1.2, 3)), first)
    rows = [tuple(row) for row in (strength * random.normal(size=(6, kernels))).tolist()]
    return CartDmp(
        N=kernels, a_z=A_Z, a_x=A_X, tau=float(random.uniform(0.5, 5.0)),
        goal=(*random.uniform(-0.5, 0.5, 3).tolist(), *last.tolist()),
        y0=(*random.uniform(-0.5, 0.5, 3).tolist(), *first.tolist()),
        c=tuple(basis.c.tolist()), sigma=tuple(basis.sigma.tolist()),
        w1=rows[0], w2=rows[1], w3=rows[2], w4=rows[3], w5=rows[4], w6=rows[5],
    )  # fmt: skip


def euler(dmp: JointDmp, *, steps: int) -> Array:
    """The equations of the paper, written down and integrated with tiny steps."""
    x, y, z = 1.0, np.array(dmp.y0), dmp.tau * np.array(dmp.dy0)
    c, sigma, w = np.array(dmp.c), np.array(dmp.sigma), np.array(dmp.w)
    dt = dmp.tau / steps
    for _ in range(steps):
        psi = np.exp(-((x - c) ** 2) / (2.0 * sigma))
        force = x * (w @ psi) / psi.sum()
        y_dot = z / dmp.tau
        z = z + dt / dmp.tau * (dmp.a_z * (dmp.a_z / 4.0 * (np.array(dmp.goal) - y) - z) + force)
        y, x = y + dt * y_dot, x - dt * dmp.a_x * x / dmp.tau
    return y


@settings(max_examples=3, deadline=None)
@given(seeds)
def test_joints_follow_the_published_equations(seed: int) -> None:
    """The rolled out end agrees with Euler's method, ever better as that takes smaller steps."""
    dmp = new_joint_dmp(seed)
    end = integrate_joints(dmp).position[-1]
    coarse, fine = (np.abs(euler(dmp, steps=steps) - end).max() for steps in (2_000, 20_000))
    assert fine < 1e-3
    assert fine < 0.2 * coarse + 1e-5


@settings(max_examples=examples(8, nightly=30), deadline=None)
@given(seeds)
def test_smaller_steps_change_nothing(seed: int) -> None:
    """The integration converges: eight times the steps move neither joints nor poses noticeably."""
    joints, pose = new_joint_dmp(seed), new_cart_dmp(seed)
    assert np.abs(integrate_joints(joints).position - integrate_joints(joints, steps=4000).position[::8]).max() < 1e-4
    fine, path = integrate_pose(pose, steps=4000), integrate_pose(pose)
    assert np.abs(path.xyz - fine.xyz[::8]).max() < 1e-4
    assert np.linalg.norm(log(product(fine.xyzw[::8], conjugate(path.xyzw))), axis=1).max() < 1e-3


@settings(max_examples=examples(8, nightly=30), deadline=None)
@given(seeds)
def test_rates_are_the_slopes_of_what_is_rolled_out(seed: int) -> None:
    """Positions and orientations, with the angular velocity along the world's axes."""
    path = integrate_pose(new_cart_dmp(seed), steps=4000)
    step = path.shares[1]
    slope = np.diff(path.xyz, axis=0) / step
    spin = log(product(path.xyzw[1:], conjugate(path.xyzw[:-1]))) / step
    middle = (path.rate[1:] + path.rate[:-1]) / 2.0
    assert np.abs(np.hstack((slope, spin)) - middle).max() < 1e-2 * np.abs(middle).max()
    pushes = np.diff(path.rate, axis=0) / step - (path.push[1:] + path.push[:-1]) / 2.0
    assert np.abs(pushes).max() < 1e-2 * np.abs(path.push).max()


@settings(max_examples=25, deadline=None)
@given(seeds, st.floats(0.05, 50.0))
def test_another_duration_leaves_the_path_unchanged(seed: int, tau: float) -> None:
    """From rest, at equal shares of the duration the joints are the same; velocities scale."""
    dmp = msgspec.structs.replace(new_joint_dmp(seed), dy0=(0.0,) * 3)
    one, other = integrate_joints(dmp), integrate_joints(msgspec.structs.replace(dmp, tau=tau))
    assert (one.position == other.position).all()
    pose = new_cart_dmp(seed)
    assert (integrate_pose(pose).xyzw == integrate_pose(msgspec.structs.replace(pose, tau=tau)).xyzw).all()


@settings(max_examples=25, deadline=None)
@given(seeds, st.floats(-2.0, 2.0))
def test_another_goal_shifts_the_path_as_the_attractor_answers_a_step(seed: int, shift: float) -> None:
    """The forcing term stays, so what is added is shift · (1 - (1 + a s) exp(-a s)) with a = a_z / 2."""
    dmp = new_joint_dmp(seed)
    moved = msgspec.structs.replace(dmp, goal=tuple(angle + shift for angle in dmp.goal))
    path, other = integrate_joints(dmp), integrate_joints(moved)
    fade = (1.0 + A_Z / 2.0 * path.shares) * np.exp(-A_Z / 2.0 * path.shares)
    assert other.position - path.position == pytest.approx(np.tile((shift * (1.0 - fade))[:, None], 3), abs=1e-9)


@settings(max_examples=25, deadline=None)
@given(seeds, st.floats(0.0, 0.9), st.floats(-1.0, 1.0))
def test_a_goal_changed_on_the_way_is_reached_without_a_jump(seed: int, share: float, shift: float) -> None:
    """Before the change nothing differs; then acceleration stays continuous, and the end is shifted."""
    dmp = new_joint_dmp(seed)
    change = GoalChange(share=share, goal=np.array(dmp.goal) + shift)
    path, other = integrate_joints(dmp, end=3.0), integrate_joints(dmp, end=3.0, changes=[change])
    before = path.shares < share
    assert (other.position[before] == path.position[before]).all()
    assert other.position[-1] - path.position[-1] == pytest.approx(np.full(3, shift), abs=1e-6)
    added = other.push - path.push
    # The filtered goal moves at most by a_g · shift per tau, so the added push rises at most this fast.
    steepest = (A_Z / 2.0) ** 2 * (A_Z / 4.0) * abs(shift)
    assert np.abs(np.diff(added, axis=0)).max() <= 1.01 * steepest * path.shares[1] + 1e-6


@settings(max_examples=15, deadline=None)
@given(seeds, st.floats(0.0, 0.9))
def test_a_pose_goal_changed_on_the_way_is_reached(seed: int, share: float) -> None:
    """Place and orientation, whichever sign the new quaternion has; twice changed ends at the last."""
    dmp = new_cart_dmp(seed, strength=50.0)
    random = np.random.default_rng(seed)
    goals: list[Array] = []
    for sign in (1.0, -1.0):
        xyzw = sign * product(exp(random.uniform(-1.0, 1.0, 3)), np.array(dmp.goal[3:]))
        goals.append(np.concatenate((random.uniform(-0.5, 0.5, 3), xyzw)))
    changes = [GoalChange(share=share, goal=goals[0]), GoalChange(share=share + 0.3, goal=goals[1])]
    path = integrate_pose(dmp, end=6.0, changes=changes)
    assert path.xyz[-1] == pytest.approx(goals[1][:3], abs=1e-3)
    assert abs(float(path.xyzw[-1] @ goals[1][3:])) == pytest.approx(1.0, abs=1e-6)
    assert max(np.linalg.norm(b - a) for a, b in pairwise(path.xyz)) < 0.05


def test_a_phase_far_from_all_kernels_still_has_a_force() -> None:
    """No division of nothing by nothing."""
    kernels = GaussianKernels.of((1.0, 0.9), (1e-8, 1e-8))
    assert kernels.at(np.array([0.1, 0.5, 0.95])).sum(axis=1) == pytest.approx([1.0, 1.0, 1.0])
