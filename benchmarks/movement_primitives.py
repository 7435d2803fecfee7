"""Measures movement primitives: `python -P benchmarks/movement_primitives.py [--demonstrations N] [--json FILE]`.

Prints what learning, rolling out, stepping and planning cost (thread CPU time), beside the library
movement-primitives where it is installed, and how far learned primitives are from random
demonstrations. About half a minute.
"""

from __future__ import annotations

import argparse
import json
import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from benchmarks.comparison import machine
from benchmarks.peers import movement_primitives as peer
from engine.messages.demonstrations import Trajectory
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import model_by_name
from robots.model.transform import RigidTransform
from robots.motion.dmp import (
    OnlineCartDmp,
    OnlineJointDmp,
    integrate_joints,
    integrate_pose,
    learn_cart_dmp,
    learn_joint_dmp,
    plan_cart_dmp,
    plan_joint_dmp,
)
from robots.motion.dmp.quaternions import conjugate, exp, log, product, toward
from robots.motion.min_jerk import min_jerk
from robots.port import Array

KERNELS, RATE_HZ, JOINTS = 25, 1000, 7
ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class Cost:
    """Median CPU time of one piece of work; the error is that of what was learned, rms and at the end."""

    work: str
    ours_ms: float
    peer_ms: float | None = None
    ours_error: str = ""
    peer_error: str = ""


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """Over random demonstrations: mean and greatest error of learned primitives, and of their ends."""

    kind: str
    noise: str
    demonstrations: int
    kernels: float
    rms: str
    greatest: str
    end: str


def measured_ms(work: Callable[[], object], *, rounds: int = 15) -> float:
    """Return the median thread CPU time."""
    work()
    taken: list[float] = []
    for _ in range(rounds):
        start = time.thread_time_ns()
        work()
        taken.append((time.thread_time_ns() - start) / 1e6)
    return float(np.median(taken))


def shown_joints(random: np.random.Generator, times: Array, *, rest_s: float) -> Array:
    """Return joints that wave on their way, (T, 7)."""
    share = min_jerk((times - rest_s) / (times[-1] - 2.0 * rest_s))
    start, end = random.uniform(-1.0, 1.0, (2, JOINTS))
    return start + (end - start) * share[:, None] + _waves(random, share, JOINTS, 0.3)


def shown_poses(random: np.random.Generator, times: Array, *, rest_s: float) -> Array:
    """Return tool poses that wave on their way, (T, 7)."""
    share = min_jerk((times - rest_s) / (times[-1] - 2.0 * rest_s))
    xyz = random.uniform(-0.4, 0.4, 3) * share[:, None] + _waves(random, share, 3, 0.08)
    turn = random.uniform(-1.0, 1.0, 3) * share[:, None] + _waves(random, share, 3, 0.2)
    first = random.standard_normal(4)
    return np.hstack((xyz, product(exp(turn), first / np.linalg.norm(first))))


def _waves(random: np.random.Generator, share: Array, width: int, size: float) -> Array:
    number = np.arange(1, 4)
    waves = np.sin(np.pi * share[:, None] * number) / number
    return waves @ (size * random.standard_normal((3, width)))


def recorded(times: Array, *, joints: Array | None = None, poses: Array | None = None) -> Trajectory:
    """Return samples as a recording."""
    return Trajectory(times_s=_row(times), joints=_rows(joints), poses=_rows(poses))


def _row(values: Array) -> tuple[float, ...]:
    return tuple(values.tolist())


def _rows(values: Array | None) -> tuple[tuple[float, ...], ...]:
    return () if values is None else tuple(tuple(row) for row in values.tolist())


def joint_costs() -> list[Cost]:
    """Learn and roll out a joint primitive of one second, 1000 samples, 7 joints."""
    times = np.arange(RATE_HZ + 1) / RATE_HZ
    joints = shown_joints(np.random.default_rng(1), times, rest_s=0.0)
    recording = recorded(times, joints=joints)
    learned = learn_joint_dmp(recording, kernels=KERNELS, trim=False)
    ours = integrate_joints(learned.dmp, steps=RATE_HZ).position
    running = OnlineJointDmp(learned.dmp)
    fit = Cost(
        work="learn 7 joints from 1000 samples",
        ours_ms=measured_ms(lambda: learn_joint_dmp(recording, kernels=KERNELS, trim=False)),
        ours_error=_error(ours - joints, 1.0),
    )
    roll = Cost(
        work="roll out 7 joints, 1 s at 1 kHz",
        ours_ms=measured_ms(lambda: integrate_joints(learned.dmp, steps=RATE_HZ)),
    )
    step = Cost(work="one step with phase stopping, joints", ours_ms=_step_ms(lambda: running.step(1e-3)))
    if peer.installed():
        theirs = peer.learn_joints(times, joints, kernels=KERNELS)
        fit = Cost(
            work=fit.work,
            ours_ms=fit.ours_ms,
            ours_error=fit.ours_error,
            peer_ms=measured_ms(lambda: peer.learn_joints(times, joints, kernels=KERNELS)),
            peer_error=_error(theirs() - joints, 1.0),
        )
        roll = Cost(work=roll.work, ours_ms=roll.ours_ms, peer_ms=measured_ms(theirs))
    return [fit, roll, step]


