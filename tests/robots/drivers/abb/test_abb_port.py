"""The driver on its emulator: trajectories, holds, speeds, coupled axes, what is refused, and skills on a bus."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Generator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalStatus
from engine.clock import new_clock, run_virtual
from engine.errors import CellError, RobotError
from engine.skills.arm_control import ControlSettings, SetSpeedOverride
from engine.skills.digital_outputs import SetGripper
from engine.skills.direct_control import SwitchDirectControl
from engine.skills.motion import JointTrapVel
from robots.drivers.abb.abb_connection import AbbConnection
from robots.drivers.abb.abb_motion import AbbMotion
from robots.drivers.abb.new_abb_irc5 import new_abb_irc5
from robots.drivers.abb.simple_message import SimpleMessageCodec
from robots.io.wire.read_capture import read_capture
from robots.io.wire.wire_capture import WireCapture
from robots.model import robot_model
from robots.port import Array, ContactCondition, JointTrajectory, MotionEnd, Tolerance
from tests.robots.drivers.abb.emulated_irc5 import (
    ARM,
    HOME,
    TOLERANCE,
    EmulatedIrc5,
    connected,
    emulated,
    served,
    straight,
)

ONE, OTHER = np.array([0.5, 0.3, -0.2, 0.4, 0.6, -0.5]), np.array([0.1, -0.2, 0.1, 0.0, 0.4, 0.0])


@pytest.fixture(scope="module")
def emulator() -> Generator[EmulatedIrc5]:
    """The emulator of this file."""
    with emulated(gripper_reply="done") as started:
        yield started


def run(emulator: EmulatedIrc5, scenario: Callable[[AbbConnection], Awaitable[None]], **options: Any) -> None:
    """Execute a scenario on the enabled driver."""

    async def execute() -> None:
        async with connected(emulator, **options) as connection:
            await scenario(connection)

    asyncio.run(execute())


def follow(connection: AbbConnection, goal: Array, *, duration_s: float) -> AbbMotion:
    """Start a straight motion."""
    start = connection.port.sample().position_rad
    motion = connection.port.follow(straight(start, goal, duration_s=duration_s), tolerance=TOLERANCE)
    assert isinstance(motion, AbbMotion)
    return motion


async def until(connection: AbbConnection, motion: AbbMotion, progress: float) -> None:
    """Wait for a share of a motion."""
    while motion.progress < progress:
        await connection.report(readings=1)


def test_a_trajectory_ends_at_its_goal_in_about_its_time(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        for goal in (ONE, OTHER):
            begun_s = connection.port.sample().time_s
            motion = follow(connection, goal, duration_s=2.0)
            assert (await motion.report()).end is MotionEnd.REACHED
            assert (motion.progress, emulator.axes.tolist()) == (1.0, pytest.approx(goal.tolist(), abs=1e-6))
            sample = connection.port.sample()
            assert 1.9 < sample.time_s - begun_s < 6.0
            assert sample.desired_rad.tolist() == sample.position_rad.tolist()
            assert np.abs(sample.velocity_rad_s).max() < 0.02
            assert (sample.effort_nm.any(), sample.wrench.any(), sample.external_nm.any()) == (False, False, False)

    run(emulator, scenario)


def test_a_path_that_ends_where_it_begins_is_executed(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        start = connection.port.sample().position_rad
        there, travel = straight(start, start + 0.3, duration_s=1.0), emulator.do("state")["travel_rad"]
        position = np.vstack((there.position_rad, there.position_rad[::-1]))
        loop = JointTrajectory(dt_s=0.01, position_rad=position, velocity_rad_s=np.zeros_like(position))
        report = await connection.port.follow(loop, tolerance=TOLERANCE).report()
        assert report.end is MotionEnd.REACHED
        assert emulator.do("state")["travel_rad"] - travel == pytest.approx(0.6, abs=0.05)

    run(emulator, scenario)


def test_a_motion_that_is_none_ends_as_reached(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        motion = follow(connection, connection.port.sample().position_rad, duration_s=0.02)
        assert (await motion.report()).end is MotionEnd.REACHED

    run(emulator, scenario)


def test_a_held_motion_goes_on_along_the_rest_of_its_path(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        goal = ONE if emulator.axes[0] < 0.3 else OTHER
        motion = follow(connection, goal, duration_s=3.0)
        await until(connection, motion, 0.3)
        await motion.hold()
        state = emulator.do("state")
        assert (state["in_motion"], motion.ended) == (False, False)
        await connection.report(readings=3)
        assert emulator.axes.tolist() == state["joints_rad"]
        passed = motion.progress
        assert 0.25 < passed < 0.95
        await motion.resume()
        assert emulator.do("state")["started"] == state["started"] + 1
        await motion.hold()
        await motion.resume()
        assert (await motion.report()).end is MotionEnd.REACHED
        assert emulator.axes == pytest.approx(goal, abs=1e-6)

    run(emulator, scenario)


def test_a_held_motion_is_cancelled_where_it_stands(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        motion = follow(connection, ONE if emulator.axes[0] < 0.3 else OTHER, duration_s=3.0)
        await until(connection, motion, 0.2)
        await motion.hold()
        stands = emulator.axes
        motion.cancel()
        assert (await motion.report()).end is MotionEnd.CANCELED
        assert emulator.axes.tolist() == stands.tolist()

    run(emulator, scenario)


def test_the_speed_override_stretches_downloads_also_of_the_active_motion(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        port, goal = connection.port, ONE if emulator.axes[0] < 0.3 else OTHER
        plan = port.plan(straight(port.sample().position_rad, goal, duration_s=2.0))
        port.configure(ControlSettings(speed_override=0.5))
        slow = port.plan(straight(port.sample().position_rad, goal, duration_s=2.0))
        assert slow.duration_s[1:].sum() == pytest.approx(2.0 * plan.duration_s[1:].sum())
        started = emulator.do("state")["started"]
        motion = follow(connection, goal, duration_s=2.0)
        await until(connection, motion, 0.2)
        port.configure(ControlSettings(speed_override=1.0))
        assert (await motion.report()).end is MotionEnd.REACHED
        assert emulator.do("state")["started"] == started + 2
        assert emulator.axes == pytest.approx(goal, abs=1e-6)

    run(emulator, scenario)


def test_the_controller_gets_its_coupled_axis(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        goal = np.array([0.0, 0.4, -0.3, 0.0, 0.5, 0.0])
        assert (await follow(connection, goal, duration_s=2.0).report()).end is MotionEnd.REACHED
        assert emulator.axes == pytest.approx([0.0, 0.4, 0.1, 0.0, 0.5, 0.0], abs=1e-6)
        assert connection.port.sample().position_rad == pytest.approx(goal, abs=1e-6)

    run(emulator, scenario, model=robot_model("irb4600", coupled_joints=True))


def test_the_other_byte_order_works_against_a_controller_of_it() -> None:
    async def scenario(connection: AbbConnection) -> None:
        assert (await follow(connection, ONE, duration_s=1.0).report()).end is MotionEnd.REACHED

    with emulated(byte_order="big") as turned:
        run(turned, scenario, byte_order="big")
        with pytest.raises(RobotError, match=r"does not answer: .*garbage: .*is no length.*check `byte_order`"):
            run(turned, scenario)


def test_a_path_that_a_hundred_points_cannot_keep_is_refused_with_the_amount(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        start = connection.port.sample().position_rad
        time_s = np.arange(6001) * 0.01
        position = np.tile(start, (len(time_s), 1))
        position[:, 0] += 0.2 * np.sin(2.0 * np.pi * time_s)
        position[:, 1] += 0.2 * (np.cos(2.0 * np.pi * time_s) - 1.0)
        wild = JointTrajectory(dt_s=0.01, position_rad=position, velocity_rad_s=np.zeros_like(position))
        with pytest.raises(RobotError, match=r"100 points deviate by 0\.\d+ rad from the path, more than 0\.01 rad"):
            connection.port.follow(wild, tolerance=TOLERANCE)
        assert connection.port.motion is None

    run(emulator, scenario)


def test_a_target_that_the_controller_does_not_reach_is_named(emulator: EmulatedIrc5) -> None:
    """Its own limits may be narrower than the model's: it shows a warning to itself and does not move."""

    async def scenario(connection: AbbConnection) -> None:
        start = connection.port.sample().position_rad
        motion = follow(connection, np.array([*start[:5], 8.0]), duration_s=8.0)
        report = await motion.report()
        assert report.end is MotionEnd.FAILED
        assert report.reason.startswith("not at target: the controller did not start the motion, joint_6 is ")
        assert connection.problem.startswith("not at target: ")

    run(emulator, scenario)


