"""`flexcell export`, and the other commands on behaviors made in Python."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.document import load_behavior
from tests.engine.cli.command import flexcell

MODULE = """
from engine.authoring import behavior, machine, reference, state
from states.flow.wait import Wait

rest = behavior("rest", outcomes=["done"], success=["done"], root=state(Wait(duration_s=2.0)))
work = behavior(
    "work",
    outcomes=["done"],
    success=["done"],
    root=machine(initial="rest", states={"rest": reference(rest, transitions={"done": "done"})}),
)
wrong = behavior(
    "wrong", outcomes=["done"], root=machine(initial="nowhere", states={"a": state(Wait(duration_s=1.0))})
)
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "cell_work.py").write_text(MODULE, encoding="utf-8")
    return tmp_path


def test_a_behavior_goes_to_standard_output(folder: Path) -> None:
    said = flexcell("export", "cell_work.py:rest", cwd=folder)
    assert (said.code, said.err) == (0, "")
    assert said.out == (
        "flexcell: 1\nname: rest\noutcomes: [done]\nsuccess: [done]\n"
        "root:\n  state: flow.Wait\n  with: {duration_s: 2.0}\n"
    )


def test_a_file_is_written_with_what_it_refers_to(folder: Path) -> None:
    said = flexcell("export", "cell_work.py:work", "-o", "out/work.yaml", cwd=folder)
    assert (said.code, said.err.splitlines()) == (0, ["wrote out/rest.yaml", "wrote out/work.yaml"])
    assert load_behavior(folder / "out" / "work.yaml").name == "work"
    assert flexcell("check", "out/work.yaml", "out/rest.yaml", cwd=folder).code == 0


def test_the_same_behavior_runs_from_python_and_from_yaml(folder: Path) -> None:
    """Event for event; only the positions would differ, and nothing fails here."""
    flexcell("export", "cell_work.py:work", "-o", "work.yaml", cwd=folder)
    logs: list[bytes] = []
    for index, name in enumerate(("cell_work.py:work", "work.yaml")):
        events = folder / f"{index}.jsonl"
        said = flexcell("run", name, "--clock", "virtual", "--journal", "none", "--events", events, cwd=folder)
        assert said.code == 0, said.err
        logs.append(events.read_bytes())
    assert logs[0] == logs[1]


@pytest.mark.parametrize(
    ("command", "name", "message"),
    [
        (
            "export",
            "cell_work.py",
            "this file has several behaviors: rest, work, wrong (select one: cell_work.py:NAME)",
        ),
        ("export", "cell_work.py:wrk", "this file has no behavior named `wrk`"),
        ("export", "cell_work.yaml", "this is not a Python file (give FILE.py:NAME)"),
        ("export", "cell_work.py:wrong", "cell_work.py:13:38: error:"),
        ("run", "cell_work.py:wrong", "cell_work.py:13:38: error:"),
        ("run", "absent.py:x", "absent.py:1:1: there is no such file"),
    ],
)
def test_what_cannot_be_used_is_said_on_one_line(folder: Path, command: str, name: str, message: str) -> None:
    """Exit code 2, nothing written."""
    said = flexcell(command, name, cwd=folder)
    assert (said.code, said.out) == (2, "")
    assert message in said.err
    assert "Traceback" not in said.err


def test_a_behavior_in_python_is_checked_like_a_document(folder: Path) -> None:
    good = flexcell("check", "cell_work.py:work", "cell_work.py:rest", cwd=folder)
    assert (good.code, good.out) == (0, "")
    wrong = flexcell("check", "cell_work.py:wrong", cwd=folder)
    assert (wrong.code, "cell_work.py:13:38: error: " in wrong.out) == (2, True)
    absent = flexcell("check", "cell_work.py:absent", cwd=folder)
    assert (absent.code, "[invalid-document]" in absent.out) == (2, True)


def test_nothing_is_written_when_the_behavior_has_errors(folder: Path) -> None:
    said = flexcell("export", "cell_work.py:wrong", "-o", "wrong.yaml", cwd=folder)
    assert said.code == 2
    assert not (folder / "wrong.yaml").exists()


def test_a_file_that_cannot_be_written_is_said_in_one_line(folder: Path) -> None:
    (folder / "file").write_text("")
    said = flexcell("export", "cell_work.py:rest", "-o", "file/rest.yaml", cwd=folder)
    assert (said.code, said.err.count("\n")) == (2, 1)
    assert "file: " in said.err
    assert "check the path" in said.err
