"""Whatever an arm does and whenever it is told to stop: no limit is passed, it comes to rest, the next goal works.

The set point is looked at after every step, 210 stops in all.
"""

from __future__ import annotations

import random
from collections.abc import Callable

import numpy as np
import pytest

from engine.skills.arm_control import ControlSettings
from engine.skills.dmp import Compliance
from engine.skills.simulated_world import PushBody
from robots.control.arm_control_loop import ArmControlLoop
from robots.control.motion_event import MotionFinished, MotionHeld
from robots.motion import plan_joints
from robots.port import Array, ContactCondition, ForceTask, JointTrajectory, MotionEnd, Tolerance
from robots.scene.sim_scene import SimScene
from robots.sim.commands.arm_commands import (
    ConfigureArm,
    FinishStream,
    FollowTrajectory,
    RecoverArm,
    Setpoint,
    StartGuiding,
    StartStream,
    TrackForce,
)
from robots.sim.commands.world_commands import CancelMotion, HoldMotion, PushSimBody
from robots.sim.loop.simulation import Simulation
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.sim.sim_cell import HOME, LEFT, PANDA

TRIALS = 30
REST_RAD_S = 0.02
LIMITS = PANDA.limits
LOWER, UPPER = np.array(LIMITS.lower_rad), np.array(LIMITS.upper_rad)
VELOCITY = np.array(LIMITS.velocity_rad_s)
ACCELERATION = np.array(LIMITS.acceleration_rad_s2)
JERK = np.array(LIMITS.jerk_rad_s3)


@pytest.fixture(scope="module", name="cell")
def _cell() -> CellModel:
    return build_cell(SimScene(arms=(LEFT,)))


class WatchedArm:
    """An arm whose set point is compared with the limits after every step."""

    def __init__(self, cell: CellModel, *, jerk: bool) -> None:
        self.simulation = Simulation(cell)
        self.control: ArmControlLoop = self.simulation.control("left")
        self.number = 0
        self.ends: list[MotionFinished] = []
        self.held = False
        self._jerk = jerk
        self._velocity = np.zeros(7)
        self._acceleration = np.zeros(7)
        self._led = True

    @property
    def set_point(self) -> Array:
        """Where the set point is."""
        return self.control.motion.position.copy()

    def step(self) -> None:
        """Let one step pass and look."""
        for event in self.simulation.step():
            if isinstance(event, MotionFinished):
                self.ends.append(event)
            self.held |= isinstance(event, MotionHeld)
        self._look()

    def _look(self) -> None:
        motion, step_s = self.control.motion, self.simulation.step_s
        velocity = motion.velocity.copy()
        acceleration = (velocity - self._velocity) / step_s
        assert (motion.position >= LOWER - 1e-9).all()
        assert (motion.position <= UPPER + 1e-9).all()
        # While a hand leads the arm the set point is where the arm is, however it is moved.
        if motion.leads and self._led:
            assert (np.abs(velocity) <= VELOCITY * 1.001).all()
            assert (np.abs(acceleration) <= ACCELERATION * 1.02).all()
            if self._jerk:
                assert (np.abs(acceleration - self._acceleration) / step_s <= JERK * 1.02).all()
        self._velocity, self._acceleration, self._led = velocity, acceleration, motion.leads

    def next_number(self) -> int:
        """Return the number for the next motion."""
        self.number += 1
        return self.number


def random_trajectory(arm: WatchedArm, random_: random.Random, *, speed: float = 1.0) -> JointTrajectory:
    """Return a fast motion to somewhere near home."""
    goal = HOME + np.array([random_.uniform(-0.6, 0.6) for _ in range(7)])
    return plan_joints(arm.set_point, goal, speed=speed, limits=LIMITS, joint_names=PANDA.arm_joints)


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
        arm.simulation.apply(
            PushSimBody(push=PushBody(body="left/panda_hand", force_n=(0.0, 8.0, 0.0), duration_s=0.05))
        )


