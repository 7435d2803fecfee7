"""One reducer tells the events about nodes apart; every view of a run asks its state, its changes and its words."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = ("engine", "states", "robots", "editor_web")
NODE_EVENTS = frozenset(
    {
        "BranchesPreempted",
        "GatePassed",
        "GateReached",
        "NodeDiverted",
        "NodeEntered",
        "NodeExited",
        "NodeRetried",
        "RunSteppedBack",
        "StatusChanged",
        "TransitionTaken",
        "UndoEnded",
        "UndoStarted",
        "UserdataAppended",
        "UserdataWritten",
    }
)
"""The events that say what happens in a node: the state of a run is made of them."""
REDUCER = "engine/runtime/history/run_state_part.py"
WORDS = "engine/runtime/history/event_texts.py"
EXCEPTIONS = {
    "engine/archive/run_comparison.py": "finds the values that visits read and wrote, to compare two runs; no state",
    "engine/replay/entry_schedule.py": "finds the instants of entries in a recording, to repeat them; no state",
    "engine/replay/recorded_requests.py": "finds the requests of a recording and which were cancelled; no state",
    "engine/runtime/history/resumable_state.py": "a part of the reducer; whether a write assigns or appends",
    "engine/runtime/history/run_reducer.py": "the reducer itself; it skips the frequent events that change no node",
    "engine/runtime/history/undo_log.py": "a part of the reducer; whether a write assigns or appends",
    "engine/runtime/tree/reactive_checks.py": "executes: a check of a tree is repeated after a write",
    "engine/runtime/tree/runner.py": "executes: a tree is ticked after a write",
    "engine/runtime/userdata/append_only_lists.py": "the value of a key after a write, for every part of the reducer",
}
"""What else looks at the class of such an event, and why."""

REDUCERS = {
    "editor_web/past/state_history.py": "a run at any instant; keeps copies",
    "engine/archive/run_alignment.py": "the visits of a past run, read once",
    "engine/cli/output/progress_printer.py": "a run in a terminal",
    "engine/coverage/coverage_counter.py": "many runs, each read once",
    "engine/runtime/history/live_run.py": "the runs of a session",
    "engine/runtime/history/resumable_state.py": "a run that is resumed",
    "engine/runtime/history/run_reducer.py": "copies, and the instant to which a resume returns",
}
"""Who reduces the events of a run; every other view reads the state of one of these."""


def _matched(tree: ast.Module) -> Iterator[str]:
    """Yield the names of classes in `isinstance`, in `match` and in comparisons of `type(…)`."""
    for node in ast.walk(tree):
        match node:
            case ast.MatchClass(cls=ast.Name(id=name)):
                yield name
            case ast.Call(func=ast.Name(id="isinstance" | "issubclass"), args=[_, kinds]):
                yield from (each.id for each in ast.walk(kinds) if isinstance(each, ast.Name))
            case ast.Compare(comparators=others):
                yield from (each.id for other in others for each in ast.walk(other) if isinstance(each, ast.Name))
            case ast.Tuple(elts=entries) | ast.Set(elts=entries):
                yield from (each.id for each in entries if isinstance(each, ast.Name))
            case ast.Dict(keys=keys):
                yield from (each.id for each in keys if isinstance(each, ast.Name))
            case _:
                pass


def _code(path: Path) -> str:
    """The text without the definition of the reducer itself."""
    return path.read_text(encoding="utf-8").replace("class RunReducer(", "")


def _interpreters() -> dict[str, set[str]]:
    """Return the node events that each file tells apart."""
    found: dict[str, set[str]] = {}
    for package in PACKAGES:
        for path in sorted((ROOT / package).rglob("*.py")):
            if "node_modules" in path.parts:
                continue
            text = path.read_text(encoding="utf-8")
            names = set(NODE_EVENTS & set(_matched(ast.parse(text)))) if "engine.event" in text else set[str]()
            if names:
                found[path.relative_to(ROOT).as_posix()] = names
    return found


def test_the_events_of_a_run_are_reduced_where_its_state_is_kept() -> None:
    """A view that reduced them again would cost every event twice."""
    makers = [
        path.relative_to(ROOT).as_posix()
        for package in PACKAGES
        for path in sorted((ROOT / package).rglob("*.py"))
        if "node_modules" not in path.parts and re.search(r"\bRunReducer\(", _code(path))
    ]
    assert sorted(makers) == sorted(REDUCERS)


def test_only_the_reducer_and_the_words_distinguish_node_events() -> None:
    """A second fold would come to disagree with the first."""
    found = _interpreters()
    assert found.pop(REDUCER) == NODE_EVENTS
    assert found.pop(WORDS) == NODE_EVENTS
    assert sorted(found) == sorted(EXCEPTIONS), "ask the state of the run, or its changes"


@pytest.mark.parametrize(
    ("text", "names"),
    [
        ("isinstance(event, NodeEntered | NodeExited)", {"NodeEntered", "NodeExited"}),
        ("match event:\n    case NodeExited(cause=None): pass", {"NodeExited"}),
        ("type(event) is NodeExited", {"NodeExited"}),
        ("MARKED = (NodeExited, GateReached)", {"NodeExited", "GateReached"}),
        ("MARKED = {NodeExited: 'failure'}", {"NodeExited"}),
        ("record(NodeExited(seq, time_s))", set[str]()),
    ],
)
def test_every_way_to_distinguish_them_is_found(text: str, names: set[str]) -> None:
    """Making one is none."""
    assert NODE_EVENTS & set(_matched(ast.parse(text))) == names


@pytest.mark.parametrize(
    "path",
    [
        "engine/runtime/history/event_log.py",
        "engine/cli/terminal/operator_console.py",
        "engine/cli/output/progress_printer.py",
        "engine/cli/commands/runs.py",
        "engine/recording/foxglove_views.py",
        "engine/replay/replay_difference.py",
    ],
)
def test_who_tells_people_of_events_uses_the_same_words(path: str) -> None:
    """Page, command line, log of a recording and report of a replay."""
    tree = ast.parse((ROOT / path).read_text(encoding="utf-8"))
    calls = {node.func.id for node in ast.walk(tree) if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)}
    assert "event_text" in calls