def pose_costs() -> list[Cost]:
    """Learn and roll out a Cartesian primitive of one second, 1000 samples."""
    times = np.arange(RATE_HZ + 1) / RATE_HZ
    poses = shown_poses(np.random.default_rng(2), times, rest_s=0.0)
    recording = recorded(times, poses=poses)
    learned = learn_cart_dmp(recording, kernels=KERNELS, trim=False)
    path = integrate_pose(learned.dmp, steps=RATE_HZ)
    running = OnlineCartDmp(learned.dmp)
    fit = Cost(
        work="learn poses from 1000 samples",
        ours_ms=measured_ms(lambda: learn_cart_dmp(recording, kernels=KERNELS, trim=False)),
        ours_error=_pose_error(path.xyz, path.xyzw, poses),
    )
    roll = Cost(
        work="roll out poses, 1 s at 1 kHz",
        ours_ms=measured_ms(lambda: integrate_pose(learned.dmp, steps=RATE_HZ)),
    )
    step = Cost(work="one step with phase stopping, pose", ours_ms=_step_ms(lambda: running.step(1e-3)))
    if peer.installed():
        theirs = peer.learn_poses(times, poses, kernels=KERNELS)
        rolled = theirs()
        fit = Cost(
            work=fit.work,
            ours_ms=fit.ours_ms,
            ours_error=fit.ours_error,
            peer_ms=measured_ms(lambda: peer.learn_poses(times, poses, kernels=KERNELS), rounds=5),
            peer_error=_pose_error(rolled[:, :3], rolled[:, 3:], poses),
        )
        roll = Cost(work=roll.work, ours_ms=roll.ours_ms, peer_ms=measured_ms(theirs, rounds=5))
    return [fit, roll, step]


def plan_costs() -> list[Cost]:
    """Plan motions of two seconds for a Panda, checks included."""
    model = model_by_name("panda")
    kinematics = ArmKinematics(model, base=ORIGIN)
    home = np.array(model.home_rad)
    times = np.arange(0.0, 2.61, 0.01)
    share = min_jerk((times - 0.3) / 2.0)[:, None]
    joints = home + np.array([0.5, 0.3, -0.2, 0.4, 0.1, 0.2, -0.3]) * share
    tools = [kinematics.tool_pose(row) for row in joints]
    poses = np.array([(*tool.xyz, *tool.xyzw) for tool in tools])
    joint = learn_joint_dmp(recorded(times, joints=joints)).dmp
    cart = learn_cart_dmp(recorded(times, poses=poses)).dmp
    return [
        Cost(
            work="plan 2 s of 7 joints with all checks",
            ours_ms=measured_ms(lambda: plan_joint_dmp(joint, home, limits=model.limits, joint_names=model.arm_joints)),
        ),
        Cost(
            work="plan 2 s of a Panda's tool with all checks",
            ours_ms=measured_ms(lambda: plan_cart_dmp(kinematics, cart, home)),
        ),
    ]


