"""equipment.PullBase and CheckBase: brakes are released for what is possible, and locked whatever happens."""

from __future__ import annotations

from typing import Any

import pytest

from engine.errors import SkillFailed
from engine.messages import Pose, Wrench
from engine.skills.arm_control import ArmStatus, ControlSettings
from engine.skills.device_moves import DeviceEnd, DeviceResult, MoveDevice
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.linear_units import BasePull, LinearUnitReading
from engine.skills.motion import CartLinTask, CartMotionResult, InverseKinematicsResult
from engine.state import Outcome
from states.equipment.check_base import CheckBase
from states.equipment.pull_base import PullBase
from tests.states.fake_context import FakeContext, broken_off

BASE = Pose(xyz=(0.0, -0.4, 0.2))
START = Pose(xyz=(0.7, 0.4, 0.3), frame="arm/base_link")
GOAL = Pose(xyz=(0.7, -0.4, 0.3), frame="arm/base_link")
TOOL = Pose(xyz=(0.7, 0.0, 0.5))


def planned(refused: str = "", *, robot: str = "arm", has_scale: bool = True) -> BasePull:
    """Return how the unit plans a pull of 0.8 m."""
    return BasePull(
        refused=refused,
        robot=robot,
        anchor="post",
        start_m=0.0,
        goal_m=0.8,
        start=START,
        goal=GOAL,
        along=(0.0, 1.0, 0.0),
        carried_kg=3.0,
        has_scale=has_scale,
        released="released",
        locked="locked",
    )


def switched(how: DeviceEnd = "timed") -> GoalEnd[DeviceResult]:
    """Return the end of a motion of the brakes."""
    return GoalEnd(GoalStatus.SUCCEEDED, DeviceResult(ended=how, sensed="unknown", reason="no pressure"), None)


def moved() -> GoalEnd[CartMotionResult]:
    """Return the end of a line."""
    return GoalEnd(GoalStatus.SUCCEEDED, CartMotionResult(pose=TOOL, duration_s=1.0), None)


def reading(place_m: float, *, scale_m: float | None = None) -> LinearUnitReading:
    """Return what the unit says of a place."""
    return LinearUnitReading(place_m=place_m, scale_m=scale_m, target_m=0.8, base=BASE)


def held(back_m: float) -> Pose:
    """Return the anchor where the arm measures it when the tool has gone back by so much in the frame of the base."""
    return Pose(xyz=(0.7, -back_m, 0.5))


def solved(*joints: float) -> InverseKinematicsResult:
    """Return a configuration."""
    return InverseKinematicsResult(joints=joints, dexterity=0.3, manipulability=0.1, singular=False)


def context(
    *,
    pull: BasePull | None = None,
    readings: list[LinearUnitReading] | None = None,
    tools: list[Pose] | None = None,
    lines: list[object] | None = None,
    brakes: list[object] | None = None,
    load_kg: float = 0.0,
    configurations: object = None,
) -> FakeContext:
    """Return a context with these answers, in their order."""
    status = ArmStatus(
        mode="idle",
        settings=ControlSettings(load_kg=load_kg),
        external_nm=(),
        wrench=Wrench(frame="arm/tool0", force_n=(0.0, 0.0, 0.0), torque_nm=(0.0, 0.0, 0.0)),
    )
    return FakeContext(
        {
            "arm/forward_kinematics": [TOOL, *(tools or [TOOL] * 9)],
            "arm/read_arm": status,
            "arm/inverse_kinematics": configurations or solved(0.1, 0.2),
            "arm/cart_lin_task": lines or [],
            "rail/plan_base_pull": pull or planned(),
            "rail/read_linear_unit": readings or [],
            "rail/move_device": brakes or [],
        }
    )


BY_SCALE = PullBase(robot="arm", device="rail", place="north", by="scale", settle_s=0.0)
BY_ARM = PullBase(robot="arm", device="rail", place="north", settle_s=0.0)


def did(ctx: FakeContext) -> list[str]:
    """Return the goals in their order: `released`, `line`, `locked`."""
    goals = [goal for _, goal in ctx.sent if isinstance(goal, MoveDevice | CartLinTask)]
    return [goal.position if isinstance(goal, MoveDevice) else "line" for goal in goals]


def why(outcome: Outcome) -> str:
    """Return the reason of an outcome."""
    assert outcome.cause is not None
    assert outcome.cause.because is not None
    return outcome.cause.because.message


async def test_the_base_is_corrected_until_it_is_there_and_measured_with_locked_brakes() -> None:
    readings = [reading(0.796, scale_m=place) for place in (0.796, 0.79995, 0.79965)]
    ctx = context(readings=readings, lines=[moved(), moved()], brakes=[switched(), switched()])
    outcome = await BY_SCALE.run(ctx)
    assert did(ctx) == ["released", "line", "line", "locked"]
    assert outcome.name == "reached"
    assert outcome.outputs == {"error_m": pytest.approx(-0.00035), "drift_m": pytest.approx(-0.0003)}
    first, second = [goal for _, goal in ctx.sent if isinstance(goal, CartLinTask)]
    assert (first.pose, first.collisions.avoid) == (GOAL, False)
    # Nine tenths of what was missed: it does not go too far.
    assert second.pose.xyz == pytest.approx((0.7, -0.4 - 0.9 * 0.004, 0.3))
    assert second.pose.frame == "arm/base_link"


