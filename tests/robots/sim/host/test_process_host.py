"""The world's own process: what happens when it, or its parent, dies; how punctual it is."""

from __future__ import annotations

import asyncio
import gc
import os
import re
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import msgspec
import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.errors import CellError, RobotError
from engine.messages import Pose
from engine.robot import DeviceStatus
from robots.port import MotionEnd, Tolerance
from robots.port.heartbeat import Heartbeat
from robots.scene.sim_scene import FixtureBody, SimScene
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import HOME, move, one_arm, smooth, until, watched

ROOT = Path(__file__).parents[4]


def alive(pid: int) -> bool:
    """Return whether a process runs (a zombie does not)."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


async def test_a_killed_world_fails_its_motions_and_refuses_the_next_instead_of_hanging() -> None:
    host = ProcessHost(one_arm())
    world = SimWorld(one_arm(), host=host)
    async with world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.3, 2.0), tolerance=Tolerance())
        holding = asyncio.create_task(motion.hold())
        await asyncio.sleep(0)
        os.kill(host.pid, signal.SIGKILL)
        report = await asyncio.wait_for(motion.report(), 30.0)
        await asyncio.wait_for(holding, 30.0)
        assert (report.end, report.reason) == (MotionEnd.FAILED, "the world's process was ended by SIGKILL")
        assert world.status is DeviceStatus.FAULT
        with pytest.raises(RobotError, match="SIGKILL"):
            world.gripper("left").close_to(width_m=0.0, speed_m_s=0.1, force_n=10.0)
        with pytest.raises(RobotError, match="SIGKILL"):
            await world.stop()
        last = world.snapshot()
        with pytest.raises(RobotError, match="SIGKILL"):
            await world.restore(last)
    async with SimWorld(one_arm(), host=ProcessHost(one_arm())) as world:
        await world.restore(last)


async def test_a_frozen_world_is_ended_and_its_motions_fail_with_that_cause() -> None:
    host = ProcessHost(watched(one_arm()))
    async with SimWorld(one_arm(), host=host) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.3, 20.0), tolerance=Tolerance())
        pid = host.pid
        os.kill(pid, signal.SIGSTOP)
        report = await motion.report()
        assert report.end is MotionEnd.FAILED
        assert re.fullmatch(
            r"the world's process has not stepped for \d\.\d s: it is frozen or starved, and was killed", report.reason
        )
        assert world.status is DeviceStatus.FAULT
    assert not alive(pid)


async def test_a_world_is_not_lost_because_the_engine_itself_did_not_look() -> None:
    """A loop that was blocked for seconds looks again before it judges."""
    scene = msgspec.structs.replace(one_arm(), world_silence_s=0.5)
    host = ProcessHost(scene)
    async with SimWorld(one_arm(), host=host) as world:
        for _ in range(3):
            time.sleep(0.8)  # noqa: ASYNC251
            await asyncio.sleep(0.0)
        assert (world.status, (await move(world.arm("left"), HOME + 0.02, 0.2)).end) == (
            DeviceStatus.READY,
            MotionEnd.REACHED,
        )


def test_a_world_whose_engine_is_killed_brings_its_arm_to_rest_and_then_ends() -> None:
    """Looked at by a third process, which reads what the world tells of itself."""
    parent, world = engine_in_mid_motion("one_arm()")
    heartbeat, process = Heartbeat.of_process(world), os.pidfd_open(world)
    assert heartbeat.at_rest_since_ns == 0
    parent.kill()
    killed_ns = time.monotonic_ns()
    _, log = parent.communicate()
    ended, _, _ = select.select([process], [], [], 60.0)
    os.close(process)
    assert ended
    assert heartbeat.at_rest_since_ns > killed_ns
    assert "flexcell world: the engine has ended; everything came to rest" in log
    heartbeat.close()


def test_a_world_whose_engine_is_suspended_brings_its_arm_to_rest_and_waits_for_it() -> None:
    parent, world = engine_in_mid_motion("watched(one_arm(), silence_s=2.0)")
    heartbeat = Heartbeat.of_process(world)
    parent.send_signal(signal.SIGSTOP)
    while heartbeat.at_rest_since_ns == 0:
        os.sched_yield()
    assert alive(world)
    parent.send_signal(signal.SIGCONT)
    answer, log = parent.communicate()
    assert re.fullmatch(r"failed the engine has been silent for \d\.\d s; left came to rest by itself\n", answer)
    assert "flexcell world: the engine has been silent for 2." in log
    heartbeat.close()


def engine_in_mid_motion(scene: str) -> tuple[subprocess.Popen[str], int]:
    """Start a process that moves an arm, and return it once the arm moves, with the world's number.

    It prints how the motion ended and ends.
    """
    parent = subprocess.Popen(
        [sys.executable, "-c", MOVING_ENGINE.format(scene)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
    )
    assert parent.stdout is not None
    return parent, int(parent.stdout.readline())


MOVING_ENGINE = """
import asyncio
from robots.port import Tolerance
from robots.sim.host.process_host import ProcessHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import HOME, one_arm, smooth, until, watched
async def main():
    host = ProcessHost({})
    async with SimWorld(one_arm(), host=host) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 1.0, 6.0), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.2)
        print(host.pid, flush=True)
        report = await motion.report()
        print(report.end.value, report.reason, flush=True)
