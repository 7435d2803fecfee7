"""A goal is sent while a hand comes near at 1.6 m/s: whatever moves the arm, the hand meets it at rest."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import pytest

from engine.document.cell import Cell
from engine.messages import FramePoses, Vector3
from engine.skill import Action
from engine.skills.collision_options import CollisionOptions
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.guiding import GuideArm
from engine.skills.jogging import JogCollisionOptions, JogJoints, StepTool
from engine.skills.motion import JointTrapVel
from engine.skills.people import CountContacts, Reach
from engine.skills.planning import MotionTarget, MoveFree, PlanOptions
from tests.robots.workspace.test_separation_supervisor import CELL, SeparatedCell, opened_cell

START = (-0.5, 0.3, 0.0, -1.6, 0.0, 1.9, 0.8)
GOAL = (0.9, 0.3, 0.0, -1.6, 0.0, 1.9, 0.8)
CAMERAS = CELL.document.cameras
SLOW_SIDE = replace(
    CELL,
    document=msgspec.structs.replace(
        CELL.document,
        cameras={
            "front": msgspec.structs.replace(CAMERAS["front"], at=(-0.5, 0.0, 1.6), look_at=(-0.6, 0.0, 0.0)),
            "side": msgspec.structs.replace(CAMERAS["side"], rate_hz=5.0),
        },
    ),
)
"""Only the slow one of its cameras sees the person."""
_CLOSE_M = 0.05
_MOVES_RAD_S = 0.01

Begin = Callable[[SeparatedCell], Awaitable[Callable[[], Awaitable[object]]]]
"""Starts a motion, and returns what ends it."""

UNMINDED, BLIND = JogCollisionOptions(minded=False), CollisionOptions(avoid=False)
TO_JOINTS = JointTrapVel(joints=GOAL, speed=1.0, collisions=BLIND)


def _sent(goal: Action[Any, Any]) -> Begin:
    async def begin(cell: SeparatedCell) -> Callable[[], Awaitable[object]]:
        handle = cell.bus.send_goal(goal, to="left")

        async def end() -> None:
            handle.cancel()
            await handle.result()

        return end

    return begin


async def _streamed(cell: SeparatedCell) -> Callable[[], Awaitable[object]]:
    on = await cell.bus.call(SwitchDirectControl(on=True, watchdog_s=2.0, collisions=BLIND), to="left")
    assert on.success, on.message
    cell.bus.topic("left/direct_joints", JointCommand).publish(JointCommand(position_rad=GOAL))
    return lambda: cell.bus.call(SwitchDirectControl(on=False), to="left")


MOTIONS: dict[str, Begin] = {
    "joints": _sent(TO_JOINTS),
    "planned": _sent(MoveFree(target=MotionTarget(joints=GOAL), options=PlanOptions(speed=1.0))),
    "jog": _sent(JogJoints(velocity_rad_s=(1.0, *(0.0,) * 6), duration_s=1.0, scene=UNMINDED)),
    "step": _sent(StepTool(step_m=(0.0, 0.3, 0.0), speed_m_s=0.5, scene=UNMINDED)),
    "direct": _streamed,
    "guided": _sent(GuideArm(collisions=BLIND)),
}
pytestmark = pytest.mark.virtual


def _tool_xyz(cell: SeparatedCell) -> Vector3:
    frames = cell.bus.topic("cell/frames", FramePoses).latest
    assert frames is not None
    return frames.xyz[frames.names.index("left/panda_hand_tcp")]


async def _speed_at_contact(folder: Path, document: Cell, begin: Begin, *, sent_after_s: float) -> float:
    """Start a motion so long after the hand has set out; return the arm's speed in rad/s just before they touch."""
    async with opened_cell(folder, document) as cell:
        await cell.move(START).result()
        # The cameras have nothing to do, and their map grows old.
        await cell.bus.clock.sleep(1.0)
        x, y, z = _tool_xyz(cell)
        reach = Reach(person="anna", hand_m=(x + _CLOSE_M, y, z), speed_m_s=1.6, stay_s=1.0)
        await cell.bus.call(reach, to="cell")
        await cell.bus.clock.sleep(sent_after_s)
        end = await begin(cell)
        before_rad_s = now_rad_s = 0.0
        end_s = cell.bus.clock.now_s() + 2.0
        while (await cell.bus.call(CountContacts(person="anna"), to="cell")).contacts == 0:
            assert cell.bus.clock.now_s() < end_s, "the hand has touched nothing"
            await cell.bus.clock.sleep(0.001)
            before_rad_s, now_rad_s = now_rad_s, cell.speed_rad_s
        await end()
        return before_rad_s


@pytest.mark.parametrize("sent_after_s", [0.4, 0.9])
@pytest.mark.parametrize("kind", MOTIONS)
async def test_a_hand_that_comes_near_meets_an_arm_at_rest(tmp_path: Path, kind: str, sent_after_s: float) -> None:
    assert await _speed_at_contact(tmp_path, CELL, MOTIONS[kind], sent_after_s=sent_after_s) < _MOVES_RAD_S


@pytest.mark.parametrize("sent_after_s", [0.75, 0.8])
async def test_an_arm_does_not_start_before_the_slowest_camera_has_looked(tmp_path: Path, sent_after_s: float) -> None:
    """The other one shows an empty cell at once: of the hand only this one knows."""
    assert await _speed_at_contact(tmp_path, SLOW_SIDE, _sent(TO_JOINTS), sent_after_s=sent_after_s) < _MOVES_RAD_S
