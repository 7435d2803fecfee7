"""Writes docs/reference/ from the code: commands, states, findings. A test compares the files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from typer.main import get_command

from engine.check import CODES
from engine.cli.main import app
from engine.cli.states import default_text, description, type_text
from engine.document import KeySignature, StateSignature, read_signature
from engine.registry import load_states

FOLDER = Path(__file__).parent / "reference"


def pages() -> dict[str, str]:
    """Return the text of every page by file name."""
    return {"cli.md": _commands(), "states.md": _states(), "findings.md": _findings()}


def _commands() -> str:
    lines = ["# Command line", "", "Generated from the code by `docs/make_reference.py`.", ""]
    for path, command in _walk(get_command(app), ("flexcell",)):
        lines += [f"## `{' '.join(path)}`", "", " ".join((command.help or "").split()), ""]
        rows = [_parameter(parameter) for parameter in command.params if parameter.name not in ("help", None)]
        if rows:
            lines += ["| option | default | meaning |", "|---|---|---|", *rows, ""]
    return "\n".join(lines).rstrip() + "\n"


def _walk(command: Any, path: tuple[str, ...]) -> list[tuple[tuple[str, ...], Any]]:
    found: list[tuple[tuple[str, ...], Any]] = []
    children: dict[str, Any] = getattr(command, "commands", {})
    if len(path) > 1:
        found.append((path, command))
    for name, child in children.items():
        found += _walk(child, (*path, name))
    return found


def _parameter(parameter: Any) -> str:
    name = " ".join(getattr(parameter, "opts", ())) or str(getattr(parameter, "name", ""))
    if getattr(parameter, "param_type_name", "") == "argument":
        name = str(getattr(parameter, "name", "")).upper()
    default = getattr(parameter, "default", None)
    shown = "" if default in (None, False, ...) or callable(default) else f"`{default}`"
    return f"| `{name}` | {shown} | {' '.join((getattr(parameter, 'help', '') or '').split())} |"


def _states() -> str:
    lines = ["# States", "", "Generated from the code by `docs/make_reference.py`.", ""]
    for state in load_states().values():
        signature = read_signature(state)
        lines += [f"## `{signature.name}`", "", signature.doc, "", f"Outcomes: {_outcomes(signature)}.", ""]
        for title, keys in (
            ("parameter", signature.parameters),
            ("input key", signature.inputs),
            ("output key", signature.outputs),
        ):
            if keys:
                lines += [f"| {title} | type | default | meaning |", "|---|---|---|---|", *map(_key, keys.values()), ""]
    return "\n".join(lines).rstrip() + "\n"


def _outcomes(signature: StateSignature) -> str:
    return ", ".join(f"**{name}**" if name in signature.success else name for name in signature.outcomes)


def _key(key: KeySignature) -> str:
    return f"| `{key.name}` | {type_text(key)} | {default_text(key)} | {description(key)} |".replace("\n", " ")


def _findings() -> str:
    lines = ["# Findings of `flexcell check`", "", "Generated from the code by `docs/make_reference.py`.", ""]
    lines += ["`flexcell check --explain CODE` prints the page of a finding.", ""]
    lines += ["| code | severity | meaning |", "|---|---|---|"]
    lines += [
        f"| [`{code}`](../findings/{code}.md) | {severity} | {meaning} |" for code, (severity, meaning) in CODES.items()
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, text in pages().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
