"""What every arm does behind its port, simulated or real: the same motions, holds, ends and refusals."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

import msgspec
import numpy as np
import pytest

from engine.errors import RobotError
from robots.port import ContactCondition, MotionEnd
from tests.robots.drivers.arm_under_test import ARMS, CLIENTS, FOLLOWERS, WIDE, arm_under_test, lasting_emulators
from tests.robots.drivers.emulated_device import Emulators
from tests.robots.sim.sim_cell import until

every_follower = pytest.mark.parametrize("kind", FOLLOWERS)
every_arm = pytest.mark.parametrize("kind", ARMS)
# What happens before a controller is reached is tested with those that start fast.
most_followers = pytest.mark.parametrize("kind", FOLLOWERS[:-1])
most_arms = pytest.mark.parametrize("kind", ARMS[:-1])


@pytest.fixture(scope="module")
def emulators() -> Generator[Emulators]:
    """Return the emulators of this file, each started at its first use."""
    with lasting_emulators() as started:
        yield started


@every_follower
async def test_an_arm_follows_a_path_to_its_goal(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        motion = arm.port.follow(arm.path(arm.near), tolerance=WIDE)
        report = await motion.report()
        assert (report.end, report.reason, report.at_rest, motion.progress) == (MotionEnd.REACHED, "", True, 1.0)
        assert await arm.settled() == pytest.approx(arm.near, abs=0.01)


@every_follower
async def test_a_held_motion_rests_on_its_path_and_goes_on_from_there(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        motion = arm.port.follow(arm.path(arm.far, 4.0), tolerance=WIDE)
        await until(lambda: motion.progress > 0.1)
        await motion.hold()
        held, progress = await arm.settled(), motion.progress
        time_s = arm.port.sample().time_s
        await until(lambda: arm.port.sample().time_s > time_s + 0.2)
        assert await arm.settled() == pytest.approx(held, abs=1e-3)
        assert motion.progress == progress < 1.0
        await motion.resume()
        assert (await motion.report()).end is MotionEnd.REACHED
        assert await arm.settled() == pytest.approx(arm.far, abs=0.01)


@every_follower
async def test_a_cancelled_motion_slows_down_at_once_and_ends_at_rest(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        motion = arm.port.follow(arm.path(arm.far, 6.0), tolerance=WIDE)
        await until(lambda: motion.progress > 0.2)
        before = arm.port.sample()
        motion.cancel()
        report = await motion.report()
        after = arm.port.sample()
        assert (report.end, report.at_rest) == (MotionEnd.CANCELED, True)
        # By the device's own clock: 0.1 s until the request acts, and the time to brake.
        assert after.time_s - before.time_s < 1.5
        assert np.abs(after.position_rad - before.position_rad).max() < 0.5
        assert np.abs(after.velocity_rad_s).max() < 0.01
        assert (await arm.move(arm.start, 2.0)).end is MotionEnd.REACHED


@most_followers
async def test_a_second_motion_is_refused_while_one_is_active(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        motion = arm.port.follow(arm.path(arm.far, 4.0), tolerance=WIDE)
        with pytest.raises(RobotError, match="another motion is active"):
            arm.port.follow(arm.path(arm.near), tolerance=WIDE)
        motion.cancel()
        assert (await motion.report()).end is MotionEnd.CANCELED


@every_follower
async def test_a_stream_is_followed_and_rests_when_nothing_comes(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        stream = arm.port.stream("joint_position", watchdog_s=0.3)
        stream.send(tuple(arm.near.tolist()))
        await until(lambda: bool(np.abs(arm.port.sample().position_rad - arm.start).max() > 0.02))
        # Nothing more is sent: the arm brakes on its own.
        await until(lambda: bool((np.abs(arm.port.sample().velocity_rad_s) < 0.01).all()))
        stopped = await arm.settled()
        stream.finish()
        report = await stream.report()
        assert report.end is MotionEnd.REACHED
        assert await arm.settled() == pytest.approx(stopped, abs=0.01)


@most_followers
async def test_a_jog_moves_one_joint_and_ends_at_rest(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        stream = arm.port.stream("joint_velocity", watchdog_s=2.0)
        stream.send((0.2, *(0.0,) * (arm.start.size - 1)))
        await until(lambda: bool(arm.port.sample().position_rad[0] > 0.05))
        stream.finish()
        assert (await stream.report()).end is MotionEnd.REACHED
        moved = np.abs(await arm.settled() - arm.start)
        assert moved[0] > 0.05
        assert moved[1:].max() < 0.01


@every_arm
async def test_a_guarded_motion_ends_at_the_contact(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        contact = ContactCondition(force_n=25.0, direction=(0.0, 0.0, 1.0))
        motion = arm.port.follow(arm.path(arm.far, 6.0), tolerance=WIDE, until=contact)
        await until(lambda: motion.progress > 0.1)
        arm.push((0.0, 0.0, 60.0))
        report = await motion.report()
        assert (report.end, report.contact) == (MotionEnd.REACHED, True)
        assert motion.progress < 1.0
        assert arm.port.sample().wrench.shape == (6,)


@most_arms
async def test_a_force_from_another_direction_ends_no_guarded_motion(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        contact = ContactCondition(force_n=25.0, direction=(1.0, 0.0, 0.0))
        motion = arm.port.follow(arm.path(arm.near, 2.0), tolerance=WIDE, until=contact)
        arm.push((-60.0, 0.0, 0.0))
        report = await motion.report()
        assert (report.end, report.contact) == (MotionEnd.REACHED, False)


@every_follower
async def test_settings_act_from_the_next_motion_on_and_wrong_ones_are_refused(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        port = arm.port
        begin = port.sample().time_s
        await arm.move(arm.near, 1.0)
        fast_s = port.sample().time_s - begin
        port.configure(msgspec.structs.replace(port.settings, speed_override=0.4))
        begin = port.sample().time_s
        await arm.move(arm.start, 1.0)
        assert port.sample().time_s - begin > 1.3 * fast_s
        assert port.settings.speed_override == 0.4
        with pytest.raises(RobotError):
            port.configure(msgspec.structs.replace(port.settings, load_kg=-1.0))
        assert port.settings.load_kg == 0.0


@most_followers
async def test_recovering_without_a_reflex_changes_nothing(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        arm.port.recover()
        assert not arm.port.sample().reflex
        assert (await arm.move(arm.near)).end is MotionEnd.REACHED


@most_followers
async def test_a_path_that_begins_elsewhere_is_refused(kind: str, emulators: Emulators) -> None:
    async with arm_under_test(kind, emulators) as arm:
        path = arm.path(arm.near)
        with pytest.raises(RobotError):
            arm.port.follow(replace(path, position_rad=path.position_rad + 0.2), tolerance=WIDE)


@pytest.mark.parametrize("client", CLIENTS)
async def test_an_e_series_controller_follows_at_500_hz(client: str, emulators: Emulators) -> None:
    async with arm_under_test(client, emulators, series="e") as arm:
        assert (await arm.move(arm.near)).end is MotionEnd.REACHED
        assert await arm.settled() == pytest.approx(arm.near, abs=0.01)
