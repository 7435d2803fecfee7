"""Named frames of a cell: arms take goals in them, and behaviors find them among all frames."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document.cell import load_cell
from engine.messages import FramePoses, Pose
from engine.skills.motion import CartTrapVel, ForwardKinematics
from robots.simulated_cell import new_world

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco, realism: ideal}
robots:
  left: {model: panda, gripper: {model: panda_hand}}
fixtures:
  table: {shape: box, size_m: [0.4, 0.4, 0.1], at: {xyz: [0.5, 0.1, 0.05], rpy: [0, 0, 1.5707963267948966]}}
frames:
  slot: {parent: table, at: {xyz: [0.05, 0.02, 0.05]}}
"""
DOWN = (1.0, 0.0, 0.0, 0.0)


async def moved(file: Path) -> tuple[Pose, FramePoses]:
    """Move the tool to 0.2 m above the slot; return where it is in the world, and the frames of the cell."""
    async with SkillBus(new_clock()) as bus, new_world(load_cell(file), bus=bus, virtual=True, seed=0) as world:
        world.register(bus)
        for robot in world.robots():
            robot.register(bus)
            await robot.__aenter__()
        above = Pose(xyz=(0.0, 0.03, 0.2), xyzw=DOWN, frame="slot")
        end = await bus.send_goal(CartTrapVel(pose=above, speed=0.5), to="left").result()
        assert end.cause is None
        frames = bus.topic("cell/frames", FramePoses).latest
        assert frames is not None
        return await bus.call(ForwardKinematics(), to="left"), frames


def test_an_arm_moves_to_a_pose_in_a_named_frame_which_is_among_the_frames_of_the_cell(tmp_path: Path) -> None:
    """The frame stands on a fixture that is turned by 90°."""
    (tmp_path / "cell.yaml").write_text(CELL, encoding="utf-8")
    tool, frames = run_virtual(moved(tmp_path / "cell.yaml"))
    row = frames.names.index("slot")
    assert frames.xyz[row] == pytest.approx((0.48, 0.15, 0.1))
    assert tool.xyz == pytest.approx((0.45, 0.15, 0.3), abs=1e-3)
