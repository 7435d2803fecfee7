"""Behaviours of py_trees' kind as leaves: ticked while RUNNING, contained, and isolated between runs."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Iterator

import pytest
from py_trees.blackboard import Blackboard

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.errors import DocumentError
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.runtime.tree.foreign_behaviours import CALLS
from tests.engine.runtime.tree.run_tree import run_tree, tree_plan

HERE = "tests.engine.runtime.tree.foreign_behaviours"


@pytest.fixture(autouse=True)
def _calls() -> Iterator[None]:
    CALLS.clear()
    Blackboard.clear()
    yield
    CALLS.clear()
    Blackboard.clear()


def _scripted(name: str, **arguments: object) -> str:
    return json.dumps({"behaviour": f"{HERE}:Scripted", "name": name, "with": arguments})


def test_py_trees_own_behaviours_are_leaves() -> None:
    """Their status is theirs; text becomes the status that the constructor wants."""
    assert run_tree("behaviour: py_trees.behaviours:Success").result.outcome == "success"
    told = run_tree("""
        behaviour: py_trees.behaviours:TickCounter
        with: {duration: 4, completion_status: FAILURE}
    """)
    assert (told.result.outcome, told.result.duration_s) == ("failure", pytest.approx(0.4))
    assert told.statuses == ["0 TickCounter running", "0.4 TickCounter failure"]


def test_every_says_how_often_a_running_one_is_ticked() -> None:
    """Nothing else would wake it."""
    told = run_tree("""
        behaviour: py_trees.behaviours:TickCounter
        with: {duration: 4, completion_status: SUCCESS}
        every: 2 s
    """)
    assert told.result.duration_s == pytest.approx(8.0)


def test_its_methods_are_called_as_py_trees_calls_them() -> None:
    """Set up before the first tick, shut down when the tree has ended."""
    run_tree(f"sequence: [{_scripted('a', ticks=1)}, {_scripted('b', ticks=0)}]")
    assert CALLS == [
        "a constructor", "b constructor", "a setup", "b setup",
        "a initialise", "a update", "a update", "a terminate SUCCESS",
        "b initialise", "b update", "b terminate SUCCESS",
        "a shutdown", "b shutdown",
    ]  # fmt: skip


def test_a_stop_terminates_it_once() -> None:
    """As does being halted by the tree."""
    run_tree(_scripted("a"), stop_at_s=1.0)
    assert [call for call in CALLS if "terminate" in call] == ["a terminate INVALID"]


@pytest.mark.parametrize("method", ["initialise", "update", "terminate"])
def test_what_it_raises_is_an_error_that_names_it_and_leaves_nobody_running(method: str) -> None:
    """py_trees leaves siblings RUNNING after an exception, and may terminate a behaviour twice."""
    told = run_tree(f"""
        parallel:
          - {_scripted("before")}
          - {{state: test.Hang, with: {{cleanup_s: 1}}}}
          - {_scripted("bad", ticks=1 if method != "terminate" else 0, raises=method)}
          - {_scripted("after")}
    """)
    assert told.result.status == "errored"
    assert told.why[:2] == [
        f"{method} of root/parallel/bad (Scripted) raised ZeroDivisionError: in {method}", f"in {method}",
    ]  # fmt: skip
    terminated = [call for call in CALLS if "terminate " in call]
    assert len(terminated) == len(set(terminated))
    assert "before terminate INVALID" in terminated
    initialised = {call.split()[0] for call in CALLS if call.endswith("initialise")} - {"bad"}
    assert {call.split()[0] for call in terminated} - {"bad"} == initialised
    assert [line for line in told.lines if "Hang" in line] in (
        [], ["0 +parallel/Hang", "1 !parallel/Hang cleaned up", "1 -parallel/Hang preempted"],
    )  # fmt: skip
    assert {line.split()[1]: line.split()[2] for line in told.statuses if line.startswith("0")}.items() <= {
        ("parallel/before", "invalid"), ("parallel/bad", "invalid"), ("parallel/after", "invalid"),
        ("parallel", "invalid"),
    }  # fmt: skip


def test_a_constructor_that_raises_is_an_error_that_names_it() -> None:
    """Nothing was begun then."""
    told = run_tree(f"sequence: [{{state: test.Check}}, {_scripted('bad', raises='constructor')}]")
    assert told.why[0] == "constructor of root/sequence/bad (Scripted) raised ZeroDivisionError: in constructor"
    assert told.lines == []


def test_a_shutdown_that_raises_is_reported_and_changes_nothing() -> None:
    """The tree has ended by then."""
    told = run_tree(_scripted("a", ticks=0, raises="shutdown"))
    assert told.result.outcome == "success"
    (line,) = told.lines
    assert line.startswith("0 !root clean-up failed: ")
    assert "test.yaml:7:3: shutdown of root/a (Scripted) raised ZeroDivisionError" in line


def test_a_retry_takes_its_exceptions_too() -> None:
    """They are errors of the tree like those of states."""
    run_tree(f"retry: {{times: 2, child: {_scripted('bad', raises='update')}}}")
    assert [call for call in CALLS if "terminate" in call] == ["bad terminate INVALID"] * 3


def test_what_is_no_status_is_an_error() -> None:
    """py_trees would take it for INVALID and go on."""
    told = run_tree(f"behaviour: {HERE}:Lost")
    assert told.why[0].startswith("update of root/Lost (Lost) returned None")


def test_a_composite_class_brings_its_own_children() -> None:
    """They are ticked with it, and seen as one part."""
    told = run_tree(f"behaviour: {HERE}:Pair")
    assert told.statuses == ["0 Pair running", "0.1 Pair success"]
    assert CALLS[-4:-2] == ["second update", "second terminate SUCCESS"]


def test_it_begins_only_after_what_was_halted_is_at_rest() -> None:
    """Its `initialise` may move a device."""
    told = run_tree(f"""
        selector:
          - timeout: {{after: 1 s, child: {{state: test.Hang, with: {{cleanup_s: 2}}}}}}
          - {_scripted("next", ticks=0)}
    """)
    assert told.statuses[-2:] == ["3 selector/next success", "3 selector success"]


def test_userdata_is_shown_on_its_blackboard_and_written_back() -> None:
    """`in` and `out` name blackboard keys."""
    told = run_tree(
        f"sequence: [{{behaviour: '{HERE}:Double', in: {{x: width}}, out: {{y: twice}}}}, "
        "{guard: {when: '${twice == 42}', child: {state: test.Check}}}]",
        head="userdata: {width: 21, twice: 0}",
    )
    assert (told.result.outcome, told.result.userdata) == ("success", {"width": 21, "twice": 42})


async def _run_counter(bus: SkillBus, run: str, limit: int) -> RunResult:
    plan = tree_plan(f"{{behaviour: '{HERE}:Counter', with: {{limit: {limit}}}}}")
    return await Run(plan, run=run, bus=bus).execute()


@pytest.mark.virtual
async def test_two_runs_at_once_do_not_share_a_blackboard() -> None:
    """Each counts for itself, though py_trees keeps one blackboard for the whole process."""
    Blackboard.set("/shared/count", 1000)
    bus = SkillBus(new_clock())
    results = await asyncio.gather(_run_counter(bus, "a", 5), _run_counter(bus, "b", 9))
    assert [round(result.duration_s, 3) for result in results] == [0.4, 0.8]
    assert (Blackboard.storage, Blackboard.clients) == ({"/shared/count": 1000}, {})


def test_nothing_stays_on_the_common_blackboard() -> None:
    """Neither keys nor clients."""
    run_tree(f"{{behaviour: '{HERE}:Counter', with: {{limit: 3}}}}")
    assert (Blackboard.storage, Blackboard.metadata, Blackboard.clients) == ({}, {}, {})


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        (f"behaviour: {HERE}:Missing", "has no `Missing`"),
        ("behaviour: nowhere.at.all:Thing", "does not allow documents to name the module `nowhere.at.all`"),
        ("behaviour: json:loads", "does not allow documents to name the module `json`"),
        (f"behaviour: {HERE}:CALLS", "is not a concrete py_trees behaviour"),
        (f"behaviour: {HERE}:Abstract", "is not a concrete py_trees behaviour"),
        (f"{{behaviour: '{HERE}:Counter', with: {{limits: 3}}}}", "Counter takes no argument `limits`"),
        (f"behaviour: {HERE}:Counter", "Counter needs the argument `limit`"),
        ("{inverter: {child: {state: test.Check}}, every: 1}", "`every` goes with a check or a `behaviour`"),
    ],
)
def test_what_cannot_be_made_is_refused_before_the_run(tree: str, message: str) -> None:
    """With the position in the document."""
    with pytest.raises(DocumentError) as refused:
        tree_plan(tree)
    assert message in refused.value.message
    assert str(refused.value).startswith(("test.yaml:7:", "test.yaml:8:", "test.yaml:9:"))


def test_an_argument_that_does_not_fit_is_an_error_that_names_it() -> None:
    """Before the constructor is called."""
    told = run_tree("behaviour: py_trees.behaviours:TickCounter\nwith: {duration: long, completion_status: SUCCESS}")
    assert told.why[0].startswith("argument `duration` of TickCounter: expected integer, got text")
