"""One step back of a paused run undoes what began last and stands before its entry, or says why not."""

from __future__ import annotations

from collections import Counter
from collections.abc import Awaitable, Callable, Mapping

import pytest

from engine.bus import SkillBus
from engine.errors import FlexcellError
from engine.event import (
    NodeEntered,
    NodeExited,
    OperatorCommanded,
    PauseConfirmed,
    RunSteppedBack,
    UndoEnded,
    UndoStarted,
    UserdataWritten,
)
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions
from tests.engine.at_once import at_once
from tests.engine.fake_states import WITH_FLOW
from tests.engine.run_document import ObservedRun
from tests.engine.runtime.control.operate import Act, operate, pause, resume
from tests.engine.runtime.control.slide import MoveSlide, PushSlide, Slide

STATES = {**WITH_FLOW, "test.MoveSlide": MoveSlide, "test.PushSlide": PushSlide}
TWO = """
root:
  machine:
    initial: one
    states:
      one: {state: test.MoveSlide, with: {to_m: 1}, transitions: {there: two, failed: bad}}
      two: {state: test.MoveSlide, with: {to_m: 3}, transitions: {there: good, failed: bad}}
"""


class Operator:
    """Orders steps back and notes what the run says, and where it stands afterwards."""

    def __init__(self) -> None:
        self.said: list[str] = []
        self.slide: Slide | None = None

    def connect(self, bus: SkillBus) -> None:
        self.slide = Slide(bus)

    def back(self, path: str = "") -> Callable[[Run], Awaitable[None]]:
        async def order(run: Run) -> None:
            try:
                undone = await run.step_back(path)
                self.said.append(f"undoes {', '.join(undone)}" if undone else "undoes nothing")
            except FlexcellError as error:
                self.said.append(f"refused: {error}")

        return order

    def look(self, run: Run) -> None:
        view = run.control.view()
        at = f"{self.slide.at_m:g} m" if self.slide is not None else ""
        rest = "rests" if view.confirmed else "moves"
        self.said.append(" ".join([*(f"{each.point} {each.path}" for each in view.waiting), rest, at]))

    def run(
        self,
        text: str,
        acts: Mapping[float, Act],
        *,
        inputs: Mapping[str, object] | None = None,
        supervision: RunOptions | None = None,
    ) -> ObservedRun:
        return operate(text, acts, prepare=self.connect, states=STATES, inputs=inputs, supervision=supervision)


def test_a_node_in_mid_work_gives_up_and_is_undone_and_then_the_one_before_it() -> None:
    operator = Operator()
    told = operator.run(
        TWO,
        {
            2.0: pause,  # in the middle of two, at 2 m
            3.0: operator.back(),
            5.0: operator.look,
            6.0: operator.back(),
            8.0: operator.look,
            9.0: resume,
        },
    )
    assert operator.said == [
        "undoes root/two",
        "before root/two rests 1 m",
        "undoes root/one",
        "before root/one rests 0 m",
    ]
    assert told.result.outcome == "good"
    assert told.result.duration_s == pytest.approx(9.0 + 3.0)
    assert operator.slide is not None
    assert operator.slide.goals == [1.0, 3.0, 1.0, 0.0, 1.0, 3.0]
    undone = [(e.path, e.undoes) for e in told.events if isinstance(e, UndoEnded)]
    assert undone == [("root/two", 1), ("root/one", 1)]
    ordered = [e.path for e in told.events if isinstance(e, OperatorCommanded) and e.command == "step_back"]
    assert ordered == ["root/two", "root/two"]
    assert [(e.source, e.path) for e in told.events if isinstance(e, RunSteppedBack)] == [
        ("root/two", "root/two"),
        ("root/two", "root/one"),
    ]


def test_at_the_beginning_there_is_nothing_to_take_back() -> None:
    operator = Operator()
    told = operator.run(TWO, {1.0: operator.back(), 4.0: resume}, supervision=RunOptions(start_paused=True))
    assert operator.said == ["refused: root: the run is at its beginning (there is nothing to undo)"]
    assert told.result.outcome == "good"


def test_a_run_that_is_not_paused_is_left_alone() -> None:
    operator = Operator()
    operator.run(TWO, {0.5: operator.back()})
    assert operator.said == ["refused: the run is not paused (pause it first, or set a breakpoint)"]


