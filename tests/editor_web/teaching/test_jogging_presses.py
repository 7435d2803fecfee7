"""Every press moves the tool its way, however short it is and whatever was pressed before: by logs of the pose."""

from __future__ import annotations

import random
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import pytest

from editor_web.teaching.jogging import LEAST_PRESS_S
from editor_web.teaching.teaching_messages import StartJog
from engine.bus import GoalStatus
from engine.bus.json_bus import CLI_HOLDER
from engine.skills.jogging import MOST_WAIT_S, StepJoints
from tests.editor_web.teaching.jogged_arm import REPEAT_S, STEP_S, Jogged, Press, jogged, least

M_S, RAD_S = 0.04, 0.15
PRESSES, SEED = 100, 7
HOLDS_S = (0.0, 0.01, 0.06, 0.13)
# As fast as fingers are, and faster than the arm may follow.
PAUSES_S, HASTE_S = (0.1, 0.12, 0.2), (0.0, 0.02)


def any_press(random_: random.Random) -> Press:
    """A press of any key of the panel."""
    hold_s, sign = random_.choice(HOLDS_S), random_.choice((1.0, -1.0))
    if random_.random() < 0.15:
        joint = random_.randrange(7)
        velocity = tuple(sign * RAD_S if at == joint else 0.0 for at in range(7))
        return Press(StartJog(arm="left", space="joints"), velocity, hold_s)
    axis = random_.randrange(6)
    velocity = tuple(sign * (M_S if at < 3 else RAD_S) if at == axis else 0.0 for at in range(6))
    frame = random_.choice(("world", "base", "tool"))
    return Press(StartJog(arm="left", space="tool", frame=frame), velocity, hold_s)


def opposite(press: Press) -> Press:
    return Press(press.jog, tuple(-value + 0.0 for value in press.velocity), press.hold_s)


def there_and_back(random_: random.Random) -> list[Press]:
    """Seeded presses after which the arm is where it was, so that it stays far from everything."""
    presses: list[Press] = []
    while len(presses) < PRESSES:
        first = any_press(random_)
        if not presses or presses[-1].axis != first.axis:
            presses += [first, opposite(first)]
    return presses


def executed(arm: Jogged, presses: Sequence[Press]) -> list[float]:
    """Return how far the arm has gone for each press, in their order; fails where it goes as no press says."""
    gone = [0.0] * len(presses)
    now = 0
    for before, after in pairwise(arm.log):
        change = after - before
        if not change.any():
            continue
        while not presses[now].along(before, change):
            now += 1
            assert now < len(presses), "the arm goes another way than any key says"
        gone[now] += presses[now].along(before, change)
    return gone


@pytest.mark.virtual
async def test_none_of_a_hundred_changes_of_direction_is_lost() -> None:
    """Of axis, sign, frame and mode: every press is executed in its turn, its way, and for its shortest time."""
    random_ = random.Random(SEED)
    presses = there_and_back(random_)
    async with jogged() as arm:
        for press in presses:
            await arm.press(press)
            await arm.wait(random_.choice(PAUSES_S))
        await arm.wait(2.0 * LEAST_PRESS_S)
        gone = executed(arm, presses)
    assert (arm.refusals, arm.dropped) == ([], 0)
    short = [k for k, (far, press) in enumerate(zip(gone, presses, strict=True)) if far < least(press)]
    assert short == [], f"{len(short)} presses moved too little: {[(presses[k], gone[k]) for k in short]}"


@pytest.mark.virtual
async def test_of_presses_that_come_too_fast_each_is_executed_or_reported_and_nothing_moves_long_after_the_last() -> (
    None
):
    random_ = random.Random(SEED)
    taps = [replace(press, hold_s=0.0) for press in there_and_back(random_) if press.jog.space == "tool"]
    async with jogged() as arm:
        for tap in taps:
            await arm.press(tap)
            await arm.wait(random_.choice(HASTE_S))
        released_s = arm.cell.bus.clock.now_s()
        await arm.wait(3.0)
        gone = executed(arm, taps)
        last_s = arm.moved_s[-1]
    # Two the same way are one motion, where those between them are dropped.
    moved = sum(round(far / (LEAST_PRESS_S * tap.speed)) for far, tap in zip(gone, taps, strict=True))
    assert (moved + arm.dropped, arm.dropped > 0) == (len(taps), True)
    assert last_s < released_s + MOST_WAIT_S + LEAST_PRESS_S + 2.0 * STEP_S