REFUSALS: dict[str, Callable[[Any], object]] = {
    "has no streamed set points": lambda port: port.stream("joint_position", watchdog_s=0.1),
    "has no hand guiding": lambda port: port.guide(),
    "has no force control": lambda port: port.track_force(None, tolerance=TOLERANCE),
    "has no impedance control": lambda port: port.configure(ControlSettings(controller="cartesian_impedance")),
    "and no collision reflex": lambda port: port.configure(ControlSettings(collision_force_n=10.0)),
    "define it in the tooldata": lambda port: port.configure(ControlSettings(load_kg=3.0)),
    "speed_override cannot be 0": lambda port: port.configure(ControlSettings(speed_override=0.0)),
}


@pytest.mark.parametrize("reason", REFUSALS)
def test_what_the_controller_cannot_do_is_refused_with_the_reason(emulator: EmulatedIrc5, reason: str) -> None:
    async def scenario(connection: AbbConnection) -> None:
        with pytest.raises(RobotError, match=reason):
            REFUSALS[reason](connection.port)
        assert connection.port.settings == ControlSettings()

    run(emulator, scenario)


def test_a_load_that_the_controller_covers_is_accepted_without_effect(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        connection.port.configure(ControlSettings(load_kg=3.0))
        assert connection.port.settings.load_kg == 3.0

    run(emulator, scenario, loads="defined_there")


def test_a_contact_a_second_motion_and_a_start_elsewhere_are_refused(emulator: EmulatedIrc5) -> None:
    async def scenario(connection: AbbConnection) -> None:
        port = connection.port
        here = port.sample().position_rad
        path, elsewhere = straight(here, here + 0.1, duration_s=1.0), straight(here + 0.1, here, duration_s=1.0)
        with pytest.raises(RobotError, match="contacts are not measured"):
            port.follow(path, tolerance=TOLERANCE, until=ContactCondition(force_n=5.0))
        with pytest.raises(RobotError, match=r"starts 0\.100 rad from where the arm stands"):
            port.follow(elsewhere, tolerance=TOLERANCE)
        motion = port.follow(path, tolerance=TOLERANCE)
        with pytest.raises(RobotError, match="another motion is active"):
            port.follow(path, tolerance=Tolerance())
        assert (await motion.report()).end is MotionEnd.REACHED

    run(emulator, scenario)


def test_what_is_sent_are_downloads_with_requests_of_one_reply_each(emulator: EmulatedIrc5, tmp_path: Path) -> None:
    capture = WireCapture(tmp_path, device=ARM)

    async def scenario(connection: AbbConnection) -> None:
        here = connection.port.sample().position_rad
        assert (await follow(connection, here + 0.2, duration_s=1.0).report()).end is MotionEnd.REACHED

    run(emulator, scenario, capture=capture)
    capture.close()
    (file,) = tmp_path.glob("arm.simple_message_motion.*")
    events = read_capture(file).events
    sent, received = (bytearray(b"".join(e.data for e in events if e.kind == kind)) for kind in ("sent", "received"))
    codec = SimpleMessageCodec()
    frames = codec.split(sent)
    sequences = [codec.decode_point(frame).sequence for frame in frames]
    assert sequences[:2] == [-4, -1]
    assert sequences[2:-1] == list(range(1, len(sequences) - 2))
    assert sequences[-1] == -3
    assert {frame.comm for frame in frames} == {2}
    replies = [frame for frame in codec.split(received) if frame.kind == 11]
    assert len(replies) == len(frames)


def test_virtual_time_and_seven_joints_are_refused(emulator: EmulatedIrc5) -> None:
    options = emulator.driver_options()

    async def scenario() -> None:
        with pytest.raises(CellError, match="no virtual time"):
            new_abb_irc5(options, name=ARM, clock=new_clock(), model=robot_model("irb4600"))

    async def in_real_time() -> None:
        with pytest.raises(CellError, match="has 7 joints"):
            new_abb_irc5(options, name=ARM, clock=new_clock(), model=robot_model("panda"))

    run_virtual(scenario())
    asyncio.run(in_real_time())


def test_skills_on_a_bus_move_hold_cancel_and_switch_the_gripper(emulator: EmulatedIrc5) -> None:
    async def scenario() -> None:
        async with served(emulator, gripper=emulator.gripper(reply="done")) as (bus, connection):
            there, back = JointTrapVel(joints=tuple(ONE), speed=0.1), JointTrapVel(joints=HOME, speed=0.3)
            assert (await bus.send_goal(there, to=ARM).result()).status is GoalStatus.SUCCEEDED
            assert emulator.axes == pytest.approx(ONE, abs=1e-6)
            handle = bus.send_goal(back, to=ARM)
            while connection.port.sample().position_rad[0] > 0.45:
                await bus.clock.sleep(0.01)
            await handle.hold()
            await handle.resume()
            await bus.call(SetSpeedOverride(share=0.5), to=ARM)
            handle.cancel()
            assert (await handle.result()).status is GoalStatus.CANCELED
            for on in (True, False):
                result = await bus.call(SetGripper(value=on), to=ARM)
                assert (result.success, emulator.do("state")["gripper_on"]) == (True, on)
            refused = await bus.send_goal(JointTrapVel(joints=(9.0, *HOME[1:]), speed=0.1), to=ARM).result()
            assert refused.status is not GoalStatus.SUCCEEDED
            direct = await bus.call(SwitchDirectControl(on=True), to=ARM)
            assert (direct.success, "streamed set points" in direct.message) == (False, True)

    asyncio.run(scenario())
