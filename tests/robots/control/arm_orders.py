"""Random orders to an arm in physics: motions of every kind, and stops."""

from __future__ import annotations

import random
from collections.abc import Callable

import numpy as np

from engine.skills.dmp import Compliance
from engine.skills.simulated_world import PushBody
from robots.control.arm_control_loop import ArmControlLoop
from robots.control.commanding.arm_commands import (
    CancelMotion,
    FinishStream,
    FollowTrajectory,
    HoldMotion,
    Setpoint,
    StartGuiding,
    StartStream,
    TrackForce,
)
from robots.control.motion_event import MotionFinished, MotionHeld
from robots.model.robot_model import RobotModel
from robots.motion import plan_joints
from robots.port import Array, ContactCondition, ForceTask, JointTrajectory, Tolerance
from robots.sim.commands.world_commands import PushSimBody
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import CellModel


class WatchedArm:
    """The arm of a world of its own; the watch of its control loop compares every set point with the limits."""

    def __init__(self, cell: CellModel, model: RobotModel) -> None:
        self.simulation = Simulation(cell)
        self.control: ArmControlLoop = self.simulation.control("left")
        self.model = model
        self.home = np.array(model.home_rad)
        self.number = 0
        self.ends: list[MotionFinished] = []
        self.held = False

    @property
    def tool_body(self) -> str:
        """The body that is pushed at."""
        tool = self.model.tool
        return "left/panda_hand" if tool is not None and tool.name == "panda_hand" else f"left/{self.model.flange_link}"

    @property
    def set_point(self) -> Array:
        """Where the set point is."""
        return self.control.motion.position.copy()

    def step(self) -> None:
        """Let one step pass."""
        for event in self.simulation.step():
            if isinstance(event, MotionFinished):
                self.ends.append(event)
            self.held |= isinstance(event, MotionHeld)

    def until_ended(self) -> MotionFinished:
        """Let time pass until the last motion has ended, and return its end."""
        for _ in range(6000):
            if self.ends and self.ends[-1].motion == self.number:
                return self.ends[-1]
            self.step()
        raise AssertionError(f"motion {self.number} does not end")

    def follow_trajectory(self, trajectory: JointTrajectory) -> None:
        """Start a motion."""
        self.simulation.apply(
            FollowTrajectory(arm="left", motion=self.next_number(), trajectory=trajectory, tolerance=Tolerance())
        )

    def next_number(self) -> int:
        """Return the number for the next motion."""
        self.number += 1
        return self.number


def near_home(arm: WatchedArm, random_: random.Random) -> Array:
    """Return joints near home."""
    limits = arm.model.limits
    goal = arm.home + np.array([random_.uniform(-0.6, 0.6) for _ in arm.home])
    return np.clip(goal, limits.lower_rad, limits.upper_rad)


def random_trajectory(arm: WatchedArm, random_: random.Random, *, speed: float = 1.0) -> JointTrajectory:
    """Return a fast motion to somewhere near home."""
    model = arm.model
    return plan_joints(
        arm.set_point, near_home(arm, random_), speed=speed, limits=model.limits, joint_names=model.arm_joints
    )


def follow(arm: WatchedArm, random_: random.Random) -> None:
    arm.simulation.apply(
        FollowTrajectory(
            arm="left", motion=arm.next_number(), trajectory=random_trajectory(arm, random_), tolerance=Tolerance()
        )
    )


def guarded(arm: WatchedArm, random_: random.Random) -> None:
    """Every other one meets something."""
    contact = ContactCondition(force_n=5.0)
    arm.simulation.apply(
        FollowTrajectory(
            arm="left",
            motion=arm.next_number(),
            trajectory=random_trajectory(arm, random_),
            tolerance=Tolerance(),
            until=contact,
        )
    )
    if random_.random() < 0.5:
        arm.simulation.apply(PushSimBody(push=PushBody(body=arm.tool_body, force_n=(0.0, 8.0, 0.0), duration_s=0.05)))


def track_force(arm: WatchedArm, random_: random.Random) -> None:
    """Pressed from outside now and then, so that the admittance works."""
    trajectory = random_trajectory(arm, random_, speed=0.2)
    samples = len(trajectory.position_rad)
    task = ForceTask(
        trajectory=trajectory, offset=np.zeros((samples, 6)), wrench=np.zeros((samples, 6)), admittance=Compliance()
    )
    arm.simulation.apply(TrackForce(arm="left", motion=arm.next_number(), task=task, tolerance=Tolerance()))
    arm.simulation.apply(
        PushSimBody(push=PushBody(body=arm.tool_body, force_n=(0.0, 0.0, random_.uniform(-10, 10)), duration_s=0.2))
    )


def stream(arm: WatchedArm, random_: random.Random) -> None:
    """One far target."""
    number = arm.next_number()
    goal = near_home(arm, random_)
    arm.simulation.apply(StartStream(arm="left", motion=number, kind="joint_position", watchdog_s=0.5))
    arm.simulation.apply(Setpoint(arm="left", motion=number, values=tuple(goal.tolist())))


def jog(arm: WatchedArm, random_: random.Random) -> None:
    """All joints, as fast as they may at most."""
    number = arm.next_number()
    speed = tuple(float(random_.uniform(-1.0, 1.0) * limit) for limit in arm.model.limits.velocity_rad_s)
    arm.simulation.apply(StartStream(arm="left", motion=number, kind="joint_velocity", watchdog_s=0.5))
    arm.simulation.apply(Setpoint(arm="left", motion=number, values=speed))


def twist(arm: WatchedArm, random_: random.Random) -> None:
    """The tool in any direction."""
    number = arm.next_number()
    values = tuple(random_.uniform(-0.3, 0.3) for _ in range(6))
    arm.simulation.apply(StartStream(arm="left", motion=number, kind="tool_twist", watchdog_s=0.5))
    arm.simulation.apply(Setpoint(arm="left", motion=number, values=values))


def guide(arm: WatchedArm, random_: random.Random) -> None:
    """Pushed by a hand."""
    force = (random_.uniform(-8, 8), random_.uniform(-8, 8), random_.uniform(-4, 4))
    arm.simulation.apply(StartGuiding(arm="left", motion=arm.next_number(), damping=0.1))
    arm.simulation.apply(PushSimBody(push=PushBody(body=arm.tool_body, force_n=force, duration_s=0.15)))


Start = Callable[[WatchedArm, random.Random], None]


STARTS: tuple[Start, ...] = (follow, guarded, track_force, stream, jog, twist, guide)
"""One for each kind of motion."""


def stop(arm: WatchedArm, random_: random.Random) -> None:
    """Cancel, hold and then cancel, or finish what can be finished."""
    match random_.randrange(3):
        case 0:
            arm.simulation.apply(HoldMotion(motion=arm.number, request=1))
            for _ in range(random_.randrange(60)):
                arm.step()
            arm.simulation.apply(CancelMotion(motion=arm.number))
        case 1:
            arm.simulation.apply(FinishStream(arm="left", motion=arm.number))
            arm.simulation.apply(CancelMotion(motion=arm.number))
        case _:
            arm.simulation.apply(CancelMotion(motion=arm.number))