@pytest.mark.virtual
async def test_a_stick_that_comes_back_to_its_middle_begins_a_press_of_its_own() -> None:
    """The deadman button of the gamepad is held all the while, so the page tells of one press only."""
    random_ = random.Random(SEED)
    flicks = [press for press in there_and_back(random_) if press.jog == UP.jog]
    flicks = [flick for before, flick in pairwise(flicks) if flick.velocity != before.velocity]
    async with jogged() as arm:
        await arm.jogger.begin(UP.jog)
        for flick in flicks:
            await arm.jogger.go(flick.velocity)
            await arm.wait(REPEAT_S)
            await arm.jogger.go((0.0,) * 6)
            await arm.wait(0.12)
        await arm.jogger.release()
        await arm.wait(2.0 * LEAST_PRESS_S)
        gone = executed(arm, flicks)
    assert (arm.refusals, arm.dropped) == ([], 0)
    assert len(flicks) > 10
    assert [k for k, (far, flick) in enumerate(zip(gone, flicks, strict=True)) if far < least(flick)] == []


UP = Press(StartJog(arm="left", space="tool"), (0.0, 0.0, M_S, 0.0, 0.0, 0.0))
SIDE = Press(StartJog(arm="left", space="tool"), (0.0, M_S, 0.0, 0.0, 0.0, 0.0))


@pytest.mark.virtual
async def test_one_goal_serves_all_presses_and_ends_a_second_after_the_last() -> None:
    async with jogged() as arm:
        for press in (UP, SIDE, UP):
            await arm.press(press)
            await arm.wait(0.4)
        assert len(arm.cell.port.streamed) == 1
        assert arm.jogger.arm == ""
        await arm.wait(1.2)
        assert arm.cell.bus.goals() == ()
        await arm.press(SIDE)
        await arm.wait(0.3)
        assert len(arm.cell.port.streamed) == 2


@pytest.mark.virtual
async def test_another_goal_takes_the_arm_while_nothing_is_pressed_and_not_before() -> None:
    """A step of the same page, in the second in which the jog stays open."""
    step = StepJoints(step_rad=(0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    async with jogged() as arm:
        await arm.jogger.begin(UP.jog)
        await arm.jogger.go(UP.velocity)
        await arm.wait(0.05)
        busy = await arm.cell.bus.send_goal(step, to="left", holder=CLI_HOLDER).result()
        assert busy.status is GoalStatus.REJECTED
        await arm.jogger.release()
        await arm.wait(2.0 * LEAST_PRESS_S)
        stepped = await arm.cell.bus.send_goal(step, to="left", holder=CLI_HOLDER).result()
        assert stepped.status is GoalStatus.SUCCEEDED
        assert arm.refusals == []


@pytest.mark.virtual
@pytest.mark.parametrize("is_open", [True, False])
async def test_nothing_begins_to_move_long_after_its_release_and_the_page_says_so(is_open: bool) -> None:
    """Whoever has let go of a key is not surprised by it later; whether the goal is open, or opens for this press."""
    async with jogged() as arm:
        if is_open:
            await arm.press(SIDE)
            await arm.wait(0.3)
        arm.cell.planner.silent_s = MOST_WAIT_S - 0.1
        await arm.press(UP)
        await arm.wait(0.6)
        assert (arm.gone(UP) >= least(UP), arm.dropped) == (is_open, int(not is_open))
        arm.cell.planner.silent_s = 9.0
        gone, moved = arm.gone(UP), len(arm.moved_s)
        await arm.press(UP)
        await arm.wait(1.1)
        arm.cell.planner.silent_s = 0.0
        await arm.wait(1.0)
        assert (arm.gone(UP), len(arm.moved_s)) == (gone, moved)
        assert arm.dropped == 1 + int(not is_open)


@pytest.mark.virtual
async def test_what_is_said_of_a_dropped_press_does_not_end_the_next() -> None:
    """A refusal would: the page lets go of what it holds."""
    async with jogged() as arm:
        await arm.press(SIDE)
        await arm.wait(0.3)
        arm.cell.planner.silent_s = 0.5
        await arm.press(UP)
        await arm.wait(0.1)
        await arm.jogger.begin(SIDE.jog)
        for _ in range(30):
            await arm.jogger.go(SIDE.velocity)
            await arm.wait(REPEAT_S)
            arm.cell.planner.silent_s = 0.0
        assert (arm.dropped, arm.refusals, arm.jogger.arm) == (1, [], "left")
        assert arm.gone(SIDE) > 0.5 * REPEAT_S * 30 * M_S


@pytest.mark.virtual
async def test_a_page_that_goes_takes_its_unfinished_presses_with_it() -> None:
    """Its connection is cut between the release and the motion."""
    async with jogged() as arm:
        arm.cell.planner.silent_s = 0.2
        await arm.press(UP)
        await arm.wait(0.05)
        await arm.jogger.rest()
        await arm.wait(1.0)
        assert (arm.gone(UP), arm.cell.bus.goals()) == (0.0, ())
