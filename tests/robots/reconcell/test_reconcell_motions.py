"""Motions through the interface, in physics and virtual time: what starts, ends and is refused."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest

from engine.bus import Holder
from engine.messages import Pose, RobotDescription, Wrench
from engine.messages.pose_algebra import angle_between_rad, compose_poses, invert_pose
from engine.messages.primitives import ForceReference
from engine.skills.dmp import JointDMP
from engine.skills.motion import ForwardKinematics, JointTrapVel
from robots.model.transform import RigidTransform
from robots.reconcell import ControlMode
from robots.reconcell.packets import TrajectoryFlags
from robots.reconcell.state_broadcast import StateBroadcast
from tests.robots.reconcell.primitives_184 import HOME, THERE, cart_dmp, joint_dmp
from tests.robots.reconcell.reconcell_cell import HandMade, ReconcellCell, reconcell_cell


async def base_pose(cell: ReconcellCell) -> Pose:
    """Return the pose of the tool in the base of the arm."""
    return compose_poses(invert_pose(BASE), await cell.bus.call(ForwardKinematics(), to="ur10"))


BASE = Pose(xyz=(0.1, -0.2, 0.3), xyzw=(0.0, 0.0, float(np.sin(0.6)), float(np.cos(0.6))))


async def path_of(cell: ReconcellCell, seconds: float) -> list[list[float]]:
    """Return the set points of the next seconds."""
    rows: list[list[float]] = []
    for _ in range(round(seconds / 0.05)):
        rows.append(cell.port.sample().desired_rad.tolist())
        await cell.bus.clock.sleep(0.05)
    return rows


@pytest.mark.virtual
async def test_bytes_made_by_hand_move_the_joints(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        with HandMade(cell.address) as sender:
            sender.doubles(26000, *THERE, 0.5)
            sender.raw(10000, bytes([5]))
            await cell.at_rest()
            assert cell.refused == {}
            # Data serve once.
            sender.raw(10000, bytes([5]))
            await cell.until(lambda: cell.refused == {"no data": 1})
        await cell.receive()
        flags = cell.client.flags
        assert flags is not None
        assert (flags.received_mode, flags.idle, flags.error, flags.running, flags.finished) == (5, 1, 0, 0, 1)
        received = cell.client.receive()
        assert received[15003] == TrajectoryFlags(received=0, finished=1)
        assert received[15004] == TrajectoryFlags(received=0, finished=0)
        assert np.abs(cell.joints() - THERE).max() < 0.01


@pytest.mark.virtual
async def test_bytes_made_by_hand_move_the_tool_along_a_line_in_the_base_of_the_arm(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        start = await base_pose(cell)
        x, y, z = start.xyz
        await cell.bus.clock.sleep(1.5)
        with HandMade(cell.address) as sender:
            sender.doubles(27000, x + 0.05, y, z + 0.1, *start.xyzw, 2.0)
            sender.raw(10000, bytes([13]))
            await cell.until(lambda: cell.server.interface.commands.moving)
            await cell.bus.clock.sleep(1.0)
            middle = await base_pose(cell)
            await cell.at_rest()
            assert cell.refused == {}
            sender.raw(10000, bytes([13]))
            await cell.until(lambda: cell.refused == {"no data": 1})
        end = await base_pose(cell)
        assert np.abs(np.array(middle.xyz) - (x + 0.025, y, z + 0.05)).max() < 0.005
        assert np.abs(np.array(end.xyz) - (x + 0.05, y, z + 0.1)).max() < 0.003
        assert angle_between_rad(end.xyzw, start.xyzw) < 0.01


@pytest.mark.virtual
async def test_a_joint_primitive_of_184_kernels_takes_the_path_that_the_skill_takes(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        client = cell.client
        await cell.go_home()
        client.load_joint_dmp(joint_dmp())
        client.select(ControlMode.JOINT_DMP)
        await cell.arrived()
        assert not cell.server.interface.commands.moving
        client.execute("joint_dmp")
        await cell.until(lambda: cell.server.interface.commands.mode is ControlMode.JOINT_DMP)
        await cell.until(lambda: bool(np.abs(cell.port.sample().desired_rad - HOME).max() > 1e-3))
        given = await path_of(cell, 2.0)
        await cell.receive()
        flags = client.primitive_flags("joint_dmp")
        assert flags is not None
        assert (flags.loaded_id, flags.execute, flags.finished) == (1.0, 1.0, 0.0)
        assert 0.05 < flags.phase < 0.9
        await cell.until(lambda: not cell.server.interface.commands.moving)
        assert np.abs(cell.joints() - THERE).max() < 0.01
        await cell.go_home()
        goal = cell.bus.send_goal(JointDMP(dmp=joint_dmp()), to="ur10")
        await cell.until(lambda: bool(np.abs(cell.port.sample().desired_rad - HOME).max() > 1e-3))
        expected = await path_of(cell, 2.0)
        await goal.result()
        assert np.abs(np.array(given) - np.array(expected)).max() < 0.02
        assert np.abs(np.array(given) - HOME).max() > 0.1
        assert cell.refused == {}


@pytest.mark.virtual
async def test_a_cartesian_primitive_is_executed_in_the_base_of_the_arm_and_its_phase_stands_still(
    tmp_path: Path,
) -> None:
    """The flag of the phase holds it; the execution flag may come before the mode; a second pass needs a start."""
    async with reconcell_cell(tmp_path) as cell:
        client, moving = cell.client, cell.server.interface.commands
        await cell.go_home()
        start = await base_pose(cell)
        x, y, z = start.xyz
        client.load_cart_dmp(cart_dmp(start, (0.05, 0.05, 0.1)))
        client.execute("cart_dmp")
        await cell.arrived()
        assert not moving.moving
        client.select(ControlMode.CART_DMP)
        await cell.until(lambda: moving.progress > 0.2)
        client.stop_phase("cart_dmp", stopped=True)
        await cell.arrived()
        await cell.bus.clock.sleep(1.0)
        held = cell.joints()
        await cell.bus.clock.sleep(1.0)
        assert np.abs(cell.joints() - held).max() < 1e-3
        assert moving.moving
        client.stop_phase("cart_dmp", stopped=False)
        await cell.at_rest()
        end = await base_pose(cell)
        assert np.abs(np.array(end.xyz) - (x + 0.05, y + 0.05, z + 0.1)).max() < 0.005
        assert cell.refused == {}
        client.execute("cart_dmp")
        await cell.until(lambda: cell.refused == {"rejected by the arm": 1})
        assert "from the start" in cell.server.interface.status.last_refusal


@pytest.mark.virtual
async def test_a_reset_ends_the_primitive_and_it_can_be_executed_again_from_its_start(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        cell.client.load_joint_dmp(joint_dmp())
        cell.client.select(ControlMode.JOINT_DMP)
        cell.client.execute("joint_dmp")
        await cell.until(lambda: cell.speed_rad_s() > 0.05)
        cell.client.reset("joint_dmp")
        await cell.at_rest(within_s=1.0)
        await cell.go_home()
        cell.client.select(ControlMode.JOINT_DMP)
        cell.client.execute("joint_dmp")
        await cell.at_rest()
        assert np.abs(cell.joints() - THERE).max() < 0.01


@pytest.mark.virtual
async def test_a_primitive_that_stands_still_is_ended_by_the_stop(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        cell.client.load_joint_dmp(joint_dmp())
        cell.client.select(ControlMode.JOINT_DMP)
        cell.client.execute("joint_dmp")
        await cell.until(lambda: cell.speed_rad_s() > 0.05)
        cell.client.stop_phase("joint_dmp", stopped=True)
        cell.client.stop_phase("joint_dmp", stopped=False)
        cell.client.stop_phase("joint_dmp", stopped=True)
        await cell.until(lambda: cell.speed_rad_s() < 0.001)
        await cell.bus.clock.sleep(1.0)
        assert cell.server.interface.commands.mode is ControlMode.JOINT_DMP
        assert cell.speed_rad_s() < 0.001
        cell.client.stop()
        await cell.at_rest(within_s=1.0)
        assert cell.bus.leases.owner("ur10") is None
        assert cell.refused == {}


@pytest.mark.virtual
async def test_stop_in_motion_brings_the_arm_to_rest_and_the_next_motion_starts(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        cell.client.move_joints(THERE, speed=0.1)
        await cell.until(lambda: cell.speed_rad_s() > 0.05)
        cell.client.stop()
        assert await cell.until(lambda: cell.speed_rad_s() < 0.01) < 1.0
        assert np.abs(cell.joints() - THERE).max() > 0.05
        await cell.at_rest_now()
        await cell.receive()
        flags = cell.client.flags
        assert flags is not None
        assert (flags.error, flags.running, flags.finished) == (0, 0, 0)
        await cell.go_home()


@pytest.mark.virtual
async def test_a_motion_during_a_motion_is_refused_and_the_first_goes_on(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        cell.client.move_joints(THERE, speed=0.3)
        await cell.until(lambda: cell.speed_rad_s() > 0.05)
        cell.client.move_joints(HOME, speed=0.3)
        await cell.at_rest()
        # The data of a refused mode are not those of a later one, nor are data that have served.
        for _ in range(2):
            cell.client.select(ControlMode.JOINT_TRAPEZOID)
        await cell.at_rest()
        assert cell.refused == {"busy": 1, "no data": 2}
        assert np.abs(cell.joints() - THERE).max() < 0.01


@pytest.mark.virtual
async def test_the_state_is_that_of_the_sample_of_the_arm(tmp_path: Path) -> None:
    """45 doubles as the appendix lists them, made in motion; what the client reads is of the last period."""
    async with reconcell_cell(tmp_path, rate_hz=100.0) as cell:
        await cell.go_home()
        description = cell.bus.topic("ur10/description", RobotDescription).latest
        assert description is not None
        state = StateBroadcast(cell.bus, description, cell.server.interface, order="wxyz")
        cell.client.move_joints(THERE, speed=0.3)
        await cell.until(lambda: cell.speed_rad_s() > 0.1)
        before_s, before = cell.port.sample().time_s, cell.port.sample().desired_rad.copy()
        await state.datagrams()
        await cell.receive()
        numbers = struct.unpack("<45d", dict(await state.datagrams())[15000])
        sample, pose = cell.port.sample(), await base_pose(cell)
        x, y, z, w = pose.xyzw
        assert numbers[0:6] == tuple(sample.position_rad.tolist())
        assert numbers[6:12] == tuple(sample.desired_rad.tolist())
        assert numbers[12:18] == tuple(sample.velocity_rad_s.tolist())
        assert numbers[18:24] == pytest.approx((sample.desired_rad - before) / (sample.time_s - before_s))
        assert numbers[24:27] == pytest.approx(pose.xyz)
        assert numbers[27:31] == pytest.approx((w, x, y, z))
        assert np.abs(sample.velocity_rad_s).max() > 0.05
        read = cell.client.state
        assert read is not None
        assert np.abs(np.array(read.joints) - sample.position_rad).max() < 0.05
        await cell.at_rest()


@pytest.mark.virtual
async def test_forces_are_along_the_base_and_along_the_tool(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        description = cell.bus.topic("ur10/description", RobotDescription).latest
        assert description is not None
        felt = Wrench(force_n=(1.0, 2.0, 3.0), torque_nm=(0.1, 0.2, 0.3), frame="world")
        cell.bus.topic("ur10/wrench", Wrench).provide(lambda: felt)
        state = StateBroadcast(cell.bus, description, cell.server.interface, order="xyzw")
        numbers = struct.unpack("<45d", dict(await state.datagrams())[15000])
        tool = RigidTransform.from_pose(await cell.bus.call(ForwardKinematics(), to="ur10")).rotation
        base = RigidTransform.from_pose(BASE).rotation
        assert numbers[31:34] == pytest.approx(tool.T @ felt.force_n)
        assert numbers[34:37] == pytest.approx(tool.T @ felt.torque_nm)
        assert numbers[37:40] == pytest.approx(base.T @ felt.force_n)
        assert numbers[40:43] == pytest.approx(base.T @ felt.torque_nm)


@pytest.mark.virtual
async def test_a_run_that_leases_the_arm_is_not_disturbed(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        cell.bus.leases.acquire(("ur10",), Holder("night", "root"))
        start = cell.joints()
        cell.client.move_joints(THERE, speed=0.3)
        cell.client.send_set_point(HOME)
        cell.client.select(ControlMode.DIRECT)
        cell.client.select(ControlMode.GUIDING)
        cell.client.set_outputs(1)
        await cell.until(lambda: cell.refused == {"leased": 4})
        assert "night" in cell.server.interface.status.last_refusal
        assert np.abs(cell.joints() - start).max() < 1e-3
        cell.bus.leases.release_run("night")
        await cell.go_home()


@pytest.mark.virtual
async def test_a_run_cannot_lease_the_arm_during_a_motion_and_can_after_it(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        cell.client.move_joints(HOME, speed=0.3)
        await cell.until(lambda: cell.server.interface.commands.moving)
        assert cell.bus.leases.owner("ur10") == "reconcell of ur10"
        await cell.at_rest()
        assert cell.bus.leases.owner("ur10") is None
        end = await cell.bus.send_goal(JointTrapVel(joints=THERE, speed=0.5), to="ur10", holder=Holder("run")).result()
        assert end.cause is None


@pytest.mark.virtual
async def test_gravity_compensation_gives_the_arm_to_a_hand_until_the_stop(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        cell.client.select(ControlMode.GUIDING)
        await cell.until(lambda: cell.mode() == "guiding")
        cell.client.stop()
        await cell.at_rest_now()
        assert cell.mode() == "idle"
        await cell.go_home()


@pytest.mark.virtual
async def test_admittance_control_needs_force_profile_and_primitive_and_follows_the_path(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        client = cell.client
        await cell.go_home()
        start = await base_pose(cell)
        x, y, z = start.xyz
        client.load_cart_dmp(cart_dmp(start, (0.0, 0.0, 0.05), detour_m=0.0))
        client.select(ControlMode.ADMITTANCE)
        await cell.until(lambda: cell.refused == {"incomplete parameters": 1})
        client.load_force(ForceReference.constant(force_n=(0.0, 0.0, 0.0)))
        client.select(ControlMode.ADMITTANCE)
        client.execute("cart_dmp")
        await cell.at_rest()
        end = await base_pose(cell)
        assert np.abs(np.array(end.xyz) - (x, y, z + 0.05)).max() < 0.01
        assert cell.refused == {"incomplete parameters": 1}


@pytest.mark.virtual
async def test_outputs_and_tool_are_set_and_what_the_arm_has_not_is_refused_by_name(tmp_path: Path) -> None:
    async with reconcell_cell(tmp_path) as cell:
        await cell.go_home()
        with_tool = await base_pose(cell)
        with HandMade(cell.address) as sender:
            await cell.bus.clock.sleep(1.5)
            sender.doubles(11000, 0b1000000101)
            sender.doubles(12000, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.05, 0.5, *[0.0] * 6)
            await cell.receive()
            state = cell.client.state
            assert state is not None
            assert cell.refused == {}
            assert state.outputs == 0b1000000101
            assert np.linalg.norm(np.array(state.position_m) - with_tool.xyz) == pytest.approx(0.1, abs=0.01)
            assert cell.refused == {}
            sender.doubles(11000, 1024.0)
            sender.doubles(12000, 0.0, 0.0, 0.1, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.05, 0.5, 1.0, *[0.0] * 5)
            sender.raw(12000, bytes(8))
            await cell.arrived()
        assert cell.refused == {"out of range": 1, "not supported": 1, "wrong size": 1}
