"""What packages say they offer is what they offer, and every command is helpful."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

from tests.engine.cli.command import flexcell

ROOT = Path(__file__).resolve().parents[2]
FACES = [
    "engine.authoring",
    "engine.bus",
    "engine.check",
    "engine.document",
    "engine.editing",
    "engine.journal",
    "engine.recording",
    "engine.replay",
    "engine.stop",
    "engine.store",
    "engine.testing",
    "states",
]
COMMANDS = [
    ("run",), ("check",), ("export",), ("replay",), ("serve",), ("login",), ("stop",),
    ("schema",), ("states",), ("states", "show"),
    *(("store", name) for name in ("list", "get", "show", "set", "delete", "history", "undo")),
    *(("store", name) for name in ("export", "import", "migrate", "watch")),
    *(("bus", name) for name in ("list", "echo", "hz", "publish", "call", "goal")),
    *(("cell", name) for name in ("status", "connect")),
]  # fmt: skip


@pytest.mark.parametrize("face", FACES)
def test_every_name_in_all_exists(face: str) -> None:
    """`__all__` is true."""
    module = importlib.import_module(face)
    assert [name for name in getattr(module, "__all__", ()) if not hasattr(module, name)] == []


def test_every_command_has_help_and_is_documented() -> None:
    """`--help` answers, and docs/reference/cli.md names the command."""
    page = (ROOT / "docs" / "reference" / "cli.md").read_text(encoding="utf-8")
    for command in COMMANDS:
        assert f"flexcell {' '.join(command)}" in page, command


@pytest.mark.parametrize("command", [("run",), ("bus", "goal"), ("store", "set")], ids=" ".join)
def test_help_answers(tmp_path: Path, command: tuple[str, ...]) -> None:
    """Usage and options, exit code 0."""
    said = flexcell(*command, "--help", cwd=tmp_path)
    assert (said.code, "Usage: flexcell" in said.out) == (0, True)
