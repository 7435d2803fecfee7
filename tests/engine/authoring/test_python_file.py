"""Behaviors found in Python files by name; a file that cannot be run says which of its lines is at fault."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from uuid import uuid4

import pytest

from engine.authoring import load_python_behavior
from engine.errors import DocumentError
from engine.runtime.plan import new_plan
from tests.engine.fake_states import CATALOGUE

ONE = """
from engine.authoring import behavior, state
from tests.engine.fake_states import Give
{name} = behavior("{name}", outcomes=["a"], root=state(Give()))
"""
OWN = """
from typing import ClassVar
from engine.authoring import behavior, state
from engine.state import Context, Outcome, State
from {beside} import OUTCOME

class Mine(State, frozen=True, kw_only=True):
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    async def run(self, ctx: Context) -> Outcome:
        return Outcome(OUTCOME)

made = behavior("made", outcomes=["done"], root=state(Mine()))
"""
Write = Callable[[str], str]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write a file with a name that no other test has, and return its path."""

    def to_file(text: str) -> str:
        file = tmp_path / f"made_{uuid4().hex}.py"
        file.write_text(text, encoding="utf-8")
        return str(file)

    return to_file


def test_a_behavior_is_found_by_name_or_as_the_only_one(write: Write) -> None:
    """`:NAME` may be left out where it says nothing."""
    file = write(ONE.format(name="first"))
    assert load_python_behavior(file) is load_python_behavior(f"{file}:first")


def test_of_several_one_must_be_named(write: Write) -> None:
    """The message lists them; a wrong name brings the nearest."""
    file = write(ONE.format(name="first") + ONE.format(name="second"))
    assert load_python_behavior(f"{file}:second").name == "second"
    with pytest.raises(DocumentError, match="this file has several behaviors: first, second"):
        load_python_behavior(file)
    with pytest.raises(DocumentError, match=r"no behavior named `frist` \(.*first"):
        load_python_behavior(f"{file}:frist")


def test_a_file_may_hold_its_own_states_and_import_its_neighbours(write: Write) -> None:
    """The state is named by the module of the file, and found by it."""
    beside = Path(write("OUTCOME = 'done'")).stem
    file = write(OWN.format(beside=beside))
    made = load_python_behavior(file)
    assert made.root.state == f"{Path(file).stem}:Mine"
    assert new_plan(made, CATALOGUE).root.work.kind == "state"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("x = 1\n1 / 0\n", r"\.py:2:1: .*division by zero"),
        ("x = (\n", r"\.py:1:5: .*was never closed"),
        ("import nothing_of_this_name\n", r"\.py:1:1: .*No module named"),
        ("x = 1\n", "this file has no behavior"),
        ("from engine.authoring import expr\nexpr('1 +')\n", r"\.py:2:1: `\$\{1 \+\}`"),
        (
            "from engine.authoring import state\nfrom engine.state import State\nstate(State())\n",
            r"\.py:3:1: it declares no",
        ),
    ],
)
def test_a_file_that_cannot_be_run_names_the_line(write: Write, text: str, message: str) -> None:
    """No traceback."""
    file = write(text)
    for _ in range(2):
        with pytest.raises(DocumentError, match=message):
            load_python_behavior(file)


def test_a_file_that_is_absent_or_named_like_a_module_is_refused(tmp_path: Path) -> None:
    """A file named `typing.py` would stand in for the real one."""
    with pytest.raises(DocumentError, match="there is no such file"):
        load_python_behavior(str(tmp_path / "nowhere.py"))
    (tmp_path / "typing.py").write_text(ONE.format(name="made"), encoding="utf-8")
    with pytest.raises(DocumentError, match="another module named `typing` is loaded already"):
        load_python_behavior(str(tmp_path / "typing.py"))
