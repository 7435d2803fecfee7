"""A world that was lost in mid-motion goes on in a new one: at rest where it was, its part still in the fingers."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import time
import timeit
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from engine.clock import run_virtual
from engine.errors import RobotError
from engine.messages import Vector3
from robots.port import ArmSample, Array, MotionEnd, Tolerance
from robots.scene.sim_scene import SimScene
from robots.sim.host.lockstep_host import LockstepHost
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import (
    ABOVE_PART,
    HOME,
    LIFTED,
    box,
    grasp,
    move,
    one_arm,
    opened,
    part_xyz,
    smooth,
    two_arms,
    until,
)

ROOT = Path(__file__).parents[4]
SCENE = one_arm(box("part"))
# The part is carried over the table by turning the base.
ACROSS = LIFTED + np.array([0.9, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
REST_RAD_S = 0.02


@dataclass(frozen=True)
class Carried:
    """Where the world was when it was lost, and what it left behind."""

    snapshot: bytes
    time_s: float
    joints_rad: Array
    speed_rad_s: float
    part_xyz: Vector3


async def carry(world: SimWorld) -> Carried:
    """Pick the part and leave with it; return what there was half-way."""
    arm = world.arm("left")
    await grasp(world)
    await move(arm, LIFTED)
    motion = arm.follow(smooth(LIFTED, ACROSS, 1.2), tolerance=Tolerance())
    await until(lambda: motion.progress > 0.5)
    return snapshot_of(world)


def snapshot_of(world: SimWorld) -> Carried:
    """Return what there is now, all of one instant, though a world in real time goes on meanwhile."""
    while True:
        sample = world.arm("left").sample()
        seen = Carried(
            snapshot=world.snapshot(),
            time_s=sample.time_s,
            joints_rad=sample.position_rad.copy(),
            speed_rad_s=float(np.abs(sample.velocity_rad_s).max()),
            part_xyz=part_xyz(world, "part"),
        )
        if world.measured().time_s == seen.time_s:
            return seen


async def _carry_in_lockstep() -> Carried:
    async with opened(SCENE) as world:
        return await carry(world)


@pytest.fixture(scope="module")
def carried() -> Carried:
    """A world lost in mid-motion, in virtual time."""
    return run_virtual(_carry_in_lockstep())


def behind_rad(sample: ArmSample) -> float:
    """Return how far the arm is from its set point."""
    return float(np.abs(sample.desired_rad - sample.position_rad).max())


def check_rest(world: SimWorld, lost: Carried, *, within_rad: float = 0.005, within_m: float = 0.002) -> None:
    """Everything is where it was, the arm stands still, the part is between the pads."""
    sample = world.arm("left").sample()
    assert np.abs(sample.velocity_rad_s).max() < REST_RAD_S
    assert np.abs(sample.position_rad - lost.joints_rad).max() < within_rad
    assert world.gripper("left").sample().contacts == ("part", "part")
    assert part_xyz(world, "part") == pytest.approx(lost.part_xyz, abs=within_m)


async def check_it_goes_on(world: SimWorld) -> None:
    """The arm carries the part on to where it was going, and lets it go there."""
    assert (await move(world.arm("left"), ACROSS)).end is MotionEnd.REACHED
    assert world.gripper("left").sample().contacts == ("part", "part")
    assert part_xyz(world, "part")[2] > 0.19
    report = await world.gripper("left").close_to(width_m=0.08, speed_m_s=0.2, force_n=20.0).report()
    assert report.end is MotionEnd.REACHED
    assert world.gripper("left").sample().contacts == ("", "")


@pytest.mark.virtual
async def test_an_arm_lost_in_mid_motion_rests_there_with_its_part_and_goes_on(carried: Carried) -> None:
    assert carried.speed_rad_s > 0.5
    async with opened(SCENE) as world:
        await world.restore(carried.snapshot)
        assert (world.arm("left").sample().position_rad == carried.joints_rad).all()
        # At rest, up to the noise of the measurement.
        assert np.abs(world.arm("left").sample().velocity_rad_s).max() < 0.005
        check_rest(world, carried)
        await asyncio.sleep(2.0)
        check_rest(world, carried)
        assert world.gripper("left").sample().force_n == pytest.approx(20.0, abs=1.0)
        await check_it_goes_on(world)


async def test_a_world_in_its_own_process_is_snapped_and_restored_in_another_one() -> None:
    """The snapshot is a few steps old, so the arm is a few steps off."""
    async with opened(SCENE) as world:
        lost = await carry(world)
    async with opened(SCENE) as world:
        assert lost.time_s > 3.0
        await world.restore(lost.snapshot)
        assert world.measured().time_s >= lost.time_s
        check_rest(world, lost, within_rad=0.02, within_m=0.02)
        await check_it_goes_on(world)


async def test_a_snapshot_of_virtual_time_is_restored_in_real_time(carried: Carried) -> None:
    async with opened(SCENE) as world:
        await world.restore(carried.snapshot)
        check_rest(world, carried)
        await check_it_goes_on(world)


async def continued(snapshot: bytes, *, moved_before: bool = False) -> str:
    """Return the hash of the physics after a restore, a motion and a grip."""
    async with opened(SCENE) as world:
        if moved_before:
            await move(world.arm("left"), ABOVE_PART, 0.777)
            await asyncio.sleep(0.0305)
        await world.restore(snapshot)
        await move(world.arm("left"), LIFTED, 0.8)
        await world.gripper("left").close_to(width_m=0.0, speed_m_s=0.05, force_n=35.0).report()
        assert isinstance(world.host, LockstepHost)
        return f"{world.host.simulation.state_hash()} {world.measured().time_s}"


def test_two_restores_and_the_same_motions_agree_in_every_bit(carried: Carried) -> None:
    """Also when the world has lived before, and in another process."""
    here = run_virtual(continued(carried.snapshot))
    assert run_virtual(continued(carried.snapshot)) == here
    assert run_virtual(continued(carried.snapshot, moved_before=True)) == here


def test_another_process_goes_on_with_the_same_bits(carried: Carried, tmp_path: Path) -> None:
    file = tmp_path / "snapshot"
    file.write_bytes(carried.snapshot)
    script = (
        "import sys\n"
        "from pathlib import Path\n"
        "from engine.clock import run_virtual\n"
        "from tests.robots.sim.world.test_sim_world_restore import continued\n"
        "print(run_virtual(continued(Path(sys.argv[1]).read_bytes())))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", script, str(file)], cwd=ROOT, capture_output=True, text=True, check=True, timeout=60
    )
    assert done.stdout.strip() == run_virtual(continued(carried.snapshot))


def test_equal_histories_have_equal_snapshots(carried: Carried) -> None:
    assert run_virtual(_carry_in_lockstep()).snapshot == carried.snapshot


@pytest.mark.virtual
async def test_a_snapshot_of_what_was_just_restored_is_the_same_world_at_rest(carried: Carried) -> None:
    """So a run that is killed twice in a row loses nothing."""
    async with opened(SCENE) as world:
        await world.restore(carried.snapshot)
        again = snapshot_of(world)
    async with opened(SCENE) as world:
        await world.restore(again.snapshot)
        assert snapshot_of(world).snapshot == again.snapshot


@pytest.mark.virtual
async def test_a_snapshot_takes_less_than_a_millisecond() -> None:
    """Of the demo's size; the best of many, as the machine may be busy."""
    async with opened(two_arms(box("a"), box("b", (0.09, -0.28, 0.02)))) as world:
        assert min(timeit.repeat(world.snapshot, timer=time.process_time, number=1, repeat=50)) < 0.001


