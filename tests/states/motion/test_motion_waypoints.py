"""The state that moves an arm through waypoints: what it asks for, how it words a failure, how it is undone."""

from __future__ import annotations

from typing import Any

import msgspec
import pytest

from engine.errors import Cause, EntryNotFound
from engine.messages import Pose
from engine.skills.arm_target import ArmTarget
from engine.skills.entries import EntryRecord, ReadEntry
from engine.skills.goal_end import GoalEnd, GoalStatus
from engine.skills.waypoints import FollowWaypoints as FollowGoal
from engine.skills.waypoints import Waypoint, WaypointsResult
from engine.state import ActivationRecord, Outcome, RequestRecord
from states.motion.follow_waypoints import FollowWaypoints
from tests.states.fake_context import FakeContext, broken_off

START, FIRST, SECOND = (0.0, 0.0), (0.1, 0.2), (0.3, 0.4)
DONE = WaypointsResult(joints=SECOND, duration_s=2.0, start=START, waypoints=(FIRST, SECOND), passed=2)
HALF_WAY = WaypointsResult(joints=(0.2, 0.3), duration_s=1.0, start=START, waypoints=(FIRST, SECOND), passed=1)


def state(*waypoints: dict[str, object], **given: object) -> FollowWaypoints:
    """Make the state as a document does."""
    return msgspec.convert({"robot": "left", "waypoints": list(waypoints), **given}, FollowWaypoints)


PLAIN = state({"joints": FIRST, "blend_m": 0.1}, {"joints": SECOND}, speed=0.3)


async def test_waypoints_are_commanded_in_order_with_their_own_blend_or_that_of_the_state() -> None:
    """A pose keeps its frame; the arm knows it."""
    ctx = FakeContext({"left/follow_waypoints": GoalEnd(GoalStatus.SUCCEEDED, DONE, None)})
    given = state(
        {"joints": FIRST, "blend_m": 0.0},
        {"pose": {"xyz": [0.1, 0.2, 0.3], "frame": "left/base"}},
        blend_m=0.05,
        speed_m_s=0.2,
        match="axis",
    )
    assert await given.run(ctx) == Outcome("reached")
    pose = Pose(xyz=(0.1, 0.2, 0.3), frame="left/base")
    through = (Waypoint(joints=FIRST, blend_m=0.0), Waypoint(pose=pose, blend_m=0.05))
    assert ctx.sent == [
        ("left/follow_waypoints", FollowGoal(waypoints=through, speed=0.5, speed_m_s=0.2, match="axis"))
    ]


async def test_waypoints_named_by_entries_are_read_when_the_state_runs() -> None:
    """Of either kind."""
    records = [
        EntryRecord(kind="joints", name="home", value={"joints": list(FIRST), "names": []}, revision=1),
        EntryRecord(kind="pose", name="above", value={"xyz": [0.1, 0.2, 0.3]}, revision=1),
    ]
    done = GoalEnd(GoalStatus.SUCCEEDED, DONE, None)
    ctx = FakeContext({"store/read_entry": records, "left/follow_waypoints": done})
    await state({"joints": {"entry": "home"}}, {"pose": {"entry": "above"}}).run(ctx)
    assert [request for _, request in ctx.sent] == [
        ReadEntry(kind="joints", name="home"),
        ReadEntry(kind="pose", name="above"),
        FollowGoal(waypoints=(Waypoint(joints=FIRST), Waypoint(pose=Pose(xyz=(0.1, 0.2, 0.3))))),
    ]


async def test_a_missing_entry_is_an_error_that_names_it() -> None:
    """Nothing has moved then."""
    ctx = FakeContext({"store/read_entry": EntryNotFound("there is no joints entry called hme")})
    with pytest.raises(EntryNotFound, match="hme"):
        await state({"joints": {"entry": "hme"}}).run(ctx)