def accuracies(count: int) -> list[Accuracy]:
    """Learn from random demonstrations of three seconds at 100 Hz, with rest before and after."""
    times = np.arange(0.0, 3.81, 0.01)
    lines: list[Accuracy] = []
    for noise_rad in (0.0, 1e-4, 1e-3):
        fits: list[tuple[float, ...]] = []
        for seed in range(count):
            random = np.random.default_rng(seed)
            joints = shown_joints(random, times, rest_s=0.4)
            noisy = joints + noise_rad * random.standard_normal(joints.shape)
            learned = learn_joint_dmp(recorded(times, joints=noisy))
            end = integrate_joints(learned.dmp).position[-1] - joints[-1]
            fits.append((learned.fit.kernels, learned.fit.rms_rad, learned.fit.max_rad, float(np.abs(end).max())))
        kernels, rms, greatest, end = np.array(fits, dtype=np.float64).T
        lines.append(
            Accuracy(
                kind="joints",
                noise=f"{1e3 * noise_rad:g} mrad",
                demonstrations=count,
                kernels=float(np.median(kernels)),
                rms=f"{1e3 * rms.mean():.3f} mrad",
                greatest=f"{1e3 * greatest.max():.2f} mrad",
                end=f"{math.degrees(end.max()):.4f}°",
            )
        )
    for noise_m in (0.0, 1e-4, 1e-3):
        fits: list[tuple[float, ...]] = []
        for seed in range(count):
            random = np.random.default_rng(seed)
            poses = shown_poses(random, times, rest_s=0.4)
            turn = exp(noise_m * random.standard_normal((len(times), 3)))
            noisy = np.hstack(
                (poses[:, :3] + noise_m * random.standard_normal((len(times), 3)), product(turn, poses[:, 3:]))
            )
            learned = learn_cart_dmp(recorded(times, poses=noisy))
            path = integrate_pose(learned.dmp)
            place = float(np.linalg.norm(path.xyz[-1] - poses[-1, :3]))
            last = toward(path.xyzw[-1], poses[-1, 3:])
            angle = float(np.linalg.norm(log(product(last, conjugate(poses[-1, 3:])))))
            fit = learned.fit
            fits.append((fit.kernels, fit.rms_m, fit.rms_rad, fit.max_m, fit.max_rad, place, angle))
        kernels, rms_m, rms_rad, max_m, max_rad, place, angle = np.array(fits, dtype=np.float64).T
        lines.append(
            Accuracy(
                kind="poses",
                noise=f"{1e3 * noise_m:g} mm, {1e3 * noise_m:g} mrad",
                demonstrations=count,
                kernels=float(np.median(kernels)),
                rms=f"{1e3 * rms_m.mean():.3f} mm, {1e3 * rms_rad.mean():.3f} mrad",
                greatest=f"{1e3 * max_m.max():.2f} mm, {1e3 * max_rad.max():.2f} mrad",
                end=f"{1e3 * place.max():.3f} mm, {math.degrees(angle.max()):.4f}°",
            )
        )
    return lines


def _step_ms(step: Callable[[], object]) -> float:
    def steps() -> None:
        for _ in range(200):
            step()

    return measured_ms(steps) / 200.0


def _error(difference: Array, scale: float) -> str:
    rms = scale * math.sqrt(float((difference**2).mean()))
    return f"{1e3 * rms:.2f} mrad, end {1e3 * scale * float(np.abs(difference[-1]).max()):.2f}"


def _pose_error(xyz: Array, xyzw: Array, poses: Array) -> str:
    away = np.linalg.norm(xyz - poses[:, :3], axis=1)
    signs = np.sign((xyzw * poses[:, 3:]).sum(axis=1, keepdims=True))
    angle = np.linalg.norm(log(product(xyzw * signs, conjugate(poses[:, 3:]))), axis=1)
    return (
        f"{1e3 * math.sqrt(float((away**2).mean())):.2f} mm {1e3 * math.sqrt(float((angle**2).mean())):.2f} mrad,"
        f" end {1e3 * float(away[-1]):.2f} mm {1e3 * float(angle[-1]):.2f} mrad"
    )


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--demonstrations", type=int, default=200, help="random demonstrations of each kind")
    parser.add_argument("--json", type=Path, help="also write the figures here")
    arguments = parser.parse_args()
    costs = [*joint_costs(), *pose_costs(), *plan_costs()]
    print(f"{'':44} {'ours ms':>9} {'peer ms':>9}  ours rms error | peer")
    for cost in costs:
        theirs = "-" if cost.peer_ms is None else f"{cost.peer_ms:9.2f}"
        errors = f"{cost.ours_error} | {cost.peer_error or '-'}" if cost.ours_error else ""
        print(f"{cost.work:44} {cost.ours_ms:9.3f} {theirs:>9}  {errors}")
    if not peer.installed():
        print("movement-primitives is not installed (pip install movement-primitives pytransform3d)")
    print()
    lines = accuracies(arguments.demonstrations)
    for line in lines:
        print(
            f"{line.kind:7} noise {line.noise:18} N {line.kernels:4.0f}  rms {line.rms:24}"
            f" greatest {line.greatest:24} end, worst of {line.demonstrations}: {line.end}"
        )
    if arguments.json:
        figures = {"machine": machine(), "costs": [asdict(c) for c in costs], "accuracy": [asdict(a) for a in lines]}
        arguments.json.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