def track_force(arm: WatchedArm, random_: random.Random) -> None:
    """Pressed from outside now and then, so that the admittance works."""
    trajectory = random_trajectory(arm, random_, speed=0.2)
    samples = len(trajectory.position_rad)
    task = ForceTask(
        trajectory=trajectory, offset=np.zeros((samples, 6)), wrench=np.zeros((samples, 6)), admittance=Compliance()
    )
    arm.simulation.apply(TrackForce(arm="left", motion=arm.next_number(), task=task, tolerance=Tolerance()))
    arm.simulation.apply(
        PushSimBody(push=PushBody(body="left/panda_hand", force_n=(0.0, 0.0, random_.uniform(-10, 10)), duration_s=0.2))
    )


def stream(arm: WatchedArm, random_: random.Random) -> None:
    """One far target."""
    number = arm.next_number()
    goal = HOME + np.array([random_.uniform(-0.6, 0.6) for _ in range(7)])
    arm.simulation.apply(StartStream(arm="left", motion=number, kind="joint_position", watchdog_s=0.5))
    arm.simulation.apply(Setpoint(arm="left", motion=number, values=tuple(goal.tolist())))


def jog(arm: WatchedArm, random_: random.Random) -> None:
    """All joints, as fast as they may at most."""
    number = arm.next_number()
    speed = tuple(float(random_.uniform(-1.0, 1.0) * limit) for limit in VELOCITY)
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
    arm.simulation.apply(PushSimBody(push=PushBody(body="left/panda_hand", force_n=force, duration_s=0.15)))


Start = Callable[[WatchedArm, random.Random], None]


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


@pytest.mark.parametrize(
    ("start", "jerk"),
    [
        (follow, False),
        (guarded, False),
        (track_force, False),
        (stream, True),
        (jog, True),
        (twist, True),
        (guide, False),
    ],
    ids=lambda value: getattr(value, "__name__", "jerk" if value else "no_jerk"),
)
def test_a_stop_at_any_instant_keeps_the_limits_and_ends_at_rest(cell: CellModel, start: Start, *, jerk: bool) -> None:
    random_ = random.Random(start.__name__)
    arm = WatchedArm(cell, jerk=jerk)
    for _ in range(TRIALS):
        start(arm, random_)
        for _ in range(random_.randrange(250)):
            arm.step()
        stop(arm, random_)
        for _ in range(3000):
            if arm.ends and arm.ends[-1].motion == arm.number:
                break
            arm.step()
        end = arm.ends[-1]
        assert (end.motion, end.report.reason) == (arm.number, "")
        assert np.abs(arm.control.state.velocity).max() < REST_RAD_S
        assert np.abs(arm.control.motion.velocity).max() == 0.0


def test_a_reflex_at_any_instant_keeps_the_limits_and_ends_at_rest(cell: CellModel) -> None:
    """A knock on the way stops the arm; once it has recovered, the next motion trips again."""
    random_ = random.Random(5)
    arm = WatchedArm(cell, jerk=False)
    arm.simulation.apply(ConfigureArm(arm="left", settings=ControlSettings(collision_force_n=20.0)))
    for _ in range(10):
        follow(arm, random_)
        for _ in range(random_.randrange(20, 250)):
            arm.step()
        arm.simulation.apply(
            PushSimBody(push=PushBody(body="left/panda_hand", force_n=(0.0, 60.0, 0.0), duration_s=0.02))
        )
        for _ in range(3000):
            if arm.ends and arm.ends[-1].motion == arm.number:
                break
            arm.step()
        assert (arm.ends[-1].report.end, arm.control.reflex) == (MotionEnd.FAILED, True)
        assert arm.ends[-1].report.reason.startswith("external force limit exceeded")
        assert np.abs(arm.control.state.velocity).max() < REST_RAD_S
        arm.simulation.apply(RecoverArm(arm="left"))
        arm.step()
        assert not arm.control.reflex
