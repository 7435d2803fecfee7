"""The switch of a magnet: its field comes and goes, and is never left half-way."""

from __future__ import annotations

import pytest

from robots.control.motion_event import AnyMotionEvent, MotionFinished, MotionHeld, MotionResumed
from robots.magnet.magnet_drive import MagnetCommand, MagnetDrive
from robots.port import MotionEnd

STEP_S = 0.001


def run(switch: MagnetDrive, steps: int, *, still: bool = True) -> list[AnyMotionEvent]:
    return [event for _ in range(steps) for event in switch.step(STEP_S, still=still)]


def end_of(events: list[AnyMotionEvent]) -> MotionEnd:
    (event,) = events
    assert isinstance(event, MotionFinished)
    return event.report.end


def test_the_field_is_up_after_its_time_and_down_again() -> None:
    switch = MagnetDrive(switch_s=0.2)
    switch.switch(1, on=True)
    assert run(switch, 195) == []
    assert 0.9 < switch.level < 1.0
    assert (end_of(run(switch, 100)), switch.level) == (MotionEnd.REACHED, 1.0)
    switch.switch(2, on=False)
    assert (end_of(run(switch, 300)), switch.level) == (MotionEnd.REACHED, 0.0)


def test_it_is_not_over_while_a_part_still_moves() -> None:
    switch = MagnetDrive(switch_s=0.1)
    switch.switch(1, on=True)
    assert run(switch, 1000, still=False) == []
    assert end_of(run(switch, 100)) == MotionEnd.REACHED


@pytest.mark.parametrize("on", [True, False])
def test_a_cancelled_switch_is_carried_through(on: bool) -> None:
    switch = MagnetDrive(switch_s=0.2)
    switch.take_over(MagnetCommand(on=not on, level=0.0 if on else 1.0))
    switch.switch(1, on=on)
    run(switch, 100)
    switch.cancel(1)
    assert end_of(run(switch, 300)) == MotionEnd.CANCELED
    assert (switch.on, switch.level) == (on, 1.0 if on else 0.0)


def test_a_held_switch_tells_its_end_only_once_resumed() -> None:
    switch = MagnetDrive(switch_s=0.1)
    switch.switch(1, on=True)
    switch.hold(1, request=1)
    assert run(switch, 1000) == [MotionHeld(motion=1, request=1)]
    switch.resume(1, request=2)
    resumed, finished = run(switch, 300)
    assert resumed == MotionResumed(motion=1, request=2)
    assert end_of([finished]) == MotionEnd.REACHED


def test_what_pulls_at_a_part_that_never_rests_fails_in_words() -> None:
    switch = MagnetDrive(switch_s=0.1)
    switch.switch(1, on=True)
    (event,) = run(switch, 3000, still=False)
    assert isinstance(event, MotionFinished)
    assert (event.report.end, "did not come to rest" in event.report.reason) == (MotionEnd.FAILED, True)


def test_another_life_of_the_switch_goes_on_as_it_was() -> None:
    before, after = MagnetDrive(switch_s=0.1), MagnetDrive(switch_s=0.1)
    before.switch(1, on=True)
    run(before, 300)
    after.take_over(before.command)
    assert (run(after, 200), after.on, after.level, after.number) == ([], True, 1.0, 0)
