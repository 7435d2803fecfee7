"""The engine dies at any event of a run that was stepped back: another goes on, and the end is the same."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping, Sequence

import msgspec
import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.errors import ControlError
from engine.event import Event, GoalFinished, MessageLogged, RunEnded, RunSteppedBack, UndoEnded, UndoStarted
from engine.journal import MemoryRunJournal
from engine.runtime.history.resume import read_history, resume_checkpoint
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.at_once import at_once
from tests.engine.fake_states import WITH_FLOW
from tests.engine.run_document import HEAD
from tests.engine.runtime.control.operate import Act, operate, pause, resume
from tests.engine.runtime.control.slide import MoveSlide, Slid, Slide

STATES = {**WITH_FLOW, "test.MoveSlide": MoveSlide}
TEXT = """
userdata: {steps: 0}
root:
  machine:
    initial: count
    states:
      count: {state: flow.SetValue, with: {value: "${steps + 1}"}, out: {value: steps}, transitions: {done: moves}}
      moves:
        machine:
          initial: out
          states:
            out: {state: test.MoveSlide, with: {to_m: 1}, out: {at_m: first}, transitions: {there: far, failed: no}}
            far: {state: test.MoveSlide, with: {to_m: 2}, out: {at_m: second}, transitions: {there: done, failed: no}}
        transitions: {done: last, no: bad}
      last: {state: test.MoveSlide, with: {to_m: 4}, out: {at_m: third}, transitions: {there: good, failed: bad}}
"""
ACTS: dict[float, Act] = {
    2.5: pause,  # last is on its way
    3.0: lambda run: run.step_back(),
    5.0: lambda run: run.step_back(),
    9.0: lambda run: run.step_back(),
    11.0: resume,
}
END = {"steps": 1}


def _plan() -> Plan:
    return new_plan(parse_behavior(HEAD + TEXT, file="test.yaml"), STATES)


def _whole() -> tuple[Event, ...]:
    told = operate(TEXT, ACTS, prepare=Slide, states=STATES)
    assert (told.result.outcome, told.result.userdata) == ("good", END)
    assert sum(isinstance(event, RunSteppedBack) for event in told.events) == 3
    return told.events


WHOLE = _whole()


def _go_on(events: Sequence[Event], *, back: bool) -> tuple[RunResult, Slide, Mapping[str, object], Sequence[Event]]:
    """Resume a run that has these events; with `back` it is taken back to its beginning first."""
    plan = _plan()

    async def main() -> tuple[RunResult, Slide, Mapping[str, object], Sequence[Event]]:
        checkpoint = resume_checkpoint(read_history(plan, "r1", events), plan, answers={}, last_seq=events[-1].seq)
        journal = MemoryRunJournal(run_id="r1", kept=list(events))
        async with SkillBus(new_clock()) as bus:
            slide = Slide(bus, at_m=_place_of(events))
            run = Run(plan, run="r1", bus=bus, journal=journal, checkpoint=checkpoint)
            loop = asyncio.get_running_loop()
            if back:
                run.control.pause()
                for number in range(5):
                    loop.call_at(1.0 + 10.0 * number, _try_back, run)
            loop.call_at(100.0, run.control.resume)
            result = await run.execute()
            history = read_history(plan, "r1", journal.kept)
            return result, slide, history.userdata(), journal.kept

    return run_virtual(main())


def _place_of(events: Sequence[Event]) -> float:
    """Return where the slide was when the engine died; one that was on its way came to rest where it had begun."""
    ends = [event.result for event in events if isinstance(event, GoalFinished) and event.result is not None]
    return msgspec.convert(ends[-1], Slid).end_m if ends else 0.0


def _try_back(run: Run) -> None:
    try:
        at_once(run.step_back())
    except ControlError:
        return


CUTS = range(2, len(WHOLE))


@pytest.mark.parametrize("back", [False, True], ids=["on", "back to the beginning and on"])
def test_a_run_with_steps_back_goes_on_after_any_of_its_events(back: bool) -> None:
    for cut in CUTS:
        result, slide, userdata, events = _go_on(WHOLE[:cut], back=back)
        assert (result.status, result.outcome) == ("finished", "good"), cut
        assert (result.userdata, userdata) == (END, END), cut
        assert slide.at_m == 4.0, cut
        assert [event.seq for event in events] == list(range(1, len(events) + 1)), cut
        assert isinstance(events[-1], RunEnded)


def test_a_crash_in_the_middle_of_an_undo_begins_paused_and_says_so() -> None:
    begun = next(place for place, event in enumerate(WHOLE) if isinstance(event, UndoStarted))
    ended = next(place for place, event in enumerate(WHOLE) if isinstance(event, UndoEnded))
    for cut in range(begun + 1, ended + 2):
        result, _, _, events = _go_on(WHOLE[:cut], back=False)
        said = [event.message for event in events[cut:] if isinstance(event, MessageLogged)]
        message = "the engine died while a step back was undoing this state; the run starts paused: step back again"
        assert said == [message]
        # What was before the crash counts, and the operator lets it wait for 100 s.
        assert result.duration_s == events[-1].time_s
        assert result.duration_s >= WHOLE[cut - 1].time_s + 100.0
