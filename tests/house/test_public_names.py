"""What packages say they offer is what they offer, and every command is helpful."""

from __future__ import annotations

import importlib
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from typer.main import get_command

from engine.cli.main import app
from tests.engine.cli.command import flexcell

ROOT = Path(__file__).resolve().parents[2]
FACES = [
    str(path.parent.relative_to(ROOT)).replace("/", ".")
    for package in ("engine", "states", "robots", "editor_web")
    for path in sorted((ROOT / package).rglob("__init__.py"))
    if "node_modules" not in path.parts and "__all__" in path.read_text(encoding="utf-8")
]


def _commands(group: object, path: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Yield the words of every command and of every group, as the command line itself knows them."""
    if path:
        yield path
    for name, command in getattr(group, "commands", {}).items():
        yield from _commands(command, (*path, name))


COMMANDS = list(_commands(get_command(app)))


def test_every_name_in_all_exists() -> None:
    """`__all__` is true."""
    faces = {face: importlib.import_module(face) for face in FACES}
    assert len(faces) > 20
    missing = {f: [n for n in getattr(module, "__all__", ()) if not hasattr(module, n)] for f, module in faces.items()}
    assert [f"{face}.{name}" for face, names in missing.items() for name in names] == []


def test_every_command_is_documented() -> None:
    """`docs/reference/cli.md` has a section for each, and for nothing else."""
    page = (ROOT / "docs" / "reference" / "cli.md").read_text(encoding="utf-8")
    assert re.findall(r"^## `flexcell ([a-z -]+)`$", page, re.MULTILINE) == [" ".join(command) for command in COMMANDS]


@pytest.mark.parametrize("command", COMMANDS, ids=" ".join)
def test_every_command_has_help(tmp_path: Path, command: tuple[str, ...]) -> None:
    """Its usage and at least one sentence of what it does, exit code 0."""
    said = flexcell(*command, "--help", cwd=tmp_path)
    usage, _, rest = said.out.strip().partition("\n")
    assert (said.code, said.err) == (0, "")
    assert usage.split()[: 2 + len(command)] == ["Usage:", "flexcell", *command]
    assert re.match(r"\s+[A-Z][^.]+\.", rest), said.out