asyncio.run(main())
"""


async def test_a_closed_world_leaves_no_process_and_brought_its_arm_to_rest() -> None:
    host = ProcessHost(one_arm())
    async with SimWorld(one_arm(), host=host) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 1.0, 60.0), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.005)
        pid = host.pid
    assert (await motion.report()).end is MotionEnd.CANCELED
    assert not alive(pid)


async def test_a_world_that_is_killed_or_frozen_while_it_is_restored_is_reported_and_not_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("robots.sim.host.process_host._ANSWER_S", 0.1)
    host = ProcessHost(one_arm())
    async with SimWorld(one_arm(), host=host) as world:
        snapshot = world.snapshot()
        os.kill(host.pid, signal.SIGSTOP)
        with pytest.raises(RobotError, match=r"did not restore its state within 0\.1 s"):
            await world.restore(snapshot)
        monkeypatch.undo()
        restoring = asyncio.create_task(world.restore(snapshot))
        await asyncio.sleep(0)
        os.kill(host.pid, signal.SIGKILL)
        with pytest.raises(RobotError, match="SIGKILL"):
            await restoring
        with pytest.raises(RobotError, match="SIGKILL"):
            await world.stop()


async def test_a_closing_that_is_cancelled_leaves_no_process() -> None:
    """Though the process is frozen and hears nothing."""
    host = ProcessHost(one_arm())
    await SimWorld(one_arm(), host=host).__aenter__()
    os.kill(host.pid, signal.SIGSTOP)
    closing = asyncio.create_task(host.close())
    await asyncio.sleep(0)
    closing.cancel()
    await asyncio.wait((closing,))
    assert (closing.cancelled(), alive(host.pid)) == (True, False)


@pytest.mark.parametrize("publishing", [True, False])
async def test_leaving_a_world_that_is_cancelled_again_and_again_leaves_no_process(publishing: bool) -> None:
    """It waits for its publisher, for rest, for the process: whichever wait is cut short, the world ends."""
    host = ProcessHost(one_arm())
    world = SimWorld(one_arm(), host=host)
    await world.__aenter__()
    if publishing:
        world.register(SkillBus(new_clock()))
    motion = world.arm("left").follow(smooth(HOME, HOME + 0.3, 2.0), tolerance=Tolerance())
    os.kill(host.pid, signal.SIGSTOP)
    leaving = asyncio.create_task(world.__aexit__(None, None, None))
    # One turn of the loop each, so that every wait is met.
    while not leaving.done():
        await asyncio.sleep(0)
        leaving.cancel()
    assert (leaving.cancelled(), alive(host.pid), world.status) == (True, False, DeviceStatus.DISCONNECTED)
    assert (await motion.report()).reason == "the world was closed"


async def test_a_process_that_does_not_start_is_an_error_and_leaves_nothing_open(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A socket left open would be a warning, and so a failure."""
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    with pytest.raises(RobotError, match="the world's process does not start"):
        await SimWorld(one_arm(), host=ProcessHost(one_arm())).__aenter__()
    gc.collect()


async def test_a_world_that_is_not_built_in_time_says_what_to_do_and_leaves_no_process() -> None:
    host = ProcessHost(msgspec.structs.replace(one_arm(), start_limit_s=0.01))
    with pytest.raises(RobotError) as error:
        await SimWorld(one_arm(), host=host).__aenter__()
    assert str(error.value) == (
        "the world's process was started and had not built the world after 0.01 s (the machine may be overloaded: end"
        " other programs and start again, or allow more time in the cell,"
        " `world: {kind: mujoco, start_limit_s: 0.02}`)"
    )
    assert not host.pid


async def test_a_world_that_cannot_be_built_says_why() -> None:
    egg = FixtureBody(name="egg", shape="egg", size_m=(0.1,), pose=Pose(xyz=(0.0, 0.0, 0.0)))
    host = ProcessHost(SimScene(fixtures=(egg,)))
    with pytest.raises(CellError, match="a egg cannot have the size"):
        async with SimWorld(SimScene(), host=host):
            pass
    assert not alive(host.pid)


async def test_punctuality_is_counted() -> None:
    host = ProcessHost(one_arm())
    async with SimWorld(one_arm(), host=host) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.01, 0.2), tolerance=Tolerance())
        await motion.report()
        timing = host.timing()
        assert 0.0 < timing.late_p50_s <= timing.late_p99_s
        assert timing.late_max_s > 0.0
        assert 0 <= timing.overruns <= timing.steps
        assert world.measured().time_s > 0.1


def test_the_world_ends_when_its_parent_is_killed() -> None:
    script = (
        "import asyncio\n"
        "from robots.sim.host.process_host import ProcessHost\n"
        "from robots.scene.sim_scene import SimScene\n"
        "from robots.sim.world.sim_world import SimWorld\n"
        "async def main():\n"
        "    host = ProcessHost(SimScene())\n"
        "    async with SimWorld(SimScene(), host=host):\n"
        "        print(host.pid, flush=True)\n"
        "        await asyncio.Event().wait()\n"
        "asyncio.run(main())\n"
    )
    parent = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True, cwd=ROOT)
    assert parent.stdout is not None
    with parent.stdout:
        world = int(parent.stdout.readline())
    process = os.pidfd_open(world)
    parent.kill()
    parent.wait()
    # The descriptor can be read once the process has ended.
    ended, _, _ = select.select([process], [], [], 60.0)
    os.close(process)
    assert ended
