"""How the robot models agree with their documents, and pinocchio with MuJoCo.

`python -P benchmarks/model_agreement.py` prints both tables. Without -P the neighbour `benchmarks/engine.py`
would shadow the package `engine`.
"""

from __future__ import annotations

import math
import time

import numpy as np

from robots.model.folder.calibration import load_calibration, transform
from robots.model.mechanics.collision_model import CollisionModel
from robots.model.mechanics.dynamics import ArmDynamics
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import ARMS_DIR, robot_model, robot_names, tool_names
from robots.model.transform import RigidTransform
from robots.port import Array
from robots.sim.physics.arm_spec import arm_spec
from robots.sim.physics.physics import mujoco
from tests.robots.arms.test_irb4600 import TABLE_4

ORIGIN = RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
STATES = 1000


def kinematics(name: str, **options: object) -> ArmKinematics:
    """Return an arm at the origin."""
    return ArmKinematics(robot_model(name, **options), base=ORIGIN)  # pyright: ignore[reportArgumentType]


def irb4600() -> None:
    """Print the five poses of the thesis's table."""
    arm = kinematics("irb4600", gripper=None)
    print("\n| IRB4600, table 4 | mm | mrad |\n|---|---|---|")
    for number, (xyz, xyzw, joints) in enumerate(TABLE_4, 1):
        pose, expected = arm.tool_pose(np.array(joints)), RigidTransform.of(xyz, xyzw)
        print(f"| pose {number} | {pose.distance_m(expected) * 1e3:.3f} | {pose.angle_rad(expected) * 1e3:.3f} |")


def ur10() -> None:
    """Print how far calibrated and nominal arm are from the six transforms of the printed file."""
    file = ARMS_DIR / "ur10" / "ur10_calibration.yaml"
    segments = load_calibration(file).segments.values()
    nominal, calibrated = kinematics("ur10", gripper=None), kinematics("ur10", gripper=None, calibration=file)
    worst = np.zeros(3)
    for q in np.random.default_rng(0).uniform(-math.pi, math.pi, (STATES, 6)):
        chain = transform((0.0, 0.0, 0.0), (0.0, 0.0, math.pi))
        for segment, angle in zip(segments, q, strict=True):
            chain = chain @ segment.matrix() @ transform((0.0, 0.0, 0.0), (0.0, 0.0, angle))
        a, b = nominal.tool_pose(q).xyz, calibrated.tool_pose(q).xyz
        off = (np.linalg.norm(a - chain[:3, 3]), np.linalg.norm(b - chain[:3, 3]), np.linalg.norm(a - b))
        worst = np.maximum(worst, off)
    print(f"\n| UR10, {STATES} random poses, greatest | mm |\n|---|---|")
    for words, value in zip(("nominal - file", "calibrated - file", "nominal - calibrated"), worst * 1e3, strict=True):
        print(f"| {words} | {value:.1e} |")


def servo_arm() -> None:
    """Print the greatest distance from the thesis's equation."""
    arm, worst = kinematics("servo_arm"), 0.0
    for q in np.random.default_rng(0).uniform((0.0, -2.6), (3.1, 0.5), (STATES, 2)):
        reach = 0.225 * math.cos(q[1])
        place = (reach * math.cos(q[0]), reach * math.sin(q[0]), 0.275 + 0.225 * math.sin(q[1]))
        worst = max(worst, float(np.linalg.norm(arm.tool_pose(q).xyz - place)))
    print(f"\nservo arm against its equations: {worst * 1e3:.1e} mm at most over {STATES} poses")


def agreement(name: str) -> Array:
    """Return the greatest differences of pinocchio and MuJoCo: m, rad, kg m², N m, and the greatest of the last two."""
    model = robot_model(name, gripper=None)
    compiled = arm_spec(model).compile()
    data, dynamics, arm = mujoco.MjData(compiled), ArmDynamics(model), kinematics(name, gripper=None)
    worst, random = np.zeros(6), np.random.default_rng(0)
    for _ in range(STATES):
        q = random.uniform(model.limits.lower_rad, model.limits.upper_rad)
        v = random.uniform(-1.0, 1.0, model.dof) * np.array(model.limits.velocity_rad_s)
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(compiled, data)
        full = np.zeros((model.dof, model.dof))
        mujoco.mj_fullM(compiled, data, full)
        pose, body = arm.tool_pose(q), data.body(model.tool_link)
        matrix, bias = dynamics.mass_matrix(q), dynamics.bias(q, v)
        off = (
            np.abs(pose.xyz - body.xpos).max(),
            np.abs(pose.rotation - body.xmat.reshape(3, 3)).max(),
            np.abs(matrix - full).max(),
            np.abs(bias - data.qfrc_bias).max(),
            np.abs(matrix).max(),
            np.abs(bias).max(),
        )
        worst = np.maximum(worst, off)
    return worst


def cost(name: str) -> tuple[float, float]:
    """Return the CPU time of a forward kinematics and of a self-collision check, in µs."""
    model = robot_model(name)
    arm, collision = ArmKinematics(model, base=ORIGIN), CollisionModel(model)
    states = np.random.default_rng(0).uniform(model.limits.lower_rad, model.limits.upper_rad, (STATES, model.dof))
    begun = time.thread_time()
    for q in states:
        arm.tool_pose(q)
    between = time.thread_time()
    for q in states:
        collision.in_collision(q)
    ended = time.thread_time()
    return (between - begun) / STATES * 1e6, (ended - between) / STATES * 1e6


def main() -> None:
    """Print everything."""
    print(f"arms: {', '.join(robot_names())}; tools: {', '.join(tool_names())}")
    irb4600()
    ur10()
    servo_arm()
    print(f"\n| pinocchio - MuJoCo, {STATES} random states, greatest | place m | rotation | mass matrix kg m² (of) | "
          "bias N m (of) |\n|---|---|---|---|---|")  # fmt: skip
    for name in robot_names():
        place, turn, mass, bias, most_mass, most_bias = agreement(name)
        row = (f"{place:.0e}", f"{turn:.0e}", f"{mass:.0e} ({most_mass:.3g})", f"{bias:.0e} ({most_bias:.3g})")
        print(f"| {name} | {' | '.join(row)} |")
    print("\n| µs CPU | forward kinematics | self-collision |\n|---|---|---|")
    for name in robot_names():
        forward, check = cost(name)
        print(f"| {name} | {forward:.1f} | {check:.1f} |")


if __name__ == "__main__":
    main()
