"""equipment.MoveHexapod and CheckHexapod: brakes are released for what is possible, and locked whatever happens."""

from __future__ import annotations

import math

import pytest

from engine.errors import SkillFailed
from engine.messages import Pose
from engine.skills.device_moves import DeviceEnd, DeviceResult, MoveDevice
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.hexapods import HexapodMove, HexapodReading
from engine.skills.motion import CartLinTask, CartMotionResult
from engine.state import Outcome
from states.equipment.check_hexapod import CheckHexapod
from states.equipment.move_hexapod import MoveHexapod
from tests.states.fake_context import FakeContext, broken_off

START, GOAL = Pose(xyz=(0.5, 0.0, 0.2)), Pose(xyz=(0.5, 0.0, 0.23))
TOOL = Pose(xyz=(0.5, 0.0, 0.24), xyzw=(1.0, 0.0, 0.0, 0.0))
GOAL_TOOL = Pose(xyz=(0.5, 0.0, 0.27), xyzw=(1.0, 0.0, 0.0, 0.0))


def planned(refused: str = "") -> HexapodMove:
    """Return how the hexapod plans the move."""
    return HexapodMove(
        refused=refused,
        start=START,
        platform=GOAL,
        tool=GOAL_TOOL,
        released="released",
        locked="locked",
        bodies=("jig/platform", "jig/handle"),
    )


def switched(how: DeviceEnd = "timed") -> GoalEnd[DeviceResult]:
    """Return the end of a motion of the brakes."""
    return GoalEnd(GoalStatus.SUCCEEDED, DeviceResult(ended=how, sensed="unknown", reason="no pressure"), None)


def moved() -> GoalEnd[CartMotionResult]:
    """Return the end of a line."""
    return GoalEnd(GoalStatus.SUCCEEDED, CartMotionResult(pose=GOAL_TOOL, duration_s=1.0), None)


def at(*, below_m: float) -> Pose:
    """Return a tool that has stopped below the goal."""
    return Pose(xyz=(0.5, 0.0, 0.27 - below_m), xyzw=GOAL_TOOL.xyzw)


def reading(*, below_m: float) -> HexapodReading:
    """Return what the cell shows of a platform that has stopped below the goal."""
    return HexapodReading(platform=Pose(xyz=(0.5, 0.0, 0.23 - below_m)), target=GOAL, lengths_m=(0.2,) * 6)


def context(
    *,
    tools: list[Pose],
    lines: list[object],
    brakes: list[object],
    move: HexapodMove | None = None,
    readings: list[HexapodReading] | None = None,
) -> FakeContext:
    """Return a context with these answers, in their order."""
    return FakeContext(
        {
            "arm/forward_kinematics": [TOOL, *tools],
            "arm/cart_lin_task": lines,
            "jig/legs/plan_hexapod_move": move or planned(),
            "jig/legs/read_hexapod": readings or [],
            "jig/legs/move_device": brakes,
        }
    )


STATE = MoveHexapod(robot="arm", device="jig/legs", pose="high", settle_s=0.0)


def did(ctx: FakeContext) -> list[str]:
    """Return the goals in their order: `released`, `line`, `locked`."""
    goals = [goal for _, goal in ctx.sent if isinstance(goal, MoveDevice | CartLinTask)]
    return [goal.position if isinstance(goal, MoveDevice) else "line" for goal in goals]


async def test_the_arm_corrects_until_its_tool_is_there_and_measures_with_locked_brakes() -> None:
    tools = [at(below_m=0.004), at(below_m=0.00005), at(below_m=0.0003)]
    ctx = context(tools=tools, lines=[moved(), moved()], brakes=[switched(), switched()])
    outcome = await STATE.run(ctx)
    assert did(ctx) == ["released", "line", "line", "locked"]
    assert outcome.name == "reached"
    assert outcome.outputs["error_m"] == pytest.approx(0.0003)
    second = [goal for _, goal in ctx.sent if isinstance(goal, CartLinTask)][1]
    # Nine tenths of what was missed: it does not go too far.
    assert second.pose.xyz[2] == pytest.approx(0.27 + 0.9 * 0.004)
    assert second.collisions.may_touch == ("jig/platform", "jig/handle")


