"""Builds a behavior from steps, as the same frozen models as from a YAML document."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from engine.authoring.expression_values import Param
from engine.authoring.lowering import Lowering, new_source_location
from engine.authoring.plain_data import to_plain_data
from engine.authoring.source_location import calling_position
from engine.authoring.steps import Step
from engine.document.behavior import Behavior, BehaviorDocument
from engine.document.loader import load_behavior
from engine.document.state_catalogue import loaded_class
from engine.document.structural_rules import require_structural_rules
from engine.document.text.decoding import decode_document
from engine.document.text.yaml_source import DocumentSource
from engine.errors import DocumentError


def behavior(
    name: str,
    *,
    outcomes: Sequence[str],
    root: Step,
    success: Sequence[str] = (),
    parameters: Iterable[Param[Any]] = (),
    userdata: Mapping[str, object] | None = None,
    cell: str | None = None,
    description: str = "",
    view: Mapping[str, tuple[float, float]] | None = None,
    file: str | None = None,
) -> Behavior:
    """Build a behavior that can be checked, run, referred to and written as YAML.

    Args:
        name: Display name.
        outcomes: Possible outcomes.
        root: The outermost step.
        success: The outcomes that mean success.
        parameters: Parameters of a run.
        userdata: Initial values of the root scope.
        cell: Path of the default cell, relative to the document.
        description: Description of the behavior.
        view: Canvas positions by node path.
        file: Path of its document, relative to this Python file; by default derived from its name.

    Raises:
        DocumentError: the behavior is invalid; `where` is the position of the step in the Python file.
    """
    where = calling_position()
    given: dict[str, object] = {
        "flexcell": 1,
        "name": name,
        "description": description,
        "outcomes": list(outcomes),
        "success": list(success),
        "userdata": to_plain_data(userdata or {}, what="`userdata`", where=where),
        "view": to_plain_data(view or {}, what="`view`", where=where),
        **({"cell": cell} if cell is not None else {}),
    }
    place = new_source_location(where)
    lowering = Lowering(Path(where.file).parent / (file or f"{_file_name(name)}.yaml"))
    data = lowering.lower({**given, "parameters": _by_name(parameters), "root": root}, place)
    return _read(DocumentSource(file=where.file, data=data, place=place), lowering)


def _by_name(parameters: Iterable[Param[Any]]) -> dict[str, object]:
    found: dict[str, object] = {}
    for parameter in parameters:
        if parameter.name in found:
            hint = "use unique names"
            raise DocumentError(f"two parameters are named `{parameter.name}`", where=parameter.place, hint=hint)
        found[parameter.name] = parameter
    return found


def _read(source: DocumentSource, lowering: Lowering) -> Behavior:
    """Process plain data like the loader processes a file, so that both have the same semantics."""
    document = decode_document(source, BehaviorDocument)
    draft = Behavior(document=document, file=lowering.file, source=source)
    require_structural_rules(draft)
    references = {**lowering.references, **_referred_files(draft, lowering.references)}
    return replace(draft, references=references, classes=_loaded_classes(draft))


def _loaded_classes(draft: Behavior) -> dict[str, type]:
    """Return the classes that nodes name; the caller has imported them in this process."""
    names = (name for _, node in draft.nodes() for name in (node.state, node.behaviour) if name and ":" in name)
    return {name: found for name in names if (found := loaded_class(name)) is not None}


def _referred_files(draft: Behavior, known: Mapping[str, Behavior]) -> dict[str, Behavior]:
    found: dict[str, Behavior] = {}
    for path, node in draft.nodes():
        written = node.behavior
        if written is None or written in known or written in found:
            continue
        file = draft.file.parent / written
        if not file.is_file():
            where = draft.position(path, "behavior")
            raise DocumentError(f"there is no behavior file `{written}`", where=where, hint=f"looked for {file}")
        found[written] = load_behavior(file)
    return found


def _file_name(name: str) -> str:
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", name).strip("_.") or "behavior"