def test_a_state_without_undo_refuses_and_nothing_moves() -> None:
    operator = Operator()
    text = TWO.replace(
        "test.MoveSlide, with: {to_m: 1}, transitions: {there: two, failed: bad}",
        "test.PushSlide, transitions: {there: two}",
    )
    told = operator.run(text, {2.0: pause, 3.0: operator.back(), 5.0: operator.back(), 6.0: operator.look, 7.0: resume})
    assert operator.said[0] == "undoes root/two"
    assert operator.said[1].startswith(
        "refused: root/one: cannot step back over visit 1: test.PushSlide does not declare how to undo what it did"
    )
    assert operator.said[2] == "before root/two rests 1 m"
    assert told.result.outcome == "good"


def test_what_was_written_is_taken_back_and_what_was_there_before_is_there_again() -> None:
    text = """
    userdata: {count: 7}
    root:
      machine:
        initial: one
        states:
          one: {state: flow.SetValue, with: {value: 8}, out: {value: count}, transitions: {done: two}}
          two: {state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: more}, transitions: {done: three}}
          three: {state: flow.Wait, with: {duration_s: 5}, transitions: {done: good}}
    """
    operator = Operator()
    seen: list[Mapping[str, object]] = []

    def note(event: object) -> None:
        if isinstance(event, RunSteppedBack):
            seen.append({each.key: each.value if each.defined else None for each in event.values})

    told = operator.run(
        text,
        {
            0.0: lambda run: run.watch(note),
            1.0: pause,
            2.0: operator.back(),
            3.0: operator.back(),
            4.0: operator.back(),
            5.0: operator.look,
            6.0: resume,
        },
    )
    assert operator.said == ["undoes root/three", "undoes root/two", "undoes root/one", "before root/one rests 0 m"]
    assert seen == [{}, {"more": None}, {"count": 7}]
    assert told.result.userdata == {"count": 8}
    written = [(each.key, each.value) for each in told.events if isinstance(each, UserdataWritten)]
    assert written == [("count", 8), ("more", 9), ("count", 8), ("more", 9)]


def test_a_container_is_undone_child_by_child_in_reverse_order() -> None:
    text = """
    root:
      machine:
        initial: first
        states:
          first:
            machine:
              initial: one
              states:
                one: {state: test.MoveSlide, with: {to_m: 1}, transitions: {there: two, failed: out}}
                two: {state: test.MoveSlide, with: {to_m: 3}, transitions: {there: out, failed: out}}
            transitions: {out: last}
          last: {state: flow.Wait, with: {duration_s: 5}, transitions: {done: good}}
    """
    operator = Operator()
    told = operator.run(
        text, {4.0: pause, 5.0: operator.back(), 6.0: operator.back(), 12.0: operator.look, 13.0: resume}
    )
    assert operator.said == [
        "undoes root/last",
        "undoes root/first/two, root/first/one",
        "before root/first rests 0 m",
    ]
    assert told.result.outcome == "good"


def test_inside_a_container_the_step_back_goes_over_its_entry() -> None:
    text = """
    root:
      machine:
        initial: first
        states:
          first: {state: test.MoveSlide, with: {to_m: 1}, transitions: {there: inner, failed: bad}}
          inner:
            machine:
              initial: one
              states:
                one: {state: test.MoveSlide, with: {to_m: 3}, transitions: {there: out, failed: out}}
            transitions: {out: good}
    """
    operator = Operator()
    told = operator.run(text, {2.0: pause, 3.0: operator.back(), 5.0: operator.back(), 8.0: operator.look, 9.0: resume})
    assert operator.said == ["undoes root/inner/one", "undoes root/first", "before root/first rests 0 m"]
    assert told.result.outcome == "good"
    assert told.lines.count("+root/inner") == 2


BOTH = """
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            left:
              machine:
                initial: one
                states:
                  one: {state: test.MoveSlide, with: {to_m: 1}, transitions: {there: two, failed: out}}
                  two: {state: test.MoveSlide, with: {to_m: 4}, transitions: {there: out, failed: out}}
            right:
              machine:
                initial: wait
                states:
                  wait: {state: flow.Wait, with: {duration_s: 1.5}, transitions: {done: then}}
                  then: {state: flow.Wait, with: {duration_s: 10}, transitions: {done: out}}
          conditions: [{fine: {left: out, right: out}}]
        transitions: {fine: good}
"""


