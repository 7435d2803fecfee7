"""A motion whose monitoring cannot begin does not move on: nobody would stop it."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from engine.bus import GoalStatus
from engine.errors import CellError
from engine.skill import Action
from engine.skills.jogging import JogJoints, StepJoints
from engine.skills.motion import JointTrapVel
from engine.skills.planning import MotionTarget, MoveFree, PlanOptions
from robots.arm.execution.lookahead_path import PathReservation
from robots.arm.jogging.jog_guard import JogGuard
from tests.robots.fake_port import STOPPING_S
from tests.robots.panda_arm import home
from tests.robots.workspace.fake_cell import fake_cell

GOAL = tuple((home() + 0.2).tolist())
GOALS: tuple[Action[Any, Any], ...] = (
    JointTrapVel(joints=GOAL, speed=0.1),
    StepJoints(step_rad=(0.2, *(0.0,) * 6), speed=0.1),
    MoveFree(target=MotionTarget(joints=GOAL), options=PlanOptions(speed=0.1)),
)


@pytest.mark.virtual
@pytest.mark.parametrize("goal", GOALS, ids=lambda goal: type(goal).__name__)
@pytest.mark.parametrize("at_fault", ["renew", "update"])
async def test_an_arm_whose_path_cannot_be_monitored_comes_to_rest(
    goal: Action[Any, Any], at_fault: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(_reservation: PathReservation, _what: object) -> None:
        raise CellError("the path cannot be reserved")

    async with fake_cell() as cell:
        monkeypatch.setattr(PathReservation, at_fault, fail)
        end = await cell.bus.send_goal(goal, to="left").result()
        assert end.status is GoalStatus.ABORTED
        await asyncio.sleep(2.0 * STOPPING_S)
        assert not cell.moves()


@pytest.mark.virtual
async def test_a_jog_whose_guard_fails_ends_its_stream(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_guard: JogGuard, _command: tuple[float, ...]) -> tuple[float, ...]:
        raise CellError("the way is not known")

    async with fake_cell() as cell:
        monkeypatch.setattr(JogGuard, "bounded", fail)
        jog = JogJoints(velocity_rad_s=(0.1, *(0.0,) * 6), duration_s=5.0)
        end = await cell.bus.send_goal(jog, to="left").result()
        assert end.status is GoalStatus.ABORTED
        await asyncio.sleep(2.0 * STOPPING_S)
        assert cell.port.motion is not None
        assert cell.port.motion.ended
