"""Placing a part: the order of the steps, the poses of the tool, and each failure outcome."""

from __future__ import annotations

import msgspec
import pytest

from engine.errors import SkillFailed
from engine.messages import GripperState, Pose
from engine.skills.arm_control import SetLoad
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.state import Outcome
from states.manipulation.place_part import PlacePart
from states.motion.motion_target import ShownPoseTarget
from tests.states.fake_context import broken_off
from tests.states.manipulation.picking_cell import (
    AT_CRATE,
    DOWN,
    IN_THE_WAY,
    LIMIT,
    STOOD,
    asked,
    beside,
    cell,
    lines,
    touching,
)

PLACE = PlacePart(robot="arm", part="block", target=ShownPoseTarget(xyz=(0.2, 0.4, 0.25), xyzw=DOWN))


async def test_the_part_is_carried_over_put_down_let_go_and_left_in_this_order() -> None:
    ctx = cell(check_collision=touching("block", "table", 0.004))
    assert await PLACE.run(ctx) == Outcome("placed")
    assert asked(ctx) == [
        "arm/gripper/read_gripper",
        "cell/check_collision",
        "arm/move_free",
        "arm/gripper/read_gripper",
        "arm/cart_lin_task",
        "arm/gripper/gripper_open",
        "cell/detach_part",
        "arm/set_load",
        "arm/cart_lin_task",
    ]
    assert beside(ctx) == [(0.2, 0.4, 0.35)]
    assert lines(ctx) == [(0.2, 0.4, 0.25), (0.2, 0.4, 0.35)]
    assert ("arm/set_load", SetLoad(mass_kg=0.0)) in ctx.sent


async def test_the_part_itself_comes_to_the_target_however_the_tool_holds_it() -> None:
    """The block hangs 40 mm below the tool centre and 10 mm beside it."""
    ctx = cell(forward_kinematics=Pose(xyz=(0.51, 0.1, 0.24), xyzw=DOWN))
    state = PlacePart(robot="arm", part="block", target=ShownPoseTarget(xyz=(0.2, 0.4, 0.05)), target_of="part")
    assert (await state.run(ctx)).name == "placed"
    assert lines(ctx)[0] == (0.21, 0.4, 0.09)


@pytest.mark.parametrize(
    ("changed", "outcome", "reason"),
    [
        (
            {"read_gripper": GripperState(time_s=0.0, width_m=0.0, force_n=0.0, held=False)},
            "missed",
            "arm lost part block",
        ),
        ({"move_free": broken_off(GoalStatus.REJECTED, LIMIT)}, "unreachable", "joint 4 would exceed its limit"),
        ({"cart_lin_task": broken_off(GoalStatus.REJECTED, LIMIT)}, "unreachable", "joint 4 would exceed its limit"),
        ({"move_free": GoalEnd(GoalStatus.ABORTED, STOOD, LIMIT)}, "blocked", "joint 4 would exceed its limit"),
        ({"check_collision": AT_CRATE}, "blocked", "at the target, arm/finger with crate would touch"),
        (
            {"check_collision": touching("crate", "block", 0.015)},
            "blocked",
            "crate with block (15 mm deep) would touch",
        ),
        ({"check_collision": touching("arm/elbow", "block", 0.001)}, "blocked", "arm/elbow with block (1 mm deep)"),
        ({"cart_lin_task": broken_off(GoalStatus.REJECTED, IN_THE_WAY)}, "blocked", "block would touch crate"),
        ({"gripper_open": broken_off(GoalStatus.ABORTED, LIMIT)}, "failed", "did not open to release part block"),
        ({"detach_part": SkillFailed("the cell is closed")}, "failed", "part block was not detached"),
    ],
    ids=str,
)
async def test_every_way_of_not_getting_there_has_its_outcome_and_reason(
    changed: dict[str, object], outcome: str, reason: str
) -> None:
    result = await PLACE.run(cell(**changed))
    assert result.name == outcome
    assert reason in str(result.outputs["reason"])
    assert result.cause is not None
    assert result.cause.message == "arm did not place part block"


async def test_a_part_that_is_lost_on_the_way_is_not_put_down() -> None:
    lost = GripperState(time_s=0.0, width_m=0.0, force_n=0.0, held=False)
    ctx = cell(read_gripper=[msgspec.structs.replace(lost, held=True), lost])
    assert (await PLACE.run(ctx)).name == "missed"
    assert "arm/cart_lin_task" not in asked(ctx)


def test_a_direction_of_no_length_is_refused_with_the_document() -> None:
    given = {"robot": "arm", "part": "block", "target": {"entry": "place"}, "approach": [0, 0, 0]}
    with pytest.raises(msgspec.ValidationError, match="`approach` must not be a zero vector"):
        msgspec.convert(given, PlacePart)