def test_the_branch_that_began_something_last_goes_back_first_or_the_one_that_is_named() -> None:
    operator = Operator()
    told = operator.run(
        BOTH,
        {
            2.0: pause,
            3.0: operator.back(),
            4.0: operator.back("root/both/left"),
            7.0: operator.look,
            8.0: operator.back(),
            9.0: operator.back("root/both/left"),
            12.0: operator.back(),
            13.0: operator.back(),
            14.0: operator.look,
            15.0: resume,
        },
    )
    assert operator.said == [
        "undoes root/both/right/then",
        "undoes root/both/left/two",
        "before root/both/right/then before root/both/left/two rests 1 m",
        "undoes root/both/right/wait",
        "undoes root/both/left/one",
        "refused: root/both/right/wait: the run is at its beginning (there is nothing to undo)",
        "refused: root/both/right/wait: the run is at its beginning (there is nothing to undo)",
        "before root/both/right/wait before root/both/left/one rests 0 m",
    ]
    assert told.result.outcome == "good"


def test_one_branch_does_not_go_back_over_the_entry_of_its_container_alone() -> None:
    operator = Operator()
    operator.run(
        BOTH, {1.25: pause, 2.0: operator.back("root/both/right"), 3.0: operator.back("root/both/right"), 9.0: resume}
    )
    assert operator.said[0] == "undoes root/both/right/wait"
    assert operator.said[1] == (
        "refused: root/both: root/both/right is at its beginning, and the parallel branch root/both/left has begun"
        " (step root/both/left back first)"
    )


def test_an_undo_that_fails_is_reported_and_the_run_stands_where_it_was() -> None:
    operator = Operator()

    def jam(run: Run) -> None:
        assert operator.slide is not None
        operator.slide.jams = {0.0}

    told = operator.run(
        TWO, {0.0: jam, 2.0: pause, 3.0: operator.back(), 5.0: operator.back(), 7.0: operator.look, 8.0: resume}
    )
    assert operator.said == ["undoes root/two", "undoes root/one", "before root/two rests 1 m"]
    failed = [e for e in told.events if isinstance(e, RunSteppedBack) and e.cause is not None]
    assert [e.path for e in failed] == ["root/two"]
    lines = [line for line in told.lines if "the step back failed" in line]
    assert lines == ["!root/one the step back failed: root/one: the slide did not get back to 0 m"]
    assert told.result.outcome == "good"


def test_a_pause_holds_an_undo_and_a_resume_lets_it_end_paused() -> None:
    operator = Operator()
    told = operator.run(
        TWO,
        {
            2.0: pause,
            3.0: operator.back(),
            3.25: pause,
            6.0: operator.look,
            7.0: resume,
            9.0: operator.look,
            10.0: resume,
        },
    )
    assert operator.said == ["undoes root/two", "rests 1.75 m", "before root/two rests 1 m"]
    assert told.result.outcome == "good"


def test_orders_for_what_is_being_undone_are_refused_and_a_stop_ends_it() -> None:
    operator = Operator()
    said: list[str] = []

    def order(run: Run) -> None:
        for act in (lambda: run.control.force("root/two", "there"), run.control.step):
            with pytest.raises(FlexcellError) as refused:
                act()
            said.append(str(refused.value))

    told = operator.run(
        TWO, {2.0: pause, 3.0: operator.back(), 3.25: order, 3.5: operator.back(), 3.75: lambda run: run.stop("enough")}
    )
    assert said == ["root/two: this node is being undone (wait until the run is at rest, or stop it)"] * 2
    assert operator.said[1].startswith("refused: root/two: this node is being undone")
    assert told.result.status == "stopped"
    assert [e.preempted for e in told.events if isinstance(e, UndoEnded)] == [True]
    assert not [e for e in told.events if isinstance(e, RunSteppedBack)]
    assert operator.slide is not None
    assert 1.0 < operator.slide.at_m < 2.0


def test_while_a_node_cleans_up_for_an_order_nothing_is_stepped_back() -> None:
    operator = Operator()

    async def force_and_step_back(run: Run) -> None:
        run.control.force("root/two", "failed")
        await operator.back()(run)

    told = operator.run(TWO, {2.0: pause, 3.0: force_and_step_back, 7.0: resume})
    assert operator.said == ["refused: the run is executing another command (wait until it is at rest)"]
    assert told.result.outcome == "bad"


