"""Errors, findings and nodes of a behavior made in Python name the line that made them."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from engine.authoring import load_python_behavior
from engine.check import check_behavior
from engine.document import Behavior
from engine.errors import DocumentError, Position
from engine.runtime.plan import new_plan
from tests.engine.fake_states import CATALOGUE

MODULE = """\
from engine.authoring import behavior, concurrency, machine, parameter, state, sequence, tree
from tests.engine.fake_states import Give


def give(outcome: str, to: str):
    return state(Give(outcome=outcome), transitions={outcome: to})


speed = parameter("speed", float, default=0.5)
made = behavior(
    "made",
    outcomes=["good"],
    parameters=[speed],
    root=machine(
        initial="first",
        states={
            "first": give("a", "second"),
            "second": tree(
                sequence(
                    state(Give()),
                    state(
                        "test.Give",
                        parameters={"outcome": "${nothing}"},
                    ),
                ),
                transitions={"success": "good", "failure": "good"},
            ),
        },
    ),
)
"""


@pytest.fixture
def made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest) -> Behavior:
    """The behavior of a file, run in its folder under a name of its own."""
    monkeypatch.chdir(tmp_path)
    name = f"positions_{request.node.name.partition('[')[0]}"
    Path(f"{name}.py").write_text(MODULE, encoding="utf-8")
    return load_python_behavior(f"{name}.py")


@pytest.mark.parametrize(
    ("path", "line", "column"),
    [
        ("root", 14, 10),
        ("root/first", 6, 12),
        ("root/second", 18, 23),
        ("root/second/sequence", 19, 17),
        ("root/second/sequence/Give", 20, 21),
        ("root/second/sequence/Give_2", 21, 21),
    ],
)
def test_a_node_stands_where_the_call_that_made_it_begins(made: Behavior, path: str, line: int, column: int) -> None:
    """Also when the call goes over several lines, and inside a function."""
    where = Position(file=made.source.file, line=line, column=column)
    assert (made.position(path), made.position(path, "with", "outcome")) == (where, where)
    assert made.key_position(path, "transitions") == where


def test_the_head_stands_where_its_parts_are_made(made: Behavior) -> None:
    """Parameters at their declaration, all else at the behavior."""
    file = made.source.file
    assert made.source.position(("parameters", "speed", "default")) == Position(file=file, line=9, column=9)
    assert made.source.position(("outcomes", 0)) == Position(file=file, line=10, column=8)


def test_findings_name_the_line(made: Behavior) -> None:
    """The check needs nothing of its own for behaviors made in Python."""
    found = {finding.code: str(finding.position) for finding in check_behavior(made, CATALOGUE)}
    assert found["undeclared-name"] == f"{made.source.file}:21:21"


def test_plans_name_the_line(made: Behavior) -> None:
    """What a failing state names at run time."""
    root = new_plan(made, CATALOGUE).root
    assert root.position == f"{made.source.file}:14:10"


def test_a_document_error_names_the_step_and_not_the_behavior(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A key of the wrong type, found when the behavior is made."""
    monkeypatch.chdir(tmp_path)
    text = """
        from engine.authoring import Timeout, behavior, machine, state

        made = behavior(
            "made",
            outcomes=["good"],
            root=machine(
                initial="first",
                states={
                    "first": state(
                        "test.Give", timeout=Timeout(after="soon", to="good")
                    )
                },
            ),
        )
    """
    Path("wrong_duration.py").write_text(dedent(text), encoding="utf-8")
    with pytest.raises(DocumentError, match="`after`: not in the allowed form") as raised:
        load_python_behavior("wrong_duration.py")
    assert raised.value.where == Position(file="wrong_duration.py", line=10, column=22)
