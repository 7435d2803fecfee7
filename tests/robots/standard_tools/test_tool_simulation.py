"""A cell document with an arm for each tool: every tool answers its skills and tells its state on the bus."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import cast

import pytest

from engine.bus import GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.errors import CellError, NoSuchSkill
from engine.messages import GripperState, HandState, Pose, SceneDescription
from engine.skills.gripper import GripperGrasp, GripperMove, GripperOpen, ReadGripper
from engine.skills.hand import HandClose, HandOpen, ReadHand
from engine.skills.motion import CartTrapVel
from robots.magnet.magnet_skills import MagnetState, MagnetSwitch, ReadMagnet
from robots.magnet.simulated_magnet_port import SimMagnetPort
from robots.port import MotionEnd
from robots.scene.sim_scene import ArmPlacement, SimScene
from robots.sim.world.sim_world import new_world

CELL = """
flexcell: 1
cell: tools
world: {kind: mujoco, step_s: 0.001}
robots:
  abb: {model: irb4600, base: {xyz: [0, 0, 0]}, gripper: {model: magnet}}
  ur: {model: ur10, base: {xyz: [0, 3, 0]}, gripper: {model: robotiq_2f85}}
  panda: {model: panda, base: {xyz: [0, -3, 0]}, gripper: {model: softhand}}
  servo: {model: servo_arm, base: {xyz: [0, -5, 0]}, gripper: {model: servo_claw}}
  bare: {model: ur10, base: {xyz: [0, 6, 0]}}
fixtures:
  pedestal: {shape: box, size_m: [0.4, 0.4, 0.5], at: {xyz: [1.4, 0.2, 0.25]}}
parts:
  plate: {shape: box, size_m: [0.3, 0.2, 0.01], mass_kg: 3, magnetic: true, at: {xyz: [1.4, 0.2, 0.505]}}
  ball: {shape: sphere, size_m: [0.07], mass_kg: 0.1, at: {xyz: [1.4, 0.9, 0.035]}}
