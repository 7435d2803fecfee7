"""A module that is plugged into the path of a moving arm: the arm stops before it, or goes around it."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

from engine.bus import GoalStatus, Holder
from engine.cell.open_cell import OpenCell
from engine.document import parse_behavior
from engine.document.cell import Cell, load_cell
from engine.errors import LeaseRefused
from engine.messages import JointState
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.skills.collision_options import CollisionOptions
from engine.skills.modules import MODULES_TOPIC, CellModules, PlugModule, UnplugModule
from engine.skills.motion import JointTrapVel
from engine.skills.planning import MotionTarget, MoveFree

POST = """\
flexcell: 1
module: post
fixtures:
  body: {shape: box, size_m: [0.1, 0.1, 0.7], at: {xyz: [0, 0, 0.35]}}
"""
CELL = """\
flexcell: 1
cell: posts
world: {kind: mujoco}
robots: {arm: {model: panda, gripper: {model: panda_hand}}}
fixtures:
  floor: {shape: box, size_m: [2, 2, 0.04], at: {xyz: [0, 0, -0.02]}}
connectors:
  ahead: {at: {xyz: [0.55, 0.05, 0]}}
modules:
  post: {module: post, connector: ahead, plugged: false}
"""
TURNING = """\
flexcell: 1
name: turning
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: plug
    states:
      plug:
        state: cell.PlugModule
        with: {module: post}
        transitions: {plugged: turn, failed: failed}
      turn:
        state: motion.MoveJoints
        with: {robot: arm, target: [-1.5, 0.4, 0, -1.8, 0, 2.2, 0.8], speed: 0.1}
        transitions: {reached: finished, failed: failed}
"""
RIGHT = (-0.8, 0.4, 0.0, -1.8, 0.0, 2.2, 0.8)
LEFT = (0.9, 0.4, 0.0, -1.8, 0.0, 2.2, 0.8)


def post_cell(folder: Path) -> Cell:
    """Return the cell whose post is not plugged."""
    (folder / "post").mkdir()
    (folder / "post" / "module.yaml").write_text(POST, encoding="utf-8")
    (folder / "cell.yaml").write_text(CELL, encoding="utf-8")
    return load_cell(folder / "cell.yaml")


async def turned_to(cell: OpenCell, angle_rad: float) -> None:
    """Wait until the first joint has passed an angle."""
    topic = cell.bus.topic("arm/joint_state", JointState)
    while topic.latest is None or topic.latest.position_rad[0] < angle_rad:
        await cell.bus.clock.sleep(0.01)


@pytest.mark.virtual
@pytest.mark.parametrize("plugged", [False, True], ids=["nothing is plugged", "the post is plugged"])
async def test_an_arm_goes_around_a_post_that_is_plugged_into_its_path(tmp_path: Path, *, plugged: bool) -> None:
    async with OpenCell(post_cell(tmp_path)) as cell:
        bus = cell.bus
        assert (await bus.send_goal(JointTrapVel(joints=RIGHT, speed=0.5), to="arm").result()).status is (
            GoalStatus.SUCCEEDED
        )
        going = bus.send_goal(MoveFree(target=MotionTarget(joints=LEFT)), to="arm")
        await turned_to(cell, -0.6)
        if plugged:
            await bus.call(PlugModule(), to="post")
        end = await going.result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        assert end.result is not None
        assert (end.result.replans > 0) == plugged
        assert cell.measures()["cell.contacts"] == 0.0


@pytest.mark.virtual
async def test_a_motion_on_a_given_path_stops_before_the_post_and_goes_on_when_it_is_unplugged(tmp_path: Path) -> None:
    async with OpenCell(post_cell(tmp_path)) as cell:
        bus = cell.bus
        await bus.send_goal(JointTrapVel(joints=RIGHT, speed=0.5), to="arm").result()
        waiting = CollisionOptions(patience_s=60.0)
        going = bus.send_goal(JointTrapVel(joints=LEFT, speed=0.2, collisions=waiting), to="arm")
        await turned_to(cell, -0.6)
        await bus.call(PlugModule(), to="post")
        await bus.clock.sleep(3.0)
        stopped = bus.topic("arm/joint_state", JointState).latest
        assert stopped is not None
        assert stopped.position_rad[0] < 0.0
        assert max(map(abs, stopped.velocity_rad_s)) < 0.01
        await bus.call(UnplugModule(), to="post")
        assert (await going.result()).status is GoalStatus.SUCCEEDED
        assert cell.measures()["cell.contacts"] == 0.0


@pytest.mark.virtual
async def test_an_unplug_is_refused_while_a_run_has_the_module_or_ends_that_run_by_choice(tmp_path: Path) -> None:
    """The run stops its arm, and its cause tells who ended it; only then the module leaves."""
    plan = new_plan(parse_behavior(TURNING, file="turning.yaml"), load_states())
    person = Holder("person")
    async with OpenCell(post_cell(tmp_path)) as cell:
        bus = cell.bus
        running = asyncio.create_task(Run(plan, run="run-1", bus=bus).execute())
        joints = bus.topic("arm/joint_state", JointState)
        while joints.latest is None or joints.latest.position_rad[0] > -0.1:
            assert not running.done(), running.result()
            await bus.clock.sleep(0.01)
        with pytest.raises(LeaseRefused, match="post is commanded by run run-1"):
            await bus.call(UnplugModule(), to="post", holder=person)
        assert not running.done()
        state = await bus.call(UnplugModule(end_run=True), to="post", holder=person)
        assert state.connector == ""
        assert max(abs(each) for each in joints.latest.velocity_rad_s) < 0.01
        result = await running
        assert result.cause is not None
        assert (result.status, result.cause.message) == (
            "stopped",
            "stopped: person called post/unplug_module, which ends the run that has post",
        )
        assert bus.topic(MODULES_TOPIC, CellModules).latest == CellModules(modules=(state,), free=("ahead",))
        assert bus.leases.listing() == ()
