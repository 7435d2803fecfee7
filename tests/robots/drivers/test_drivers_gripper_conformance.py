"""One set of tests for grippers: the simulation, and drivers with their emulators over each transport."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Awaitable, Callable, Generator
from contextlib import asynccontextmanager
from dataclasses import dataclass

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock, run_virtual
from engine.errors import RobotError
from engine.messages import Pose
from engine.skills.gripper import GripperGrasp, GripperMove, GripperOpen, ReadGripper
from robots.gripper import GripperServer
from robots.port import GripperPort, MotionEnd
from robots.scene.sim_scene import PartBody
from robots.standard_tools.switched_gripper import SwitchedGripperPort
from tests.robots.drivers.emulated_device import Emulators
from tests.robots.drivers.emulated_gripper import CONNECTIONS, HAND, driven, emulated
from tests.robots.drivers.franka.emulated_cabinet import needs_franka
from tests.robots.drivers.franka_hand.emulated_franka_hand import (
    FRANKA_HAND_CONNECTIONS,
    driven_franka_hand,
    emulated_franka_hand,
)
from tests.robots.drivers.switched_tool.switched_under_test import SENSOR, detect, switched
from tests.robots.sim.tool_cell import ARM, block, reaching, scene

SUBJECTS = (
    "simulation",
    *CONNECTIONS,
    *(pytest.param(connection, id="franka_hand", marks=needs_franka) for connection in FRANKA_HAND_CONNECTIONS),
)
SWITCHED = "switched"
"""A gripper on outputs: it opens and closes, and nothing measures an opening."""
WIDTH_M = 0.05
GRASP = GripperGrasp(width_m=WIDTH_M, force_n=60.0, speed_m_s=0.15)


@dataclass
class Gripper:
    """The gripper under test."""

    bus: SkillBus
    port: GripperPort


Scenario = Callable[[Gripper], Awaitable[None]]


@asynccontextmanager
async def simulated(object_m: float | None) -> AsyncGenerator[Gripper]:
    """A 2F-85 on a UR10 in a world, around a box on a table or above the bare table."""
    xyz, down = (0.7, 0.1, 0.13), (0.70710678, -0.70710678, 0.0, 0.0)
    pose = Pose(xyz=(*xyz[:2], 0.13))
    box = PartBody(name="part", shape="box", size_m=(object_m or 0.0, 0.05, 0.06), mass_kg=0.5, pose=pose)
    parts = (box,) if object_m is not None else ()
    cell = scene("ur10", "robotiq_2f85", parts=parts, fixtures=(block("table", (0.8, 0.0, 0.1), (0.8, 0.8)),))
    async with reaching(cell) as reach, SkillBus(new_clock()) as bus:
        assert (await reach.to((*xyz[:2], 0.3), down, duration_s=1.5)).end is MotionEnd.REACHED
        assert (await reach.to(xyz, down)).end is MotionEnd.REACHED
        port = reach.world.gripper(ARM)
        GripperServer(name=HAND, port=port).register(bus)
        yield Gripper(bus, port)


@pytest.fixture(scope="module")
def emulators() -> Generator[Emulators]:
    """The emulators of this file, each started at its first use."""
    with Emulators(lambda name: emulated(name) if name in CONNECTIONS else emulated_franka_hand(name)) as started:
        yield started


def run(subject: str, emulators: Emulators, scenario: Scenario, *, object_m: float | None = None) -> None:
    """Execute a scenario on a gripper, in the time that it lives in."""

    async def in_simulation() -> None:
        async with simulated(object_m) as gripper:
            await scenario(gripper)

    async def on_outputs() -> None:
        async with switched("gripper", sensor={"topic": SENSOR}, hold_s=0.3, release_s=0.3) as (bus, device, _):
            detect(bus, part=object_m is not None)
            await scenario(Gripper(bus, SwitchedGripperPort(device.drive)))

    async def in_reality() -> None:
        emulator = emulators.of(subject)
        emulator.do("object", width_m=None)
        connect = driven if subject in CONNECTIONS else driven_franka_hand
        async with connect(emulator) as (bus, device):
            await bus.send_goal(GripperOpen(speed_m_s=0.15), to=HAND).result()
            emulator.do("object", width_m=object_m)
            await scenario(Gripper(bus, device.port))

    if subject == "simulation":
        run_virtual(in_simulation())
    elif subject == SWITCHED:
        run_virtual(on_outputs())
    else:
        asyncio.run(in_reality())


@pytest.mark.parametrize("subject", [*SUBJECTS, SWITCHED])
def test_a_part_of_the_expected_width_is_held_until_the_gripper_opens(subject: str, emulators: Emulators) -> None:
    async def scenario(gripper: Gripper) -> None:
        grasp = await gripper.bus.send_goal(GRASP, to=HAND).result()
        assert grasp.result is not None
        assert (grasp.status, grasp.result.held, grasp.result.reason) == (GoalStatus.SUCCEEDED, True, "")
        if subject != SWITCHED:
            assert grasp.result.width_m == pytest.approx(WIDTH_M, abs=0.001)
            assert grasp.result.force_n == pytest.approx(60.0, abs=2.0)
        assert (await gripper.bus.call(ReadGripper(), to=HAND)).held
        opened = await gripper.bus.send_goal(GripperOpen(speed_m_s=0.15), to=HAND).result()
        assert opened.result is not None
        assert opened.result.width_m == pytest.approx(gripper.port.max_width_m, abs=0.001)
        assert not (await gripper.bus.call(ReadGripper(), to=HAND)).held

    run(subject, emulators, scenario, object_m=WIDTH_M)


@pytest.mark.parametrize("subject", [*SUBJECTS, SWITCHED])
def test_fingers_that_meet_nothing_hold_nothing(subject: str, emulators: Emulators) -> None:
    async def scenario(gripper: Gripper) -> None:
        grasp = await gripper.bus.send_goal(GRASP, to=HAND).result()
        assert grasp.result is not None
        assert (grasp.status, grasp.result.held) == (GoalStatus.SUCCEEDED, False)
        nothing = ("fingers closed to 0.0 mm and touch nothing", "the sensor of the gripper detects no part")
        assert grasp.result.reason == nothing[subject == SWITCHED]

    run(subject, emulators, scenario)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_part_of_another_width_is_not_the_part(subject: str, emulators: Emulators) -> None:
    async def scenario(gripper: Gripper) -> None:
        narrow = GripperGrasp(width_m=0.03, force_n=60.0, speed_m_s=0.15)
        grasp = await gripper.bus.send_goal(narrow, to=HAND).result()
        assert grasp.result is not None
        assert not grasp.result.held
        assert "expected 20.0 mm to 40.0 mm" in grasp.result.reason

    run(subject, emulators, scenario, object_m=WIDTH_M)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_the_fingers_reach_openings_and_report_a_part_in_between(subject: str, emulators: Emulators) -> None:
    async def scenario(gripper: Gripper) -> None:
        moved = await gripper.bus.send_goal(GripperMove(width_m=0.07, speed_m_s=0.15), to=HAND).result()
        assert moved.result is not None
        assert moved.result.width_m == pytest.approx(0.07, abs=0.001)
        stuck = await gripper.bus.send_goal(GripperMove(width_m=0.02, speed_m_s=0.15), to=HAND).result()
        assert stuck.status is GoalStatus.ABORTED
        assert stuck.cause is not None
        assert stuck.cause.message.startswith("the fingers stopped at ")
        assert "instead of 20.0 mm" in stuck.cause.message

    run(subject, emulators, scenario, object_m=WIDTH_M)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_cancelled_motion_ends_at_rest_and_the_next_is_taken(subject: str, emulators: Emulators) -> None:
    async def scenario(gripper: Gripper) -> None:
        motion = gripper.port.close_to(width_m=0.0, speed_m_s=0.02, force_n=30.0)
        await gripper.bus.clock.sleep(0.5)
        assert 0.0 < motion.progress < 1.0
        motion.cancel()
        report = await motion.report()
        assert (report.end, report.at_rest) == (MotionEnd.CANCELED, True)
        rest_m = gripper.port.sample().width_m
        await gripper.bus.clock.sleep(0.3)
        assert gripper.port.sample().width_m == pytest.approx(rest_m, abs=0.0005)
        again = gripper.port.close_to(width_m=0.085, speed_m_s=0.15, force_n=30.0)
        assert (await again.report()).end is MotionEnd.REACHED

    run(subject, emulators, scenario)


@pytest.mark.parametrize("subject", SUBJECTS)
def test_a_held_motion_rests_and_resumes_to_its_goal(subject: str, emulators: Emulators) -> None:
    async def scenario(gripper: Gripper) -> None:
        motion = gripper.port.close_to(width_m=0.03, speed_m_s=0.05, force_n=30.0)
        await gripper.bus.clock.sleep(0.3)
        await motion.hold()
        rest_m = gripper.port.sample().width_m
        assert 0.03 < rest_m < 0.085
        await gripper.bus.clock.sleep(0.3)
        assert gripper.port.sample().width_m == pytest.approx(rest_m, abs=0.0005)
        await motion.resume()
        assert (await motion.report()).end is MotionEnd.REACHED
        assert gripper.port.sample().width_m == pytest.approx(0.03, abs=0.001)

    run(subject, emulators, scenario)


@pytest.mark.parametrize("subject", [*SUBJECTS, SWITCHED])
def test_a_second_motion_and_senseless_values_are_refused_with_the_reason(subject: str, emulators: Emulators) -> None:
    async def scenario(gripper: Gripper) -> None:
        for width_m, speed_m_s, force_n in ((float("nan"), 0.1, 30.0), (0.01, 0.0, 30.0), (0.01, 0.1, -1.0)):
            with pytest.raises(RobotError, match="cannot be"):
                gripper.port.close_to(width_m=width_m, speed_m_s=speed_m_s, force_n=force_n)
        motion = gripper.port.close_to(width_m=0.0, speed_m_s=0.02, force_n=30.0)
        with pytest.raises(RobotError):
            gripper.port.close_to(width_m=0.05, speed_m_s=0.1, force_n=30.0)
        motion.cancel()
        await motion.report()

    run(subject, emulators, scenario)


@pytest.mark.parametrize("subject", [*SUBJECTS, SWITCHED])
def test_goals_beyond_the_gripper_are_rejected_before_it_moves(subject: str, emulators: Emulators) -> None:
    async def scenario(gripper: Gripper) -> None:
        wide = await gripper.bus.send_goal(GripperMove(width_m=0.2), to=HAND).result()
        strong = await gripper.bus.send_goal(GripperGrasp(width_m=0.05, force_n=900.0), to=HAND).result()
        assert [wide.status, strong.status] == [GoalStatus.REJECTED, GoalStatus.REJECTED]
        assert gripper.port.sample().width_m == pytest.approx(gripper.port.max_width_m, abs=0.001)

    run(subject, emulators, scenario)
