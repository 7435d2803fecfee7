"""Whether an arm must stop: by what was found on its path, and by everything that keeps it from being found."""

from __future__ import annotations

import math

import pytest

from engine.errors import RobotError
from robots.arm.execution.collision_prediction import PredictedCollision, predict_collision
from robots.arm.scene_queries.path_guard import PathRules
from tests.robots.arm.execution.fake_guard import OTHER_ARM, WALL, FakeGuard, blocked, line

pytestmark = pytest.mark.virtual


async def _predicted(fake: FakeGuard, *, by_cameras: bool = True) -> PredictedCollision | None:
    query = fake.check(line(), PathRules(), from_s=0.0)
    return await predict_collision(fake.workspace, query, by_cameras=by_cameras)


async def test_a_free_path_is_no_reason_to_stop() -> None:
    assert await _predicted(FakeGuard()) is None


async def test_a_collision_has_its_time_and_its_bodies() -> None:
    fake = FakeGuard()
    fake.answer = blocked(1.5, WALL, OTHER_ARM)
    found = await _predicted(fake)
    assert found == PredictedCollision(
        reason="left/hand would touch wall and 1 more", at_s=1.5, pairs=(WALL, OTHER_ARM)
    )
    assert found is not None
    assert not found.is_unmonitored


async def test_a_path_that_cannot_be_checked_is_unmonitored() -> None:
    fake = FakeGuard()
    fake.answer = RobotError("the planner is gone")
    found = await _predicted(fake)
    assert found == PredictedCollision(
        reason="path monitoring is not available: the planner is gone", at_s=math.inf, pairs=()
    )
    assert found is not None
    assert found.is_unmonitored


@pytest.mark.parametrize(("takes_s", "is_late"), [(0.29, False), (0.31, True)])
async def test_an_answer_within_three_tenths_of_a_second_counts(*, takes_s: float, is_late: bool) -> None:
    fake = FakeGuard()
    fake.takes_s = takes_s
    found = await _predicted(fake)
    assert found == (PredictedCollision(reason="its path was not checked within 0.3 s") if is_late else None)


async def test_blind_cameras_matter_to_who_relies_on_them() -> None:
    fake = FakeGuard()
    fake.unobserved_reason = "side is covered"
    assert await _predicted(fake) == PredictedCollision(reason="side is covered")
    assert fake.asked_s == []
    assert await _predicted(fake, by_cameras=False) is None
    assert fake.asked_s == [0.0]
