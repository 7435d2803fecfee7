"""The operator and a tree: pause, step, lock, force and repeat, and what holds them does not tick."""

from __future__ import annotations

import pytest

from engine.event import GateReached, NodeEntered
from engine.runtime.control import Breakpoint
from engine.runtime.run import Run
from tests.engine.runtime.control.operate import ObservedRun, operate

HEAD = "flexcell: 1\nname: test\noutcomes: [success, failure]\nsuccess: [success]\nroot:\n  tree:\n"


def _pause(run: Run) -> None:
    run.control.pause()


def _resume(run: Run) -> None:
    run.control.resume()


def _go_on(run: Run) -> None:
    run.control.set_breakpoints([])
    run.control.resume()


def _times(told: ObservedRun, name: str) -> list[float]:
    return [e.time_s for e in told.events if isinstance(e, NodeEntered) and e.path.endswith(name)]


TWO = f"""{HEAD}    sequence:
      - {{state: test.Give, name: first, with: {{after_s: 2}}}}
      - {{state: test.Give, name: second, with: {{after_s: 1}}}}
"""


def test_a_paused_tree_stands_still_and_goes_on() -> None:
    """Its leaves are held, and it is not ticked."""
    told = operate(TWO, {0.5: _pause, 10.5: _resume})
    assert (told.result.outcome, told.result.duration_s) == ("success", pytest.approx(13.0))
    assert _times(told, "/second") == [12.0]


def test_timers_of_decorators_stand_still_in_a_pause() -> None:
    """Three seconds of work are three seconds, however long the pause."""
    text = f"{HEAD}    timeout: {{after: 3 s, child: {{state: test.Give, with: {{after_s: 2}}}}}}\n"
    assert operate(text, {1.0: _pause, 60.0: _resume}).result.outcome == "success"
    text = f"{HEAD}    timeout: {{after: 3 s, child: {{state: test.Hang}}}}\n"
    told = operate(text, {1.0: _pause, 60.0: _resume})
    assert (told.result.outcome, told.result.duration_s) == ("failure", pytest.approx(62.0))


def test_a_step_goes_to_the_next_leaf() -> None:
    """The tree ticks, and the next leaf waits before its entry."""
    told = operate(TWO, {2.0: _pause, 3.0: lambda run: run.control.step(), 20.0: _resume})
    reached = [e.path for e in told.events if isinstance(e, GateReached) and e.point == "before"]
    assert reached[-1:] == ["root/sequence/second"]
    assert told.result.outcome == "success"


def test_a_locked_leaf_holds_the_tree() -> None:
    """It has an outcome that the tree does not see yet."""
    told = operate(
        TWO,
        {
            0.5: lambda run: run.control.lock("root/sequence/first"),
            7.0: lambda run: run.control.unlock("root/sequence/first"),
        },
    )
    assert _times(told, "/second") == [7.0]


def test_a_forced_outcome_of_a_leaf_is_its_status() -> None:
    """The leaf is preempted, and counts as what the operator says."""
    told = operate(TWO, {0.5: lambda run: run.control.force("root/sequence/first", "a")})
    assert (_times(told, "/second"), told.result.outcome) == ([0.5], "success")
    told = operate(TWO, {0.5: lambda run: run.control.force("root/sequence/first", "c")})
    assert (_times(told, "/second"), told.result.outcome) == ([], "failure")


def test_a_forced_outcome_of_the_tree_stops_all_leaves() -> None:
    """Its own outcomes are success and failure."""
    told = operate(TWO, {0.5: lambda run: run.control.force("root", "success")})
    assert (told.result.outcome, told.result.duration_s) == ("success", pytest.approx(0.5))
    assert "-root/sequence/first preempted" in told.lines


def test_a_leaf_is_repeated() -> None:
    """From its beginning; the tree sees only how it ends then."""
    told = operate(TWO, {1.5: lambda run: run.control.repeat("root/sequence/first")})
    assert (_times(told, "/first"), _times(told, "/second")) == ([0.0, 1.5], [3.5])


def test_a_check_that_is_held_in_mid_tick_holds_the_tick() -> None:
    """A breakpoint pauses the run when the check is entered; the motion that it watches is not stopped for that."""
    text = f"""{HEAD}    parallel:
      policy: [sequence]
      children:
        - sequence:
            memory: false
            children: [{{state: test.Give, name: check}}, {{state: test.Use, name: move, with: {{for_s: 4}}}}]
        - {{state: test.Give, name: tick, with: {{after_s: 1}}}}
"""
    stop_here = Breakpoint(path="root/parallel/sequence/check")
    told = operate(
        text,
        {0.5: lambda run: run.control.set_breakpoints([stop_here]), 6.0: _go_on},
    )
    assert "-root/parallel/sequence/move preempted" not in told.lines
    assert (told.result.outcome, told.result.duration_s) == ("success", pytest.approx(9.0))
