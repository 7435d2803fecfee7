"""Streams and steps stop before a contact: with both names, and a guided arm can be led away."""

from __future__ import annotations

import asyncio
from pathlib import Path

import numpy as np
import pytest

from engine.bus import GoalStatus, Holder
from engine.cause_chain import describe_cause
from engine.messages import FramePoses, Vector3
from engine.skills.arm_control import ArmStatus
from engine.skills.collision_options import CollisionOptions
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.guiding import FinishGuiding, GuideArm, GuideFeedback
from engine.skills.jogging import StepJoints
from engine.skills.simulated_world import PushBody
from tests.robots.workspace.free_cell import REST_RAD_S, THERE, FreeCell, Witness, box, free_cell

CELL = Path(__file__).parents[1] / "one_panda.yaml"
WALL = box("wall", (0.3, 0.02, 1.0), (-0.05, 0.0, 0.5))
BLIND = CollisionOptions(avoid=False)


def frame_xyz(opened: FreeCell, name: str) -> Vector3:
    """Return where a frame is, in the world."""
    frames = opened.bus.topic("cell/frames", FramePoses).latest
    assert frames is not None
    return frames.xyz[frames.names.index(name)]


def error(opened: FreeCell) -> str:
    """Return the error in the state of the arm."""
    state = opened.bus.topic("left/status", ArmStatus).latest
    assert state is not None
    return state.error


async def swing(opened: FreeCell, *, rate_rad_s: float, duration_s: float) -> None:
    """Stream set points that turn the first joint."""
    commands, clock = opened.bus.topic("left/direct_joints", JointCommand), opened.bus.clock
    joints = opened.joints()
    start_s, first = clock.now_s(), float(joints[0])
    while clock.now_s() < start_s + duration_s:
        joints[0] = first + rate_rad_s * (clock.now_s() - start_s)
        commands.publish(JointCommand(position_rad=tuple(joints.tolist())))
        await clock.sleep(0.01)


@pytest.mark.virtual
async def test_direct_control_ends_before_a_contact_with_both_names_and_may_lead_away(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await opened.go(THERE)
        await opened.put(WALL)
        witness = Witness(opened, WALL)
        assert (await opened.bus.call(SwitchDirectControl(on=True), to="left")).success
        await swing(opened, rate_rad_s=-0.6, duration_s=2.0)
        stopped_at = opened.joints()[0]
        assert "would touch wall" in error(opened)
        assert "left/panda_" in error(opened)
        assert (opened.speed_rad_s() < REST_RAD_S, witness.touched) == (True, set())
        assert (await opened.bus.call(SwitchDirectControl(on=True), to="left")).success
        await swing(opened, rate_rad_s=0.6, duration_s=0.5)
        await witness.end()
        assert opened.joints()[0] > stopped_at + 0.1
        answer = await opened.bus.call(SwitchDirectControl(on=False), to="left")
        assert answer.message == "direct joint control is off"
        blind = SwitchDirectControl(on=True, collisions=BLIND)
        assert (await opened.bus.call(blind, to="left")).success
        await swing(opened, rate_rad_s=-0.6, duration_s=1.0)
        assert opened.joints()[0] < stopped_at - 0.05


@pytest.mark.virtual
async def test_a_lease_that_ends_while_the_path_is_checked_turns_nothing_on(tmp_path: Path) -> None:
    """The planners take seconds to get ready; a run that has ended meanwhile leads no arm."""
    run = Holder("run-1", "root/a")
    async with free_cell(tmp_path, cell=CELL) as opened:
        opened.bus.leases.acquire(("left",), run)
        switching = asyncio.create_task(opened.bus.call(SwitchDirectControl(on=True), to="left", holder=run))
        await asyncio.sleep(0)
        assert not switching.done()
        opened.bus.leases.release_run("run-1")
        answer = await switching
        assert (answer.success, "lease" in answer.message) == (False, True)
        state = opened.bus.topic("left/status", ArmStatus).latest
        assert state is not None
        assert state.mode == "idle"


@pytest.mark.virtual
async def test_a_jump_of_the_set_points_behind_a_wall_ends_before_it(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await opened.go(THERE)
        await opened.put(WALL)
        witness = Witness(opened, WALL)
        assert (await opened.bus.call(SwitchDirectControl(on=True, watchdog_s=2.0), to="left")).success
        far = (-0.8, *THERE[1:])
        opened.bus.topic("left/direct_joints", JointCommand).publish(JointCommand(position_rad=far))
        await opened.until(lambda: "would touch wall" in error(opened))
        await witness.end()
        assert (opened.speed_rad_s() < REST_RAD_S, witness.touched) == (True, set())
        assert opened.joints()[0] < THERE[0] - 0.1


@pytest.mark.virtual
async def test_a_guided_arm_stands_before_what_a_link_above_the_tool_would_touch_and_can_be_led_away(
    tmp_path: Path,
) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await opened.go(THERE)
        x, y, z = frame_xyz(opened, "left/panda_link6")
        shelf = box("shelf", (0.3, 0.3, 0.04), (x - 0.2, y + 0.3, z))
        await opened.put(shelf)
        witness = Witness(opened, shelf)
        heard: list[GuideFeedback] = []
        handle = opened.bus.send_goal(GuideArm(damping=0.3), to="left")
        handle.on_feedback(heard.append)
        await handle.accepted()
        push = PushBody(body="left/panda_hand", force_n=(0.0, 20.0, 0.0), duration_s=1.5)
        await opened.bus.call(push, to="cell")
        await opened.until(lambda: any("would touch shelf" in message.held_by for message in heard))
        await opened.bus.clock.sleep(1.5)
        pushed_to = opened.joints()
        assert witness.touched == set()
        await opened.bus.call(PushBody(body="left/panda_hand", force_n=(0.0, -20.0, 0.0), duration_s=0.8), to="cell")
        await opened.bus.clock.sleep(1.5)
        await witness.end()
        assert np.abs(opened.joints() - pushed_to).max() > 0.1
        assert heard[-1].held_by == ""
        await opened.bus.call(FinishGuiding(), to="left")
        assert ((await handle.result()).status, witness.touched) == (GoalStatus.SUCCEEDED, set())


@pytest.mark.virtual
async def test_a_step_stops_before_what_gets_into_its_path(tmp_path: Path) -> None:
    async with free_cell(tmp_path, cell=CELL) as opened:
        await opened.go(THERE)
        witness = Witness(opened, WALL)
        handle = opened.bus.send_goal(StepJoints(step_rad=(-1.6, *(0.0,) * 6), speed=0.3), to="left")
        await opened.until(lambda: opened.speed_rad_s() > 0.2)
        await opened.put(WALL)
        end = await handle.result()
        await witness.end()
        why = describe_cause(end.cause) if end.cause else ""
        assert (end.status, witness.touched, "would touch wall" in why) == (GoalStatus.ABORTED, set(), True), why
        assert opened.joints()[0] > 0.1
