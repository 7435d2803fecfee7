"""The guard of a jog: an arm whose way nobody looks at any more stands, whatever has failed."""

from __future__ import annotations

import pytest

from engine.bus import GoalStatus
from engine.messages import Pose
from engine.messages.shapes import Box, Obstacle
from engine.skills.jogging import JogJoints
from engine.skills.planning_scene import PutObstacle
from robots.planning.request import PathCheck, PathCheckRequest
from tests.robots.fake_port import FakeStream
from tests.robots.workspace.fake_cell import fake_cell

AROUND = (0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
STILL = (0.0,) * 7
AWAY = PutObstacle(obstacle=Obstacle.of("far", Box(size_m=(0.1, 0.1, 0.1)), Pose(xyz=(2.0, 2.0, 2.0))))


@pytest.mark.virtual
async def test_an_error_of_the_monitoring_itself_brings_the_arm_to_rest_with_the_reason(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    async def fail(_request: PathCheckRequest) -> PathCheck:
        raise ValueError("odd")

    async with fake_cell() as cell:
        held: list[str] = []
        handle = cell.bus.send_goal(JogJoints(velocity_rad_s=AROUND, duration_s=2.0), to="left")
        handle.on_feedback(lambda feedback: held.append(feedback.held_by))
        await handle.accepted()
        await cell.bus.clock.sleep(0.5)
        stream = cell.port.motion
        assert isinstance(stream, FakeStream)
        assert (stream.sent[-1], held[-1]) == (AROUND, "")
        monkeypatch.setattr(cell.planner, "check_path", fail)
        await cell.bus.call(AWAY, to="cell")
        await cell.bus.clock.sleep(0.2)
        assert stream.sent[-1] == STILL
        assert held[-1] == "jog monitoring failed: ValueError: odd"
        assert (await handle.result()).status is GoalStatus.SUCCEEDED
        assert stream.sent[-1] == STILL