def test_a_branch_with_priority_holds_no_undo_in_another() -> None:
    text = """
    root:
      concurrency:
        states:
          low:
            machine:
              initial: one
              states:
                one: {state: test.MoveSlide, transitions: {there: rest, failed: out}}
                rest: {state: flow.Wait, with: {duration_s: 30}, transitions: {done: out}}
          high:
            machine:
              initial: first
              states:
                first: {state: flow.Wait, with: {duration_s: 2}, transitions: {done: urgent}}
                urgent:
                  priority:
                    initial: last
                    states:
                      last: {state: flow.Wait, with: {duration_s: 20}, transitions: {done: out}}
                  transitions: {out: out}
        conditions: [{good: {low: out, high: out}}]
    """
    operator = Operator()
    back = operator.back("root/low")
    told = operator.run(text, {3.0: pause, 4.0: back, 6.0: back, 10.0: operator.look, 11.0: resume})
    assert operator.said == ["undoes root/low/rest", "undoes root/low/one", "before root/low/one rests 0 m"]
    assert told.result.outcome == "good"


def test_a_behavior_tree_and_all_rounds_of_a_loop_are_taken_back_as_one() -> None:
    text = """
    root:
      machine:
        initial: grow
        states:
          grow:
            foreach: {items: [1, 2], as: to, child: {state: test.MoveSlide, with: {to_m: "${to}"}}, next: [there]}
            transitions: {exhausted: tree, broken: bad}
          tree:
            tree:
              sequence:
                memory: true
                children:
                  - {name: out, state: test.MoveSlide, with: {to_m: 3}}
                  - {name: far, state: test.MoveSlide, with: {to_m: 5}}
            transitions: {success: good, failure: bad}
    """
    operator = Operator()
    told = operator.run(
        text,
        {4.0: pause, 5.0: operator.back(), 8.0: operator.look, 9.0: operator.back(), 12.0: operator.look, 13.0: resume},
    )
    assert operator.said == [
        "undoes root/tree/sequence/far, root/tree/sequence/out",
        "before root/tree rests 2 m",
        "undoes root/grow/child, root/grow/child",
        "before root/grow rests 0 m",
    ]
    assert told.result.outcome == "good"


def test_every_activation_is_entered_and_left_once_and_an_undo_has_a_number_of_its_own() -> None:
    operator = Operator()
    told = operator.run(TWO, {2.0: pause, 3.0: operator.back(), 6.0: operator.back(), 9.0: resume})
    entered = Counter((e.path, e.visit) for e in told.events if isinstance(e, NodeEntered))
    assert entered == Counter((e.path, e.visit) for e in told.events if isinstance(e, NodeExited))
    undone = {(e.path, e.visit) for e in told.events if isinstance(e, UndoStarted)}
    assert undone
    assert not undone & set(entered)


def test_a_pause_is_confirmed_once_the_undoing_is_done_and_not_before() -> None:
    operator = Operator()
    told = operator.run(TWO, {2.0: pause, 3.0: operator.back(), 3.25: operator.look, 6.0: resume})
    assert operator.said == ["undoes root/two", "moves 1.75 m"]
    confirmed = [e.time_s for e in told.events if isinstance(e, PauseConfirmed)]
    stepped = [e.time_s for e in told.events if isinstance(e, RunSteppedBack)]
    assert confirmed == [2.0, *stepped]


def test_an_order_for_a_container_around_takes_the_place_of_a_step_back() -> None:
    text = """
    root:
      machine:
        initial: inner
        states:
          inner:
            machine:
              initial: one
              states:
                one: {state: test.MoveSlide, with: {to_m: 3}, transitions: {there: out, failed: out}}
            transitions: {out: last}
          last: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: good}}
    """
    operator = Operator()

    def leave(run: Run) -> None:
        at_once(run.step_back())
        run.control.force("root/inner", "out")

    told = operator.run(
        text, {1.0625: pause, 2.0: leave, 3.0: operator.look, 4.0: operator.back(), 6.0: operator.look, 7.0: resume}
    )
    assert operator.said == [
        "before root/last rests 1 m",
        "undoes root/inner/one",
        "before root/inner rests 0 m",
    ]
    assert told.result.outcome == "good"
