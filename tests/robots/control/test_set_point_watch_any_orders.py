"""Whatever an arm is told, whenever: none of its set points exceeds position, velocity, acceleration or jerk.

The watch of the control loop compares them all, and `conftest` fails the test in which it reports one.
"""

from __future__ import annotations

import random
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from engine.skills.arm_control import ControlSettings
from engine.skills.simulated_world import PushBody
from robots.control.commanding.arm_commands import ConfigureArm, HoldMotion, RecoverArm, ResumeMotion, StopAll
from robots.model.registry import model_by_name
from robots.model.robot_model import RobotModel
from robots.port import JointTrajectory, MotionEnd
from robots.scene.sim_scene import ArmPlacement, SimScene
from robots.sim.commands.world_commands import PushSimBody
from robots.sim.physics.cell_model import CellModel, build_cell
from tests.robots.control.arm_orders import STARTS, WatchedArm, stop
from tests.robots.sim.sim_cell import ABOVE_PART, LEFT, one_arm
from tests.robots.sim.stepped import SteppedArm
from tests.tiers import examples

SETTINGS = (
    ControlSettings(speed_override=0.1),
    ControlSettings(speed_override=1.0),
    ControlSettings(tool_xyz_m=(0.0, 0.05, 0.1)),
    ControlSettings(load_kg=0.5),
    ControlSettings(controller="cartesian_impedance"),
    ControlSettings(collision_force_n=25.0),
)


@dataclass(frozen=True, kw_only=True)
class Order:
    """A motion, the time until it is disturbed, and how."""

    start: int
    wait: int
    disturbance: int
    seed: int


ORDERS = st.builds(
    Order, start=st.integers(0, len(STARTS) - 1), wait=st.integers(0, 600), disturbance=st.integers(0, 5),
    seed=st.integers(0, 10_000),
)  # fmt: skip


@cache
def cell_of(name: str) -> tuple[CellModel, RobotModel]:
    """Return a world with one arm."""
    placement = ArmPlacement(name="left", model=name, base=LEFT.base)
    return build_cell(SimScene(arms=(placement,))), model_by_name(name)


def give(arm: WatchedArm, order: Order) -> None:
    """Start a motion, let some time pass, disturb it, and let it end."""
    random_ = random.Random(order.seed)
    arm.simulation.apply(RecoverArm(arm="left"))
    STARTS[order.start](arm, random_)
    for _ in range(order.wait):
        arm.step()
    match order.disturbance:
        case 0:
            arm.simulation.apply(StopAll())
        case 1:
            for _ in range(3):
                arm.simulation.apply(HoldMotion(motion=arm.number, request=1))
                pass_time(arm, random_.randrange(150))
                arm.simulation.apply(ResumeMotion(motion=arm.number, request=2))
                pass_time(arm, random_.randrange(150))
        case 2:
            arm.simulation.apply(ConfigureArm(arm="left", settings=random_.choice(SETTINGS)))
            pass_time(arm, random_.randrange(300))
        case 3:
            force = (random_.uniform(-80.0, 80.0), random_.uniform(-80.0, 80.0), 0.0)
            arm.simulation.apply(PushSimBody(push=PushBody(body=arm.tool_body, force_n=force, duration_s=0.1)))
            pass_time(arm, random_.randrange(300))
        case 4:
            arm.control.motion.fail("it is told so")
        case _:
            pass
    stop(arm, random_)
    arm.until_ended()


def pass_time(arm: WatchedArm, steps: int) -> None:
    """Let time pass."""
    for _ in range(steps):
        arm.step()


@pytest.mark.parametrize("name", ["panda", "ur10", "irb4600"])
@settings(max_examples=examples(3, nightly=80), deadline=None)
@given(orders=st.lists(ORDERS, min_size=1, max_size=5))
def test_whatever_is_ordered_whenever_no_set_point_jumps(name: str, orders: list[Order]) -> None:
    cell, model = cell_of(name)
    arm = WatchedArm(cell, model)
    for order in orders:
        give(arm, order)
    assert arm.control.watch.count == 0


def test_an_aborted_place_takes_its_set_point_back_within_the_limits() -> None:
    """The table holds the arm up until it is too far behind. Its set point once stepped back: 106 times the limit."""
    arm = SteppedArm(build_cell(one_arm()))
    arm.follow(ABOVE_PART, 1.2)
    assert arm.until_finished(1).end is MotionEnd.REACHED
    below = ABOVE_PART + np.array([0.0, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0])
    positions = [arm.control.motion.position.copy()]
    arm.events.clear()
    arm.follow(below, 1.5, motion=2)
    while not any(event.motion == 2 for event in arm.events):
        arm.step()
        positions.append(arm.control.motion.position.copy())
        assert len(positions) < 5000
    report = arm.until_finished(2)
    assert "behind its set point" in report.reason
    limits = model_by_name("panda").limits
    acceleration = np.abs(np.diff(np.array(positions), 2, axis=0)) / 1e-6
    assert (acceleration <= np.array(limits.acceleration_rad_s2) * 1.02).all()
    # It no longer presses.
    assert np.abs(arm.control.motion.position - arm.control.state.position).max() < 0.02


def test_a_primitive_that_begins_with_a_push_gathers_pace_within_the_jerk() -> None:
    """An attractor is pulled from its first instant: constant acceleration from rest."""
    cell, model = cell_of("ur10")
    arm = WatchedArm(cell, model)
    u = np.linspace(0.0, 1.0, 501)[:, None]
    span = np.eye(6)[0] * 0.3
    arm.follow_trajectory(
        JointTrajectory(
            dt_s=0.002,
            position_rad=arm.set_point + span * (6 * u**2 - 8 * u**3 + 3 * u**4),
            velocity_rad_s=span * 12 * u * (1 - u) ** 2,
        )
    )
    assert arm.until_ended().report.end is MotionEnd.REACHED
    assert arm.control.watch.count == 0
