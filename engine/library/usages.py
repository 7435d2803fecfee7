"""Where the behaviors of a project use a state, a behavior, an entry or a userdata key, with file positions."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Literal, cast

import msgspec

from engine.check.analyzed_behavior import NodeAt, template
from engine.check.cell.entry_references import entry_fields
from engine.check.flow.key_reads import assignments, expressions, only_name
from engine.check.values.annotated_values import annotated_values
from engine.document import Behavior, StateSignature, read_signature
from engine.document.expression.expression import Template
from engine.document.nodes.node_spec import NodeSpec
from engine.document.state_catalogue import Catalogue, find_state
from engine.errors import Position, RegistryError, StateError

UsedKind = Literal["state", "behavior", "entry", "key"]
"""A state class by its name, a behavior by its id, an entry of the store by its name, a key of userdata."""


class Usage(msgspec.Struct, frozen=True, kw_only=True):
    """One place that uses it.

    `path` is the node in this document; empty for the document itself. `how` says in what way: `runs`, `reads pose`,
    `writes`. `line` and `column` count from 1.
    """

    document: str
    behavior: str
    path: str
    how: str
    line: int
    column: int


class Usages(msgspec.Struct, frozen=True, kw_only=True):
    """All usages, by document and line; `unread` are the documents that cannot be read, and may have more."""

    found: tuple[Usage, ...]
    unread: tuple[str, ...] = ()


def find_usages(
    behaviors: Iterable[tuple[str, Behavior | None]], catalogue: Catalogue, kind: UsedKind, name: str
) -> Usages:
    """Find what is used in these behaviors, also in disabled nodes; each behavior is looked at by itself.

    Args:
        behaviors: By their ids; None for one that cannot be read.
        catalogue: The states by name.
        kind: What is looked for.
        name: Its name; for a behavior its id. A userdata key is found in all behaviors that have one of this name.
    """
    given = list(behaviors)
    ids = {behavior.file.resolve(): document for document, behavior in given if behavior is not None}
    found: list[Usage] = []
    for document, behavior in given:
        if behavior is None:
            continue
        match kind:
            case "state":
                places = _of_state(behavior, name)
            case "behavior":
                referred = {written: ids.get(each.file.resolve()) for written, each in behavior.references.items()}
                places = _of_behavior(behavior, referred, name)
            case "entry":
                places = _of_entry(behavior, catalogue, name)
            case "key":
                places = _of_key(behavior, catalogue, name)
        found += [
            Usage(document=document, behavior=behavior.name, path=path, how=how, line=at.line, column=at.column)
            for path, how, at in places
        ]
    unread = tuple(document for document, behavior in given if behavior is None)
    # In a reading order, each place once: a value with two expressions may read a key twice.
    return Usages(found=tuple(sorted(dict.fromkeys(found), key=lambda use: (use.document, use.line))), unread=unread)


_Places = Iterator[tuple[str, str, Position]]
"""The node, in what way it uses it, and where that is written."""


def _of_state(behavior: Behavior, name: str) -> _Places:
    for path, node in behavior.nodes():
        if node.state == name:
            yield path, "runs", behavior.position(path, "state")


def _of_behavior(behavior: Behavior, ids: Mapping[str, str | None], name: str) -> _Places:
    for path, node in behavior.nodes():
        if node.behavior is not None and ids.get(node.behavior) == name:
            yield path, "refers to it", behavior.position(path, "behavior")


def _of_entry(behavior: Behavior, catalogue: Catalogue, name: str) -> _Places:
    for path, node, signature in _with_signatures(behavior, catalogue):
        for parameter, value in node.parameters.items() if signature is not None else ():
            if signature is None or parameter not in signature.parameters:
                continue
            annotation = signature.parameters[parameter].type
            kinds = {("entry",): "", **entry_fields(annotation)}
            for steps, entry_kind in kinds.items():
                written = _inside(value, steps)
                through = only_name(template(written))
                known = behavior.parameters.get(through) if through is not None else None
                if name == (known.default if known is not None else written):
                    how = f"reads {entry_kind}".rstrip() + (
                        f", the default of `{through}`" if known is not None else ""
                    )
                    yield path, how, behavior.position(path, "with", parameter, *steps)
            for part in annotated_values(annotation, value):
                if part.value == name and ("new_entry" in part.says or "new_entry_of" in part.says):
                    yield path, "writes", behavior.position(path, "with", parameter, *part.steps)


def _inside(value: object, steps: tuple[str, ...]) -> object:
    for step in steps:
        value = cast("dict[str, object]", value).get(step) if isinstance(value, dict) else None
    return value


def _of_key(behavior: Behavior, catalogue: Catalogue, key: str) -> _Places:
    for section in ("parameters", "userdata"):
        if key in getattr(behavior.document, section):
            yield "", "declares", behavior.source.position((section, key), of_key=True)
    for path, node, signature in _with_signatures(behavior, catalogue):
        for how, keys in (*_writes(node, signature, key), *_reads(path, node, signature, key)):
            yield path, how, behavior.position(path, *keys)


_Written = Iterator[tuple[str, tuple[str | int, ...]]]
"""In what way a node uses a key, and the keys that lead to it from the node inward."""


def _writes(node: NodeSpec, signature: StateSignature | None, key: str) -> _Written:
    if key in node.userdata:
        yield "declares", (node.kind, "userdata", key)
    rounds = node.foreach
    if rounds is not None:
        named = {"as": rounds.item, "index": rounds.index}
        yield from (("declares", ("foreach", field)) for field, name in named.items() if name == key)
        yield from (("writes", ("foreach", "collect", inner)) for inner, to in rounds.collect.items() if to == key)
    yield from (("writes", ("out", output)) for output, to in node.outputs.items() if to == key)
    if signature is not None and key in signature.outputs and key not in node.outputs:
        yield "writes", ("state",)


def _reads(path: str, node: NodeSpec, signature: StateSignature | None, key: str) -> _Written:
    yield from (("reads", ("in", name)) for name, source in node.inputs.items() if source == key)
    if signature is not None and key in signature.inputs and key not in node.inputs:
        yield "reads", ("state",)
    placed = NodeAt(
        path=path,
        name=path.rpartition("/")[2],
        kind=node.kind,
        node=node,
        parent=None,
        container=None,
        in_tree=False,
        is_part=False,
        targets={},
        given={name: template(value) for name, value in node.parameters.items()},
    )
    yield from (("reads", keys) for keys, found in expressions(placed) if key in found.names)
    for keys, assigned in assignments(placed).items():
        if keys[-1] == key:
            yield "writes", keys
        if isinstance(assigned, Template) and key in assigned.names:
            yield "reads", keys
    if node.foreach is not None and key in node.foreach.collect:
        yield "reads", ("foreach", "collect", key)
    if node.concurrency is not None and key in node.concurrency.shared:
        yield "shares", ("concurrency", "shared", node.concurrency.shared.index(key))


def _with_signatures(behavior: Behavior, catalogue: Catalogue) -> Iterator[tuple[str, NodeSpec, StateSignature | None]]:
    known: dict[str, StateSignature | None] = {}
    for path, node in behavior.nodes():
        if node.state is None:
            yield path, node, None
            continue
        if node.state not in known:
            try:
                known[node.state] = read_signature(find_state(catalogue, node.state, behavior.classes))
            except (RegistryError, StateError):
                known[node.state] = None  # the check reports it
        yield path, node, known[node.state]