@pytest.mark.parametrize(
    ("end", "what"),
    [
        (broken_off(GoalStatus.REJECTED, Cause(message="waypoints[1]: too far")), "rejected"),
        (
            GoalEnd(GoalStatus.ABORTED, HALF_WAY, Cause(message="waypoints[1]: too far")),
            "beyond the first 1: follow_waypoints was aborted",
        ),
    ],
)
async def test_a_failure_says_how_far_the_arm_came_and_why(end: GoalEnd[Any], what: str) -> None:
    """The chain goes down to the device."""
    outcome = await PLAIN.run(FakeContext({"left/follow_waypoints": end}))
    assert outcome.name == "failed"
    assert outcome.cause is not None
    first, last = [link.message for link in outcome.cause.chain()]
    assert first.startswith("left did not follow its 2 waypoints")
    assert first.endswith(what)
    assert last == "waypoints[1]: too far"


def activation(result: WaypointsResult | None) -> ActivationRecord:
    """Make the record of a motion with this result."""
    plain = None if result is None else msgspec.to_builtins(result)
    sent = RequestRecord(address="left/follow_waypoints", request={}, status="succeeded", result=plain)
    return ActivationRecord(inputs={}, outcome="reached", outputs={}, requests=(sent,))


@pytest.mark.parametrize(("result", "through"), [(DONE, (SECOND, FIRST)), (HALF_WAY, (FIRST,))])
async def test_it_is_undone_through_the_passed_waypoints_in_reverse(
    result: WaypointsResult, through: tuple[tuple[float, ...], ...]
) -> None:
    """A motion that was stopped passes only those that it had reached."""
    ctx = FakeContext({"left/follow_waypoints": GoalEnd(GoalStatus.SUCCEEDED, result, None)})
    assert PLAIN.cannot_undo(activation(result)) == ""
    await PLAIN.undo(ctx, activation(result))
    blends: dict[tuple[float, ...], float] = {FIRST: 0.1, SECOND: 0.02}
    back = (*(Waypoint(joints=joints, blend_m=blends[joints]) for joints in through), Waypoint(joints=START))
    assert ctx.sent == [("left/follow_waypoints", FollowGoal(waypoints=back, speed=0.3))]


def test_it_cannot_be_undone_without_the_record_of_its_start() -> None:
    """As every motion."""
    assert "was not recorded" in PLAIN.cannot_undo(activation(None))


def test_the_targets_that_are_known_before_a_run_have_their_index() -> None:
    """The check says which waypoint it is about."""

    class Stored:
        """A store with nothing in it."""

        def joints(self, name: str) -> None:
            """Return no entry."""

        def pose(self, name: str) -> None:
            """Return no entry."""

    given = state({"joints": FIRST}, {"joints": {"entry": "later"}}, {"pose": {"xyz": [1, 2, 3]}}, match="position")
    assert given.resources() == ("left",)
    assert given.arm_targets(Stored()) == (
        ArmTarget(robot="left", parameter="waypoints", index=0, joints=FIRST),
        ArmTarget(robot="left", parameter="waypoints", index=2, pose=Pose(xyz=(1, 2, 3)), match="position"),
    )


MALFORMED: list[tuple[list[object], str]] = [
    ([], "length >= 1"),
    ([{}], "give either `joints` or `pose`"),
    ([{"joints": [0.0], "pose": {"entry": "a"}}], "give either `joints` or `pose`"),
    ([{"joints": [0.0], "blend": 0.1}], "blend"),
    ([{"joints": [0.0], "blend_m": -0.1}], "blend_m"),
    ([{"pose": {}}], "give either `entry` or `xyz`"),
    ([[0.0, 1.0]], "object"),
]


@pytest.mark.parametrize(("waypoints", "message"), MALFORMED)
def test_malformed_waypoints_are_refused(waypoints: list[object], message: str) -> None:
    """The document check finds it before anything moves."""
    with pytest.raises(msgspec.ValidationError, match=message):
        msgspec.convert({"robot": "left", "waypoints": waypoints}, FollowWaypoints)