@pytest.mark.virtual
async def test_fingers_lost_on_their_way_stop_there() -> None:
    async with opened(one_arm()) as world:
        gripper = world.gripper("left")
        gripper.close_to(width_m=0.0, speed_m_s=0.05, force_n=30.0)
        await asyncio.sleep(0.6)
        width_m, snapshot = gripper.sample().width_m, world.snapshot()
    async with opened(one_arm()) as world:
        await world.restore(snapshot)
        await asyncio.sleep(1.0)
        assert world.gripper("left").sample().width_m == pytest.approx(width_m, abs=0.001)
        report = await world.gripper("left").close_to(width_m=0.0, speed_m_s=0.05, force_n=30.0).report()
        assert report.end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_an_arm_lost_while_it_pressed_on_the_table_lets_go() -> None:
    """Its set point was far below the table; the spring behind it must not be wound up again."""
    into_the_table = ABOVE_PART + np.array([0.0, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0])
    async with opened(one_arm()) as world:
        arm = world.arm("left")
        await move(arm, ABOVE_PART, 1.2)
        arm.follow(smooth(ABOVE_PART, into_the_table, 2.0), tolerance=Tolerance(path_rad=0.5))
        await until(lambda: behind_rad(arm.sample()) > 0.1)
        pressing, snapshot = arm.sample(), world.snapshot()
    async with opened(one_arm()) as world:
        await world.restore(snapshot)
        arm = world.arm("left")
        assert behind_rad(arm.sample()) < 0.011
        assert np.abs(arm.sample().position_rad - pressing.position_rad).max() < 1e-9
        await asyncio.sleep(1.0)
        assert np.abs(arm.sample().velocity_rad_s).max() < REST_RAD_S
        assert (await move(arm, HOME, 1.5)).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_a_restore_is_refused_while_something_moves(carried: Carried) -> None:
    async with opened(SCENE) as world:
        motion = world.arm("left").follow(smooth(HOME, HOME + 0.2, 0.5), tolerance=Tolerance())
        with pytest.raises(RobotError, match="something moves"):
            await world.restore(carried.snapshot)
        assert (await motion.report()).end is MotionEnd.REACHED


async def test_no_motion_starts_while_a_world_is_being_restored(carried: Carried) -> None:
    """It would start from where the arm was before."""
    async with opened(SCENE) as world:
        restoring = asyncio.create_task(world.restore(carried.snapshot))
        await asyncio.sleep(0)
        with pytest.raises(RobotError, match="being restored"):
            await move(world.arm("left"), HOME)
        await restoring
        check_rest(world, carried)


@pytest.mark.virtual
@pytest.mark.parametrize(
    "scene", [one_arm(), one_arm(box("part", mass_kg=0.13)), one_arm(box("part", (-0.09, 0.281, 0.02)))]
)
async def test_another_world_refuses_the_snapshot_and_stays_as_it_is(scene: SimScene, carried: Carried) -> None:
    """Another part, another mass, another place."""
    async with opened(scene) as world:
        before = world.snapshot()
        with pytest.raises(RobotError, match="the snapshot is of another world"):
            await world.restore(carried.snapshot)
        assert world.snapshot() == before
