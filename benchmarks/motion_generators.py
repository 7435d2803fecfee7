"""What one control period of each motion generator costs on a Panda.

`python -P benchmarks/motion_generators.py` prints microseconds of CPU time.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from robots.control.arm_state import ArmState
from robots.control.force.force_tracking import ForceTracking
from robots.control.generators.guarded_motion import GuardedMotion
from robots.control.generators.guiding import GuidingGenerator
from robots.control.generators.joint_jogging import JointJogGenerator
from robots.control.generators.joint_streaming import JointStreamGenerator
from robots.control.generators.motion_generator import MotionGenerator, StreamGenerator
from robots.control.generators.tool_jogging import ToolJogGenerator
from robots.control.generators.trajectory_playback import TrajectoryPlayback
from robots.model.mechanics.kinematics import ArmKinematics
from robots.model.registry import model_by_name
from robots.model.transform import RigidTransform
from robots.port import Array, ContactCondition, ForceTask, JointTrajectory

STEP_S = 0.001


def swing(start: Array, duration_s: float) -> JointTrajectory:
    """Return a motion of three joints over `duration_s`."""
    u = np.linspace(0.0, 1.0, round(duration_s / 0.002) + 1)[:, None]
    travel = np.array([0.3, 0.1, 0.0, 0.2, 0.0, 0.0, 0.0])
    return JointTrajectory(
        dt_s=0.002,
        position_rad=start + travel * (10 * u**3 - 15 * u**4 + 6 * u**5),
        velocity_rad_s=travel * (30 * u**2 - 60 * u**3 + 30 * u**4) / duration_s,
    )


def cost_us(generator: MotionGenerator, setpoint: Array, state: ArmState, periods: int) -> float:
    """Return the mean CPU time of a step; streams receive something new in every eighth."""
    spent_s = 0.0
    for period in range(periods):
        if isinstance(generator, StreamGenerator) and period % 8 == 0 and len(setpoint):
            generator.receive(setpoint * (1.0 + 0.001 * period))
        state.refill(generator.position, generator.velocity)
        before = time.thread_time()
        generator.step(STEP_S, target_pace=1.0, state=state)
        spent_s += time.thread_time() - before
    return spent_s / periods * 1e6


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--periods", type=int, default=3000, help="control periods of each (default 3000)")
    periods = parser.parse_args().periods
    model = model_by_name("panda")
    state = ArmState(ArmKinematics(model, base=RigidTransform.of((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))))
    home, limits, joints = np.array(model.home_rad), model.limits, model.arm_joints
    trajectory, acceleration = swing(home, periods * STEP_S), np.array(limits.acceleration_rad_s2)
    jerk = np.array(limits.jerk_rad_s3)
    samples = len(trajectory.position_rad)
    task = ForceTask(trajectory=trajectory, offset=np.zeros((samples, 6)), wrench=np.zeros((samples, 6)))
    generators: dict[str, tuple[MotionGenerator, Array]] = {
        "playback": (TrajectoryPlayback(trajectory, acceleration_rad_s2=acceleration, jerk_rad_s3=jerk), np.zeros(0)),
        "guarded": (
            GuardedMotion(
                TrajectoryPlayback(trajectory, acceleration_rad_s2=acceleration, jerk_rad_s3=jerk),
                ContactCondition(force_n=10.0),
            ),
            np.zeros(0),
        ),
        "joint positions": (JointStreamGenerator(limits=limits, joints=joints, start=home, watchdog_s=1.0), home),
        "joint velocities": (JointJogGenerator(limits=limits, start=home, watchdog_s=1.0), np.full(7, 0.1)),
        "tool twist": (
            ToolJogGenerator(limits=limits, start=home, watchdog_s=1.0),
            np.array([0.02, 0.0, 0.01, 0, 0, 0]),
        ),
        "guiding": (GuidingGenerator(limits=limits, start=home, measured=home), np.zeros(0)),
        "force tracking": (ForceTracking(task, limits=limits, joints=joints), np.zeros(0)),
    }
    for name, (generator, setpoint) in generators.items():
        print(f"{name:<18}{cost_us(generator, setpoint, state, periods):8.1f} us")


if __name__ == "__main__":
    main()