async def test_measured_by_the_arm_the_anchor_stands_still() -> None:
    """How far the tool went back in the frame of the base is how far the base went on."""
    readings = [reading(0.0)] * 2
    ctx = context(
        readings=readings, tools=[held(0.7999), held(0.798)], lines=[moved()], brakes=[switched(), switched()]
    )
    outcome = await BY_ARM.run(ctx)
    assert (outcome.name, did(ctx)) == ("off", ["released", "line", "locked"])
    assert outcome.outputs == {"error_m": pytest.approx(-0.002), "drift_m": pytest.approx(-0.0019)}
    expected = "with locked brakes it is 2.00 mm away, measured by the arm; it moved by -1.90 mm while they were locked"
    assert why(outcome) == expected


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        (dict[str, Any](pull=planned("50.0 mm beyond its travel")), "50.0 mm beyond its travel"),
        (dict[str, Any](pull=planned(robot="other")), "other stands on it, not arm"),
        (dict[str, Any](pull=planned(has_scale=False)), "it has no scale: let the arm measure"),
        (dict[str, Any](load_kg=3.5), "arm carries 0.50 kg more than it may while it pulls"),
        (
            dict[str, Any](configurations=[solved(0.1, 0.2), SkillFailed("too far")]),
            "with its base at 50 mm, arm does not reach the anchor post, with the joints [0.10, 0.20] before",
        ),
        (
            dict[str, Any](configurations=[solved(0.1, 0.2), solved(0.1, 3.2)]),
            "with its base at 50 mm, arm would have to reconfigure itself, with the joints [0.10, 0.20] before",
        ),
    ],
    ids=["travel", "robot", "scale", "load", "reach", "configuration"],
)
async def test_what_cannot_be_is_refused_before_anything_moves(asked: dict[str, Any], words: str) -> None:
    ctx = context(**asked)
    outcome = await BY_SCALE.run(ctx)
    assert (outcome.name, did(ctx)) == ("refused", [])
    assert why(outcome) == words


async def test_an_arm_that_does_not_pull_leaves_the_brakes_locked() -> None:
    ctx = context(lines=[broken_off(GoalStatus.ABORTED, None)], brakes=[switched(), switched()])
    outcome = await BY_SCALE.run(ctx)
    assert (outcome.name, did(ctx)) == ("failed", ["released", "line", "locked"])


@pytest.mark.parametrize(
    ("brakes", "done"),
    [
        ([switched("no_air"), switched()], ["released", "locked"]),
        ([switched(), switched("stuck")], ["released", "line", "locked"]),
    ],
    ids=["not released", "not locked"],
)
async def test_brakes_that_do_not_switch_are_an_outcome(brakes: list[object], done: list[str]) -> None:
    ctx = context(readings=[reading(0.8, scale_m=0.8)] * 2, lines=[moved()], brakes=brakes)
    outcome = await BY_SCALE.run(ctx)
    assert (outcome.name, did(ctx)) == ("brakes_failed", done)
    assert outcome.cause is not None
    assert outcome.cause.because is not None
    assert outcome.cause.because.because is not None
    assert outcome.cause.because.because.message == "no pressure"


@pytest.mark.parametrize(("place", "place_m"), [("", None), ("north", 0.8)])
def test_a_place_has_a_name_or_is_in_metres(place: str, place_m: float | None) -> None:
    with pytest.raises(ValueError, match="either `place` or `place_m`"):
        PullBase(robot="arm", device="rail", place=place, place_m=place_m)
    with pytest.raises(ValueError, match="either `place` or `place_m`"):
        CheckBase(device="rail", place=place, place_m=place_m)


@pytest.mark.parametrize(
    ("shown", "name", "error_m"),
    [
        (reading(0.7991), "at_place", -0.0009),
        (reading(0.7989), "off", -0.0011),
        (reading(0.8, scale_m=0.8015), "off", 0.0015),
    ],
    ids=["within tolerance", "beyond it", "by its scale"],
)
async def test_a_check_compares_where_the_carriage_is(shown: LinearUnitReading, name: str, error_m: float) -> None:
    ctx = FakeContext({"rail/read_linear_unit": shown})
    outcome = await CheckBase(device="rail", place="north").run(ctx)
    assert (outcome.name, outcome.outputs["error_m"]) == (name, pytest.approx(error_m))


async def test_a_unit_that_does_not_answer_fails() -> None:
    ctx = FakeContext({"rail/read_linear_unit": SkillFailed("rail has no place nord")})
    outcome = await CheckBase(device="rail", place="nord").run(ctx)
    assert (outcome.name, outcome.outputs) == ("failed", {})
