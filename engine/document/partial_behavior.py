"""Reads a behavior document with mistakes: all mistakes, and the behavior without the faulty parts.

A node with removed content has a gap. Its content is unknown, and the check reports no finding that would only
follow from its absence. Such a behavior is never run.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import cast

import msgspec

from engine.document.behavior import Behavior, BehaviorDocument
from engine.document.nodes.node_kind import KINDS, WRAPPERS
from engine.document.nodes.node_spec import TREE_KINDS, NodeSpec
from engine.document.structural_rules import RuleViolation, rule_violations
from engine.document.text.decoding import mistake_errors
from engine.document.text.mistakes import (
    MAX_MISTAKES,
    UNREADABLE,
    DocumentMistake,
    MistakeCollector,
    Plain,
    with_corrected_keys,
)
from engine.document.text.yaml_source import DataPath, DocumentSource
from engine.errors import DocumentError

ANY_KEY = ""
"""The key of a gap with an unknown key."""
_MOST_ROUNDS = 4
_VERSION = ("flexcell",)
_KEPT_TRANSITIONS = ("transitions", "on_error", "out")


@dataclass(frozen=True, kw_only=True)
class PartialBehavior:
    """The mistakes of a document in file order, and the remaining behavior; None if nothing is left."""

    behavior: Behavior | None
    mistakes: tuple[DocumentError, ...]


def read_partial_behavior(source: DocumentSource, file: Path, left_out: Collection[DataPath] = ()) -> PartialBehavior:
    """Read the valid parts of a behavior document; its references stay unresolved.

    Args:
        source: The readable part of its text.
        file: Its file.
        left_out: Mappings and lists with unreadable content.
    """
    collector = MistakeCollector(repairs={NodeSpec: _with_kind})
    data = collector.sift(source.data, BehaviorDocument)
    unexplained = [each for each in collector.mistakes if not _follows(each, left_out)]
    foreign = [each for each in collector.mistakes if each.path == _VERSION and each.fault == "value"]
    # In a document of another version, other mistakes cannot be determined.
    errors = mistake_errors(source, BehaviorDocument, foreign or unexplained)
    if foreign or not isinstance(data, dict):
        return PartialBehavior(behavior=None, mistakes=tuple(errors))
    source = with_corrected_keys(source, collector.mistakes)
    behavior = _behavior(cast("Plain", data), source, file)
    torn = [DocumentMistake(path=path, fault="value") for path in left_out]
    gaps = _gaps(behavior, [*collector.mistakes, *torn])
    for _ in range(_MOST_ROUNDS):
        found = list(islice(rule_violations(behavior), MAX_MISTAKES))
        errors += [each.error for each in found if each.path not in gaps or not each.path]
        gaps = _joined(gaps, ((each.path, _first(each.excess or ())) for each in found))
        mendable = [each for each in found if each.excess != ()]
        if not mendable:
            return PartialBehavior(behavior=replace(behavior, gaps=gaps), mistakes=tuple(errors[:MAX_MISTAKES]))
        behavior = _behavior(_without(behavior, mendable), source, file)
    return PartialBehavior(behavior=None, mistakes=tuple(errors[:MAX_MISTAKES]))


def _follows(mistake: DocumentMistake, left_out: Collection[DataPath]) -> bool:
    """Return whether a missing key may be part of the unreadable content."""
    where = mistake.path[:-1] if mistake.fault == "missing" else mistake.path
    return mistake.fault in ("missing", "value") and where in left_out


def _behavior(data: Plain, source: DocumentSource, file: Path) -> Behavior:
    document = msgspec.convert(data, BehaviorDocument)
    return Behavior(document=document, file=file, source=replace(source, data=data))


def _with_kind(kept: Plain) -> Plain:
    """Return the rest of a node, as an unknown state if its kind was removed."""
    kinds = [key for key in (*KINDS, *TREE_KINDS) if kept.get(key) is not None]
    wrapped = [key for key in WRAPPERS if isinstance(kept.get(key), dict) and "child" in cast("Plain", kept[key])]
    return kept if kinds or wrapped else {**kept, "state": UNREADABLE}


def _without(behavior: Behavior, found: Sequence[RuleViolation]) -> Plain:
    """Return the data without rule violations; a node that cannot be interpreted becomes an unknown state."""
    data, nodes = behavior.source.data, dict(behavior.nodes())
    # From the end, as removing a list item shifts the following ones.
    for violation in reversed(found):
        here = behavior.data_path(violation.path) if violation.path else ()
        if violation.excess:
            data = _changed(data, (*here, *violation.excess), None)
        else:
            data = _changed(data, here, _unreadable(nodes[violation.path], cast("Plain", _at(data, here))))
    return cast("Plain", data)


def _unreadable(node: NodeSpec, data: Plain) -> Plain:
    kept = {key: data[key] for key in _KEPT_TRANSITIONS if key in data}
    named = {"name": node.own_name} if node.name is not None else {}
    return {**kept, **named, "state": UNREADABLE}


def _at(data: object, path: DataPath) -> object:
    for step in path:
        data = cast("list[object]", data)[step] if isinstance(step, int) else cast("Plain", data)[step]
    return data


def _changed(data: object, path: DataPath, value: Plain | None) -> object:
    """Return a copy with another value at a path, or without one."""
    step, *rest = path
    if isinstance(step, int):
        items = list(cast("list[object]", data))
        if rest or value is not None:
            items[step] = _changed(items[step], tuple(rest), value) if rest else value
        else:
            del items[step]
        return items
    mapping = cast("Plain", data)
    if rest:
        return {**mapping, step: _changed(mapping[step], tuple(rest), value)} if step in mapping else mapping
    left = {key: each for key, each in mapping.items() if key != step}
    return left if value is None else {**mapping, step: value}


def _gaps(behavior: Behavior, mistakes: Iterable[DocumentMistake]) -> Mapping[str, frozenset[str]]:
    paths = {behavior.data_path(path): path for path, _ in behavior.nodes()}
    stand_ins = {path: frozenset((ANY_KEY,)) for path, node in behavior.nodes() if node.state == UNREADABLE}
    return _joined(stand_ins, (_gap(paths, mistake) for mistake in mistakes if not mistake.meant))


def _gap(paths: Mapping[DataPath, str], mistake: DocumentMistake) -> tuple[str, str]:
    """Return the node of a mistake (empty for the behavior itself) and its unknown key."""
    steps = mistake.path
    depth = next((count for count in range(len(steps), 0, -1) if steps[:count] in paths), 0)
    inside = steps[depth:]
    is_unknown = mistake.fault == "unknown" and len(inside) == 1
    return paths[steps[:depth]] if depth else "", ANY_KEY if is_unknown else _first(inside)


def _first(steps: DataPath) -> str:
    return str(steps[0]) if steps else ANY_KEY


def _joined(gaps: Mapping[str, frozenset[str]], more: Iterable[tuple[str, str]]) -> Mapping[str, frozenset[str]]:
    found = dict(gaps)
    for path, key in more:
        found[path] = found.get(path, frozenset()) | {key}
    return found
