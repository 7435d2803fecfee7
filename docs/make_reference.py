"""Writes docs/reference/ from the code: commands, states, findings, names for scripts. A test compares the files."""

from __future__ import annotations

import dataclasses
import inspect
import re
from functools import cached_property
from pathlib import Path
from typing import Any

from typer.main import get_command

import engine
from engine.check import CODES
from engine.cli.commands.states import default_text, description, type_text
from engine.cli.main import app
from engine.document import KeySignature, StateSignature, read_signature
from engine.registry import load_states
from robots.reconcell.packet_table import port_table

FOLDER = Path(__file__).parent / "reference"


def pages() -> dict[str, str]:
    """Return the text of every page by file name."""
    return {
        "cli.md": _commands(),
        "states.md": _states(),
        "findings.md": _findings(),
        "python.md": _python(),
        "reconcell-ports.md": _reconcell_ports(),
    }


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


def _python() -> str:
    lines = ["# The face of the engine for Python", "", "Generated from the code by `docs/make_reference.py`.", ""]
    lines += ["`from engine import Project`; [use it from Python](../how-to/use-from-python.md) shows how.", ""]
    for name in engine.__all__:
        found: Any = getattr(engine, name)
        lines += [f"## `{name}`", "", f"From `{found.__module__}`. {_summary(found)}", ""]
        fields = _fields(found)
        if fields:
            lines += [f"Fields: {', '.join(f'`{each}`' for each in fields)}.", ""]
        members = _members(found) if isinstance(found, type) else []
        if members:
            lines += ["| member | meaning |", "|---|---|", *members, ""]
    return "\n".join(lines).rstrip() + "\n"


def _reconcell_ports() -> str:
    lines = ["# Ports of the ReconCell interface", "", "Generated from the code by `docs/make_reference.py`.", ""]
    how = "[serve the ReconCell interface](../how-to/serve-the-reconcell-interface.md)"
    lines += [f"Doubles and bytes without gaps, little-endian. How to use them: {how}.", ""]
    return "\n".join(lines) + "\n" + port_table()


def _fields(kind: Any) -> tuple[str, ...]:
    if dataclasses.is_dataclass(kind):
        return tuple(each.name for each in dataclasses.fields(kind) if each.repr)
    return getattr(kind, "__struct_fields__", ())


def _members(kind: type) -> list[str]:
    """Return a row for each public member that the class itself documents."""
    rows: list[str] = []
    for name, member in vars(kind).items():
        is_property = isinstance(member, property | cached_property)
        # A property, a cached one, a class method, or a plain function.
        function: Any = member
        for attribute in ("fget", "func", "__func__"):
            function = getattr(function, attribute, function)
        if name.startswith("_") or not inspect.isfunction(function) or not function.__doc__:
            continue
        written = name if is_property else f"{name}({', '.join(_arguments(function))})"
        rows.append(f"| `{written}` | {_summary(function)} |")
    return rows


def _arguments(function: Any) -> list[str]:
    """Return the names of the arguments, `*` before those that are given by name."""
    found: list[str] = []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.name in ("self", "cls"):
            continue
        if parameter.kind is parameter.KEYWORD_ONLY and "*" not in found:
            found.append("*")
        found.append(f"*{parameter.name}" if parameter.kind is parameter.VAR_POSITIONAL else parameter.name)
    return found


def _summary(documented: Any) -> str:
    """Return the first paragraph of a docstring in one line."""
    paragraph = (inspect.getdoc(documented) or "").partition("\n\n")[0]
    return re.sub(r"\s+", " ", paragraph).replace("|", "\\|")


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for name, text in pages().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
