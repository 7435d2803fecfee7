"""Every way to move a simulated arm through its port: guarded, streamed, led by hand, slowed down."""

from __future__ import annotations

import asyncio

import numpy as np
import pytest
from msgspec.structs import replace

from engine.errors import RobotError
from engine.skills.arm_control import ControlSettings
from robots.port import ContactCondition, ForceRecord, ForceTask, MotionEnd, Tolerance
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import ABOVE_PART, HOME, both_hosts_nightly, move, one_arm, opened, smooth, until

TOOL = "left/panda_hand_tcp"
DOWN_TO_THE_TABLE = ABOVE_PART + np.array([0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0])


def off_rad(world: SimWorld, joints: np.ndarray) -> float:
    """Return how far the arm is from these joints."""
    return float(np.abs(world.arm("left").sample().position_rad - joints).max())


@both_hosts_nightly
async def test_a_guarded_motion_ends_at_the_table(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        await move(arm, ABOVE_PART, 1.2)
        until_ = ContactCondition(force_n=10.0, direction=(0.0, 0.0, 1.0))
        motion = arm.follow(smooth(ABOVE_PART, DOWN_TO_THE_TABLE, 4.0), tolerance=Tolerance(), until=until_)
        report = await motion.report()
        assert (report.end, report.contact) == (MotionEnd.REACHED, True)
        assert motion.progress < 1.0
        assert np.abs(arm.sample().velocity_rad_s).max() < 0.02


@pytest.mark.virtual
async def test_a_guarded_motion_that_meets_nothing_ends_at_its_goal() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        motion = arm.follow(smooth(HOME, ABOVE_PART, 1.0), tolerance=Tolerance(), until=ContactCondition(force_n=5.0))
        report = await motion.report()
        assert (report.end, report.contact) == (MotionEnd.REACHED, False)
        assert off_rad(world, ABOVE_PART) < 0.005


@both_hosts_nightly
async def test_a_force_task_is_followed_and_reports_what_it_felt(host: str) -> None:
    """Nothing presses but a hand for a while: the tool gives way along z, and the record says by how much."""
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        way = smooth(HOME, HOME + np.array([0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 1.0)
        none = np.zeros((len(way.position_rad), 6))
        motion = arm.track_force(ForceTask(trajectory=way, offset=none, wrench=none), tolerance=Tolerance())
        world.push(TOOL, force_n=(0.0, 0.0, 10.0), duration_s=0.5)
        report = await motion.report()
        record = ForceRecord.from_bytes(report.data)
        assert (report.end, record.shares()[-1] > 0.98) == (MotionEnd.REACHED, True)
        assert record.wrenches()[:, 2].max() > 8.0
        assert 0.005 < record.offsets()[:, 2].max() < 0.03


@both_hosts_nightly
async def test_an_arm_goes_where_it_is_streamed_and_ends_when_it_is_finished(host: str) -> None:
    async with opened(one_arm()) as world:
        stream = world.arm("left").stream("joint_position", watchdog_s=0.3)
        for share in np.linspace(0.0, 1.0, 40):
            stream.send(tuple((HOME + 0.3 * share).tolist()))
            await asyncio.sleep(0.02)

        def arrived() -> bool:
            stream.send(tuple((HOME + 0.3).tolist()))
            return off_rad(world, HOME + 0.3) < 0.003

        await until(arrived)
        stream.finish()
        assert (await stream.report()).end is MotionEnd.REACHED
        stream.send(tuple(HOME.tolist()))
        assert (await move(world.arm("left"), HOME, 0.6)).end is MotionEnd.REACHED


@both_hosts_nightly
async def test_a_silent_stream_comes_to_rest_and_goes_on_when_spoken_to(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        stream = arm.stream("joint_velocity", watchdog_s=0.1)

        def turning(rad_s: float) -> bool:
            stream.send((rad_s, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
            return float(arm.sample().velocity_rad_s[0]) / rad_s > 0.6

        await until(lambda: turning(0.5))
        await until(lambda: float(np.abs(arm.sample().velocity_rad_s).max()) < 0.02)
        await until(lambda: turning(-0.5))
        stream.cancel()
        assert (await stream.report()).end is MotionEnd.CANCELED


@pytest.mark.virtual
async def test_a_twist_moves_the_tool_along_the_axes_of_the_world() -> None:
    async with opened(one_arm()) as world:
        frames = world.host.summary.frames
        row = frames.index("left/panda_hand_tcp")
        stream = world.arm("left").stream("tool_twist", watchdog_s=2.0)
        stream.send((0.0, 0.1, 0.0, 0.0, 0.0, 0.0))
        await asyncio.sleep(0.5)
        start = np.array(world.measured().frames()[0][row])
        await asyncio.sleep(1.0)
        moved = np.array(world.measured().frames()[0][row]) - start
        stream.finish()
        await stream.report()
        assert moved == pytest.approx([0.0, 0.1, 0.0], abs=0.003)


@both_hosts_nightly
async def test_an_arm_is_led_by_hand_and_stays_where_it_is_left(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        led = arm.guide(damping=0.3)
        world.push(TOOL, force_n=(0.0, 20.0, 0.0), duration_s=0.5)
        await until(lambda: off_rad(world, HOME) > 0.1)
        await until(lambda: float(np.abs(arm.sample().velocity_rad_s).max()) < 0.01)
        led.finish()
        assert (await led.report()).end is MotionEnd.REACHED
        at = arm.sample()
        assert np.abs(at.desired_rad - at.position_rad).max() < 0.003
        await until(lambda: arm.sample().time_s > at.time_s + 0.3)
        assert off_rad(world, at.position_rad) < 0.003
        assert (await move(arm, HOME, 0.8)).end is MotionEnd.REACHED


@both_hosts_nightly
@pytest.mark.parametrize("order", ["held, then finished", "finished, then held"])
async def test_a_stream_that_is_held_and_finished_ends_whichever_came_first(host: str, order: str) -> None:
    """Both callers get their answer; nobody has to resume it."""
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        led = arm.guide()
        if order == "held, then finished":
            await led.hold()
            led.finish()
        else:
            led.finish()
            await led.hold()
        assert (await led.report()).end is MotionEnd.REACHED
        assert (await move(arm, HOME + 0.1, 0.6)).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_a_held_guide_holds_the_arm_and_a_resumed_one_floats_again() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        led = arm.guide()
        await asyncio.sleep(0.1)
        await led.hold()
        world.push(TOOL, force_n=(0.0, 20.0, 0.0), duration_s=0.3)
        await asyncio.sleep(0.3)
        assert off_rad(world, HOME) < 0.03
        await asyncio.sleep(0.5)
        await led.resume()
        world.push(TOOL, force_n=(0.0, 20.0, 0.0), duration_s=0.3)
        await asyncio.sleep(0.3)
        assert off_rad(world, HOME) > 0.05
        led.cancel()
        assert (await led.report()).end is MotionEnd.CANCELED


@pytest.mark.virtual
async def test_a_floating_arm_is_pushed_back_before_its_limit() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        led = arm.guide(damping=0.02)
        world.push(TOOL, force_n=(0.0, 40.0, 0.0), duration_s=1.5)
        highest = 0.0
        for _ in range(300):
            await asyncio.sleep(0.01)
            highest = max(highest, abs(float(arm.sample().position_rad[0])))
        led.cancel()
        await led.report()
        assert highest < 2.8973


@both_hosts_nightly
async def test_a_speed_override_slows_what_runs_and_what_comes(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        motion = arm.follow(smooth(HOME, HOME + 0.4, 1.0), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.3)
        arm.configure(ControlSettings(speed_override=0.25))
        left, start = 1.0 - motion.progress, world.measured().time_s
        assert (await motion.report()).end is MotionEnd.REACHED
        assert world.measured().time_s - start > left / 0.25 * 0.8
        start = world.measured().time_s
        assert (await move(arm, HOME + 0.5, 0.4)).end is MotionEnd.REACHED
        assert world.measured().time_s - start > 1.5


@both_hosts_nightly
async def test_settings_are_kept_or_refused_as_a_whole(host: str) -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        good = ControlSettings(controller="cartesian_impedance", load_kg=1.0)
        arm.configure(good)
        with pytest.raises(RobotError, match="load_kg cannot be -1"):
            arm.configure(replace(good, load_kg=-1.0, speed_override=0.5))
        assert arm.settings == good


@pytest.mark.virtual
@pytest.mark.parametrize(
    ("controller", "load_kg"), [("cartesian_impedance", 0.0), ("joint_impedance", 1.5), ("cartesian_impedance", 1.5)]
)
async def test_a_restored_world_keeps_its_settings_and_nothing_sags(controller: str, load_kg: float) -> None:
    settings = replace(ControlSettings(speed_override=0.5), controller=controller, load_kg=load_kg)
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        arm.configure(settings)
        world.push(TOOL, force_n=(0.0, 0.0, -9.81 * load_kg), duration_s=60.0)
        await asyncio.sleep(0.8)
        snapshot, before = world.snapshot(), arm.sample().position_rad.copy()
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        world.arm("left").configure(ControlSettings(load_kg=3.0))
        await world.restore(snapshot)
        assert arm.settings == settings
        world.push(TOOL, force_n=(0.0, 0.0, -9.81 * load_kg), duration_s=60.0)
        await asyncio.sleep(0.5)
        assert off_rad(world, before) < 0.0005


@pytest.mark.virtual
async def test_senseless_requests_are_refused_in_words() -> None:
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        way = smooth(HOME, HOME + 0.1, 0.3)
        with pytest.raises(RobotError, match="the contact force cannot be 0"):
            arm.follow(way, tolerance=Tolerance(), until=ContactCondition(force_n=0.0))
        with pytest.raises(RobotError, match="is not a direction"):
            arm.follow(way, tolerance=Tolerance(), until=ContactCondition(force_n=1.0, direction=(0.0, 0.0, 5.0)))
        with pytest.raises(RobotError, match="watchdog_s cannot be 0"):
            arm.stream("joint_position", watchdog_s=0.0)
        with pytest.raises(RobotError, match=r"damping cannot be 1\.5"):
            arm.guide(damping=1.5)
        with pytest.raises(RobotError, match="there is no body left/arm"):
            world.push("left/arm", force_n=(0.0, 0.0, 1.0), duration_s=1.0)
        with pytest.raises(RobotError, match="a push of 61 s"):
            world.push(TOOL, force_n=(0.0, 0.0, 1.0), duration_s=61.0)
        stream = arm.stream("joint_velocity", watchdog_s=0.1)
        with pytest.raises(RobotError, match="send 7 finite numbers"):
            stream.send((0.0,))
        with pytest.raises(RobotError, match="send 7 finite numbers"):
            stream.send((float("nan"),) * 7)
        with pytest.raises(RobotError, match="another motion is active"):
            arm.guide()
        stream.cancel()
        assert (await stream.report()).end is MotionEnd.CANCELED
