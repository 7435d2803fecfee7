"""What the command line takes as it is written is what typer would have made of it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Annotated, Any, Literal

import pytest
import typer
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from typer.main import get_command

from engine.cli.plain_values import take_plain_values

WORDS = st.text(st.characters(codec="utf-8", exclude_characters="\0\n\r"), max_size=8)
VALUES = WORDS | st.sampled_from(
    ["", ".", "-", "~", "a/../b", "/", "/root", "nowhere", "fast", "Fast", "slow", "12", "-3", "1e3", "nan", "0", "yes"]
)
OPTIONS = st.sampled_from(["--text", "--several", "--speed", "--count", "--share", "--file", "--existing", "--found"])

PROGRAM = """
import sys
sys.argv = {}
from engine.cli.entry import main
try:
    main()
except SystemExit as left:
    print(left.code, "pydantic" in sys.modules)
"""


def show(
    first: Path,
    rest: Annotated[list[Path] | None, typer.Argument()] = None,
    text: str | None = None,
    several: list[str] | None = None,
    speed: Literal["fast", "slow"] = "slow",
    count: Annotated[int, typer.Option(min=0)] = 3,
    share: float = 0.5,
    file: Path | None = None,
    existing: Annotated[Path | None, typer.Option(exists=True, dir_okay=False)] = None,
    found: Annotated[Path | None, typer.Option(parser=lambda text: Path("found", text))] = None,
    quiet: bool = False,
) -> None:
    """Print what it was called with."""
    typer.echo(repr([first, rest, text, several, speed, count, share, file, existing, found, quiet]))


def command() -> Any:
    app = typer.Typer()
    app.command()(show)
    return get_command(app)


def said(of: Any, arguments: list[str]) -> str:
    """What a command is called with, or how it is refused."""
    try:
        return str(of.make_context("show", list(arguments)).params)
    except typer.TyperException as error:
        return error.format_message()


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(first=VALUES, rest=st.lists(VALUES, max_size=2), options=st.lists(st.tuples(OPTIONS, VALUES), max_size=4))
def test_a_command_is_called_with_what_typer_makes_of_its_arguments(
    first: str, rest: list[str], options: list[tuple[str, str]]
) -> None:
    """Or refused in its words."""
    arguments = [*(part for option in options for part in option), "--", first, *rest]
    plain = command()
    take_plain_values(plain)
    assert said(plain, arguments) == said(command(), arguments)


def test_a_file_that_cannot_be_read_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Who runs the tests may read everything."""

    def no_access(path: object, mode: int) -> bool:
        return False

    monkeypatch.setattr("os.access", no_access)
    plain = command()
    take_plain_values(plain)
    assert "is not readable" in said(plain, [str(tmp_path)])


@pytest.mark.parametrize("arguments", [["check", "nowhere.yaml"], ["run", "nowhere.yaml", "--clock", "virtual"]])
def test_pydantic_is_not_loaded_for_plain_values(arguments: list[str]) -> None:
    program = PROGRAM.format(["flexcell", *arguments])
    done = subprocess.run([sys.executable, "-P", "-c", program], capture_output=True, text=True, check=True)
    assert done.stdout.splitlines()[-1] == "2 False"
