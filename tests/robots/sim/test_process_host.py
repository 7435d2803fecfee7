"""The world's own process: what happens when it, or its parent, dies; how punctual it is."""

from __future__ import annotations

import asyncio
import gc
import os
import select
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.errors import CellError, RobotError
from engine.messages import Pose
from engine.robot import DeviceStatus
from robots.port import MotionEnd, Tolerance
from robots.sim.process_host import ProcessHost
from robots.sim.scene import FixtureBody, Scene
from robots.sim.world import SimWorld
from tests.robots.sim.sim_cell import HOME, one_arm, smooth, until

ROOT = Path(__file__).parents[3]


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


async def test_a_closed_world_leaves_no_process_and_brought_its_arm_to_rest() -> None:
    host = ProcessHost(one_arm())
    async with SimWorld(one_arm(), host=host) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 1.0, 60.0), tolerance=Tolerance())
        await until(lambda: motion.progress > 0.005)
        pid = host.pid
    assert (await motion.report()).end is MotionEnd.CANCELED
    assert not alive(pid)


async def test_a_world_that_is_killed_or_frozen_while_it_is_restored_is_told_and_not_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("robots.sim.process_host._RESTORE_S", 0.1)
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


async def test_a_world_that_cannot_be_built_says_why() -> None:
    egg = FixtureBody(name="egg", shape="egg", size_m=(0.1,), pose=Pose(xyz=(0.0, 0.0, 0.0)))
    host = ProcessHost(Scene(fixtures=(egg,)))
    with pytest.raises(CellError, match="a egg cannot have the size"):
        async with SimWorld(Scene(), host=host):
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
        "from robots.sim.process_host import ProcessHost\n"
        "from robots.sim.scene import Scene\n"
        "from robots.sim.world import SimWorld\n"
        "async def main():\n"
        "    host = ProcessHost(Scene())\n"
        "    async with SimWorld(Scene(), host=host):\n"
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
