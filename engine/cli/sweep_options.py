"""Reads a sweep from a document and the options of the command line, which replace what the document says."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

import msgspec

from engine.authoring.python_file import load_python_behavior
from engine.cli.inputs import read_parameters
from engine.document import load_behavior
from engine.document.parameter_spec import ParameterSpec
from engine.document.python_name import is_python_name
from engine.document.sweep import Sweep, sweep_of_source
from engine.document.text.yaml_source import DocumentSource, load_source, parse_source
from engine.sweep.design.factor_text import parse_factor

_PLAIN = ("runs", "time", "width", "design", "seed", "confidence")
NO_SEARCH = "none"
"""The text of `--search` with which there is none."""
Data = dict[str, object]


@dataclass(frozen=True, kw_only=True)
class SweepOverrides:
    """The options of a command that replace keys of a sweep document; None and empty ones do not."""

    vary: Sequence[str] = ()
    runs: int | None = None
    time: str | None = None
    width: float | None = None
    require: Sequence[str] = ()
    design: str | None = None
    seed: int | None = None
    cell: Path | None = None
    simulate: Sequence[str] = ()
    parameters: Sequence[str] = ()
    confidence: float | None = None
    search: str | None = None
    """What is searched for; `none` for the design of a document that has a search too."""
    method: str | None = None
    stop_after: int | None = None


def read_sweep(file: Path, options: SweepOverrides) -> Sweep:
    """Return the sweep of a document or of a behavior, with the options of the command line.

    Raises:
        DocumentError: the file cannot be read, an option is invalid, or the sweep that they make is.
    """
    source = _source(file)
    data = dict(_mapping(source))
    for name in _PLAIN:
        value = getattr(options, name)
        if value is not None:
            data[name] = value
    if options.require:
        data["require"] = options.require[0] if len(options.require) == 1 else list(options.require)
    _with_search(data, options)
    if options.cell is not None:
        data["cell"] = os.path.relpath(options.cell.resolve(), file.parent.resolve())
    if options.simulate:
        data["simulate"] = list(options.simulate)
    if options.vary:
        data["factors"] = {**cast("Data", data.get("factors") or {}), **dict(map(parse_factor, options.vary))}
    if options.parameters:
        given = read_parameters(options.parameters, _declared(file, data))
        data["parameters"] = {**cast("Data", data.get("parameters") or {}), **given}
    return sweep_of_source(replace(source, data=data), file=file)


def _with_search(data: Data, options: SweepOverrides) -> None:
    """Put the options of a search into a document; `runs` are then those of the search."""
    if options.search == NO_SEARCH:
        data.pop("search", None)
        return
    given = {"towards": options.search, "method": options.method, "stop_after": options.stop_after}
    written = cast("Data", data.get("search") or {})
    changed = {**written, **{name: value for name, value in given.items() if value is not None}}
    if changed or "search" in data:
        runs = {"runs": options.runs} if options.runs is not None else {}
        data["search"] = {**changed, **runs}


def _source(file: Path) -> DocumentSource:
    """Return the sweep document, or that of a behavior which is executed as it is."""
    if not is_python_name(str(file)):
        source = load_source(file)
        if "root" not in _mapping(source):
            return source
    document = msgspec.json.encode({"flexcell": 1, "behavior": file.name})
    return parse_source(document, file=str(file))


def _mapping(source: DocumentSource) -> Data:
    data = source.data
    return cast("Data", data) if isinstance(data, dict) else {}


def _declared(file: Path, data: Data) -> dict[str, ParameterSpec]:
    named = str(file.parent / str(data.get("behavior", "")))
    behavior = load_python_behavior(named) if is_python_name(named) else load_behavior(Path(named))
    return dict(behavior.parameters)
