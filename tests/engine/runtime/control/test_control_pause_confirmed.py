"""A pause is confirmed whoever has made it, and not while a step is under way."""

from __future__ import annotations

from engine.event import PauseConfirmed
from engine.runtime.control import Breakpoint
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from tests.engine.runtime.control.operate import operate

TEXT = """
root:
  machine:
    initial: one
    states:
      one: {state: test.Give, with: {after_s: 2}, transitions: {a: two, b: two, c: bad}}
      two: {state: test.Give, with: {after_s: 2}, transitions: {a: good, b: good, c: bad}}
"""


def test_a_breakpoint_and_the_end_of_a_step_are_confirmed() -> None:
    seen: list[tuple[bool, bool]] = []

    def look(run: Run) -> None:
        view = run.control.view()
        seen.append((view.paused, view.confirmed))

    told = operate(
        TEXT,
        {
            1.0: look,
            2.0: lambda run: run.control.step(),
            3.0: look,
            4.5: look,
            5.0: lambda run: run.control.resume(),
            6.0: look,
        },
        supervision=RunOptions(breakpoints=(Breakpoint(path="root/one"),)),
    )
    assert told.result.outcome == "good"
    assert seen == [(True, True), (True, False), (True, True), (False, False)]
    assert [event.time_s for event in told.events if isinstance(event, PauseConfirmed)] == [0.0, 4.0]