"""


@asynccontextmanager
async def opened(folder: Path) -> AsyncGenerator[SkillBus]:
    """The bus of the open cell."""
    file = folder / "tools.yaml"
    file.write_text(CELL, encoding="utf-8")
    async with OpenCell(load_cell(file)) as cell:
        yield cell.bus


@pytest.mark.virtual
async def test_every_tool_answers_under_its_own_name(tmp_path: Path) -> None:
    async with opened(tmp_path) as bus:
        widths = [(await bus.call(ReadGripper(), to=f"{arm}/gripper")).width_m for arm in ("ur", "servo")]
        assert widths == pytest.approx([0.085, 0.084], abs=0.002)
        hand = await bus.call(ReadHand(), to="panda/hand")
        magnet = await bus.call(ReadMagnet(), to="abb/magnet")
        assert (hand.closed_percent, hand.held, magnet.on, magnet.held) == (0.0, False, False, False)
        assert bus.topic("ur/gripper/state", GripperState).latest is not None
        assert bus.topic("panda/hand/state", HandState).latest is not None
        assert bus.topic("abb/magnet/state", MagnetState).latest is not None
        with pytest.raises(NoSuchSkill):
            await bus.call(ReadGripper(), to="bare/gripper")


@pytest.mark.virtual
async def test_a_magnet_confirms_the_plate_it_picks(tmp_path: Path) -> None:
    async with opened(tmp_path) as bus:
        down = (1.0, 0.0, 0.0, 0.0)
        goal = CartTrapVel(pose=Pose(xyz=(1.4, 0.2, 0.511), xyzw=down), speed=0.3)
        assert (await bus.send_goal(goal, to="abb").result()).status is GoalStatus.SUCCEEDED
        end = await bus.send_goal(MagnetSwitch(on=True), to="abb/magnet").result()
        assert end.result is not None
        assert (end.result.held, end.result.part, end.result.reason) == (True, "plate", "")
        state = bus.topic("abb/magnet/state", MagnetState).latest
        assert state is not None
        assert (state.on, state.held, state.part) == (True, True, "plate")
        off = await bus.send_goal(MagnetSwitch(on=False), to="abb/magnet").result()
        assert off.result is not None
        assert (off.result.on, off.result.held) == (False, False)


@pytest.mark.virtual
async def test_tools_of_different_arms_move_at_the_same_time_and_say_what_they_miss(tmp_path: Path) -> None:
    async with opened(tmp_path) as bus:
        ends = await asyncio.gather(
            bus.send_goal(GripperGrasp(width_m=0.05, force_n=60.0), to="ur/gripper").result(),
            bus.send_goal(GripperGrasp(width_m=0.01, force_n=3.0), to="servo/gripper").result(),
            bus.send_goal(HandClose(percent=70.0, time_s=1.0), to="panda/hand").result(),
            bus.send_goal(MagnetSwitch(on=True), to="abb/magnet").result(),
        )
        reasons = [end.result.reason for end in ends if end.result is not None]
        assert len(reasons) == 4
        assert reasons[0] == "fingers closed to 0.0 mm and touch nothing"
        assert "touch nothing" in reasons[1]
        assert reasons[2] == "the hand closed to 70 % and touches nothing"
        assert reasons[3] == "the magnet is on and touches nothing"


@pytest.mark.virtual
async def test_a_force_that_the_gripper_does_not_have_is_rejected(tmp_path: Path) -> None:
    async with opened(tmp_path) as bus:
        end = await bus.send_goal(GripperGrasp(width_m=0.05, force_n=300.0), to="ur/gripper").result()
        assert end.cause is not None
        assert (end.status, "up to 235 N" in end.cause.message) == (GoalStatus.REJECTED, True)


@pytest.mark.virtual
async def test_a_hand_and_a_gripper_are_held_on_their_way_and_go_on(tmp_path: Path) -> None:
    async with opened(tmp_path) as bus:
        hand = bus.send_goal(HandClose(percent=80.0, time_s=1.0), to="panda/hand")
        fingers = bus.send_goal(GripperMove(width_m=0.02, speed_m_s=0.05), to="ur/gripper")
        await bus.clock.sleep(0.5)
        await asyncio.gather(hand.hold(), fingers.hold())
        closed = (await bus.call(ReadHand(), to="panda/hand")).closed_percent
        width = (await bus.call(ReadGripper(), to="ur/gripper")).width_m
        await bus.clock.sleep(1.0)
        assert (await bus.call(ReadHand(), to="panda/hand")).closed_percent == closed < 60.0
        assert (await bus.call(ReadGripper(), to="ur/gripper")).width_m == pytest.approx(width, abs=0.0005)
        assert 0.03 < width < 0.08
        await asyncio.gather(hand.resume(), fingers.resume())
        assert [(await each.result()).status for each in (hand, fingers)] == [GoalStatus.SUCCEEDED] * 2
        assert (await bus.call(ReadHand(), to="panda/hand")).closed_percent == pytest.approx(80.0)
        opened_again = await bus.send_goal(HandOpen(time_s=0.5), to="panda/hand").result()
        assert (await bus.send_goal(GripperOpen(), to="ur/gripper").result()).status is opened_again.status


@pytest.mark.virtual
async def test_a_ball_is_drawn_with_its_radius(tmp_path: Path) -> None:
    async with opened(tmp_path) as bus:
        scene = bus.topic("cell/scene", SceneDescription).latest
        assert scene is not None
        (ball,) = (geometry for geometry in scene.geometries if geometry.name == "ball")
        assert (ball.kind, ball.size_m) == ("sphere", (0.035,))


async def test_tools_take_their_commands_in_a_process_of_their_own_too() -> None:
    both = SimScene(
        arms=(
            ArmPlacement(name="abb", model="irb4600", gripper="magnet", base=Pose(xyz=(0.0, 0.0, 0.0))),
            ArmPlacement(name="panda", model="panda", gripper="softhand", base=Pose(xyz=(0.0, 3.0, 0.0))),
        )
    )
    async with new_world(both, virtual=False) as world:
        hand = world.hand("panda").close_to(share=0.3, time_s=0.3)
        port = cast("SimMagnetPort", world.tool("abb", "magnet"))
        magnet = port.switch(on=True)
        assert [(await motion.report()).end for motion in (hand, magnet)] == [MotionEnd.REACHED] * 2
        assert world.hand("panda").sample().closed_share == pytest.approx(0.3)
        assert port.sample().on
        with pytest.raises(CellError, match="carries no gripper"):
            world.gripper("abb")
