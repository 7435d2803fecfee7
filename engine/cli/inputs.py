"""Reads the arguments of the commands: behaviors, cells, parameters, JSON values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

import msgspec
import typer

from engine.authoring.python_file import load_python_behavior
from engine.check import Finding, check_behavior, require_no_errors
from engine.document import Behavior, load_behavior
from engine.document.cell import Cell, load_cell
from engine.document.parameter_spec import ParameterSpec
from engine.document.python_name import is_python_name
from engine.document.simulated_devices import with_simulated_devices
from engine.document.substitutes import Substitutes
from engine.document.text.yaml_source import load_text
from engine.errors import ControlError, DocumentError, FlexcellError
from engine.runtime.plan import Catalogue, Plan, new_plan
from engine.wording.suggestions import did_you_mean

Simulate = Annotated[
    list[str] | None,
    typer.Option(
        help="Simulate this robot (`left`) or tool (`left/gripper`) instead of driving it, or `all`; may be repeated."
    ),
]


def read_behavior(
    file: Path, catalogue: Catalogue, *, cell: Cell | None = None, given: Sequence[str] = ()
) -> tuple[Behavior, tuple[Finding, ...]]:
    """Load and check a behavior, given as a document or as `FILE.py:NAME`; the findings include warnings.

    Args:
        file: The behavior.
        catalogue: The states by name.
        cell: Cell in which it runs; by default the cell that it names.
        given: Parameters of this run, `name=value`.

    Raises:
        DocumentError: the behavior cannot be read, or a parameter is invalid.
    """
    name = str(file)
    behavior = load_python_behavior(name) if is_python_name(name) else load_behavior(file)
    parameters = read_parameters(given, behavior.parameters)
    return behavior, check_behavior(behavior, catalogue, cell=cell, parameters=parameters)


def read_plan(
    file: Path, catalogue: Catalogue, *, cell: Cell | None = None, substitutes: Substitutes | None = None
) -> Plan:
    """Load, check and plan a behavior, for the cell that it names or for `cell`.

    Raises:
        DocumentError: the behavior cannot be read, or has errors; the first error is raised.
    """
    behavior, findings = read_behavior(file, catalogue, cell=cell)
    require_no_errors(findings)
    return new_plan(behavior.with_substitutes(substitutes), catalogue)


def reload_plan(
    file: Path, catalogue: Catalogue, *, cell: Cell | None = None, substitutes: Substitutes | None = None
) -> Plan:
    """Load, check and plan a behavior whose file may have changed since this process read it.

    Raises:
        DocumentError: the behavior cannot be read, or has errors.
        ControlError: the behavior is defined in Python, which executes a file only once.
    """
    if is_python_name(str(file)):
        hint = "export it to YAML with `flexcell export` and run the YAML document"
        raise ControlError("a behavior defined in Python cannot be reloaded", where=file, hint=hint)
    return read_plan(file, catalogue, cell=cell, substitutes=substitutes)


def behavior_source(file: Path) -> str:
    """Return the argument that names a behavior as an absolute path, valid in every working directory."""
    path, python, name = str(file).partition(".py:")
    return f"{Path(path).resolve()}{python}{name}"


def read_text(file: Path) -> str:
    """Return the text of a document.

    Raises:
        DocumentError: the file cannot be read, or is no UTF-8 text.
    """
    try:
        return load_text(file).decode("utf-8")
    except UnicodeDecodeError as error:
        raise DocumentError(f"this file is no text: {error}", where=str(file)) from error


def read_cell(file: Path | None, behavior: Behavior | None) -> Cell | None:
    """Load the cell given on the command line, else the cell that the behavior names; None if there is neither."""
    if file is not None:
        return load_cell(file)
    if behavior is not None and behavior.cell_file is not None:
        return load_cell(behavior.cell_file)
    return None


def read_simulated_cell(cell: Cell | None, file: Path, simulate: Sequence[str]) -> Cell | None:
    """Return the cell, or else that of the behavior `file`, with these devices simulated; None without names or cell.

    Raises:
        DocumentError: a document cannot be read, or the cell cannot simulate such a device.
    """
    if not simulate:
        return cell
    name = str(file)
    found = cell or read_cell(None, load_python_behavior(name) if is_python_name(name) else load_behavior(file))
    if found is None:
        raise DocumentError("the behavior names no cell to simulate", where="--simulate", hint="give --cell CELL")
    return with_simulated_devices(found, simulate)


def read_parameters(given: Sequence[str], declared: Mapping[str, ParameterSpec]) -> dict[str, object]:
    """Read `name=value` pairs, converted to the types that the behavior declares.

    Raises:
        DocumentError: a pair is not `name=value`, names no parameter, or has a value of the wrong type.
    """
    values: dict[str, object] = {}
    for pair in given:
        name, text = _split(pair, "-p")
        if name not in declared:
            raise DocumentError(f"there is no parameter `{name}`", hint=did_you_mean(name, declared))
        try:
            values[name] = declared[name].from_text(text)
        except DocumentError as error:
            raise DocumentError(f"parameter `{name}`: {error.message}") from error
    return values


def read_inputs(given: Sequence[str]) -> dict[str, object]:
    """Read `key=json` pairs as initial userdata.

    Raises:
        DocumentError: a pair is not `key=json`.
    """
    return {key: read_json(text, f"--input {key}") for key, text in (_split(pair, "--input") for pair in given)}


def read_pairs(given: Sequence[str], option: str) -> dict[str, str]:
    """Read `name=text` pairs as they are.

    Raises:
        DocumentError: a pair is not `name=text`.
    """
    return dict(_split(pair, option) for pair in given)


def read_json(text: str, where: str) -> object:
    """Read a JSON value given on the command line.

    Raises:
        FlexcellError: the text is not JSON; the message gives the position of the error.
    """
    try:
        return msgspec.json.decode(text)
    except msgspec.DecodeError as error:
        raise FlexcellError(
            f"{text!r} is not JSON: {error}", where=where, hint="text needs quotes: '\"word\"'"
        ) from error


def _split(pair: str, option: str) -> tuple[str, str]:
    name, equals, text = pair.partition("=")
    if not equals or not name:
        raise DocumentError(f"{pair!r} is not name=value", where=option)
    return name, text