async def test_measured_by_the_cell_counts_what_slips_in_the_grip() -> None:
    state = MoveHexapod(robot="arm", device="jig/legs", pose="high", settle_s=0.0, by="cell", corrections=0)
    ctx = context(tools=[], lines=[moved()], brakes=[switched(), switched()], readings=[reading(below_m=0.002)] * 2)
    outcome = await state.run(ctx)
    assert (outcome.name, outcome.outputs["error_m"]) == ("off", pytest.approx(0.002))
    assert outcome.cause is not None
    assert outcome.cause.because is not None
    assert outcome.cause.because.message == "with locked brakes it is 2.00 mm and 0.00° away, measured by the cell"


async def test_a_pose_beyond_limits_is_refused_before_anything_moves() -> None:
    refused = planned("leg 3 would be 12.0 mm longer than its 230.0 mm")
    ctx = context(tools=[], lines=[], brakes=[], move=refused)
    outcome = await STATE.run(ctx)
    assert (outcome.name, did(ctx)) == ("beyond_limits", [])
    assert outcome.cause is not None
    assert outcome.cause.because is not None
    assert outcome.cause.because.message == "leg 3 would be 12.0 mm longer than its 230.0 mm"


async def test_an_arm_that_does_not_move_leaves_the_brakes_locked() -> None:
    ctx = context(tools=[], lines=[broken_off(GoalStatus.ABORTED, None)], brakes=[switched(), switched()])
    outcome = await STATE.run(ctx)
    assert (outcome.name, did(ctx)) == ("failed", ["released", "line", "locked"])


@pytest.mark.parametrize(
    ("brakes", "done"),
    [
        ([switched("no_air")], ["released"]),
        ([switched(), switched("stuck")], ["released", "line", "locked"]),
    ],
    ids=["not released", "not locked"],
)
async def test_brakes_that_do_not_switch_are_an_outcome(brakes: list[object], done: list[str]) -> None:
    ctx = context(tools=[at(below_m=0.0)], lines=[moved()], brakes=brakes)
    outcome = await STATE.run(ctx)
    assert (outcome.name, did(ctx)) == ("brakes_failed", done)
    assert outcome.cause is not None
    assert outcome.cause.because is not None
    assert outcome.cause.because.because is not None
    assert outcome.cause.because.because.message == "no pressure"


@pytest.mark.parametrize(
    ("below_m", "name"), [(0.0004, "at_pose"), (0.0006, "off")], ids=["within tolerance", "beyond it"]
)
async def test_a_check_compares_what_the_cell_shows(below_m: float, name: str) -> None:
    ctx = FakeContext({"jig/legs/read_hexapod": reading(below_m=below_m)})
    outcome = await CheckHexapod(device="jig/legs", pose="high").run(ctx)
    assert (outcome.name, outcome.outputs["error_m"]) == (name, pytest.approx(below_m))


async def test_a_check_compares_angles_too() -> None:
    turned = Pose(xyz=GOAL.xyz, xyzw=(0.0, 0.0, math.sin(0.002), math.cos(0.002)))
    ctx = FakeContext({"jig/legs/read_hexapod": HexapodReading(platform=turned, target=GOAL, lengths_m=(0.2,) * 6)})
    outcome = await CheckHexapod(device="jig/legs", pose="high").run(ctx)
    assert (outcome.name, outcome.outputs["error_rad"]) == ("off", pytest.approx(0.004))


async def test_a_hexapod_that_is_not_there_fails() -> None:
    ctx = FakeContext({"jig/legs/read_hexapod": SkillFailed("jig/legs is not in the cell")})
    outcome: Outcome = await CheckHexapod(device="jig/legs", pose="high").run(ctx)
    assert outcome.name == "failed"
