"""`flexcell teach propose` from the store of a cell, without a server."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from engine.check import check_file
from engine.cli.commands.teach import app
from engine.document import load_behavior
from engine.errors import FlexcellError
from engine.registry import load_states

CELL = Path(__file__).parents[4] / "behaviors" / "cells" / "ur10.yaml"


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The store of the cell lies in the current directory."""
    monkeypatch.chdir(tmp_path)


def output(*arguments: str) -> str:
    """What it prints, errors as the command line tells them."""
    result = CliRunner().invoke(app, ["propose", *arguments, "--cell", str(CELL)])
    assert result.exception is None or isinstance(result.exception, FlexcellError), result.exception
    return f"error: {result.exception}" if result.exception is not None else result.stdout


def test_a_behavior_is_written_that_the_check_finds_nothing_in(tmp_path: Path) -> None:
    """Its cell is named relative to it, what was said are the defaults of its parameters."""
    steps = ("home", "approach_pick=approach", "pick", "+close", "place=release", "+open")
    told = output(*steps, "--out", "sub/taught.yaml", "--width", "0.05", "--speed", "0.4", "--approach", "0.2")
    assert told.splitlines() == ["1. Move to home", "2. Pick payload at pick", "3. Place payload at place"]
    file = tmp_path / "sub" / "taught.yaml"
    assert check_file(file, load_states()) == ()
    behavior = load_behavior(file)
    assert (behavior.document.name, behavior.cell_file) == ("taught", CELL)
    assert {name: one.default for name, one in behavior.document.parameters.items()} == {
        "speed": 0.4, "line_speed_m_s": 0.1, "approach_m": 0.2, "width_m": 0.05,
    }  # fmt: skip
    assert output("home", "--out", "sub/taught.yaml").startswith(
        "error: sub/taught.yaml: the file exists (give another name"
    )
    assert output("home", "--out", "sub/taught.yaml", "--replace") == "1. Move to home\n"


@pytest.mark.parametrize(
    ("steps", "says"),
    [
        (("hme",), "there is no entry hme that defines a motion (did you mean home?)"),
        (("pose:home",), "there is no entry pose:home"),
        (("home=grap",), "there is no role grap (did you mean grasp?)"),
        (("home=follow",), "joints home cannot be `follow`"),
        (("+wave", "home"), "there is no action 'wave'"),
        (("+open",), "no step moves the arm"),
        (("home", "--arm", "left"), "there is no arm left"),
    ],
)
def test_what_cannot_be_proposed_is_refused_in_words(steps: tuple[str, ...], says: str, tmp_path: Path) -> None:
    """And no file is written."""
    assert says in output(*steps, "--out", "taught.yaml")
    assert not (tmp_path / "taught.yaml").exists()
