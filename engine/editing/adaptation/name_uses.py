"""Where a behavior names something of its cell: robots, parts, cameras, frames, outputs, planners, entries."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, cast

import msgspec

from engine.cell.cell_names import is_kind
from engine.cell.robot_models import tool_kinds
from engine.check.analyzed_behavior import template
from engine.check.flow.key_reads import only_name
from engine.check.values.annotated_values import Annotations, annotated_values
from engine.document.behavior import Behavior
from engine.document.cell import Cell
from engine.document.nodes.node_spec import NodeSpec
from engine.document.signature import StateSignature
from engine.document.text.yaml_source import DataPath

SignatureOf = Callable[[str], StateSignature | None]
_NAMING = frozenset(("cell_name", "cell_label", "entry", "entry_of"))
"""The annotations of a value that names something; a `cell_label` need not be in the cell."""
_NOTHING: Annotations = {}
_OWNED = ("link", "output", "input", "label", "tool")


class NameUse(msgspec.Struct, frozen=True, kw_only=True):
    """A name as it stands in a document.

    Attributes:
        kind: That of the thing: `robot`, `part`, `fixture`, `person`, `camera`, `link`, `output`, `label`, `tool`,
            `planner`, or the kind of an entry.
        name: With its owner: `left/panda_hand`.
        needs: The kind that the place requires: `gripper` of a robot, `detector` of a camera.
        path: The node; empty for a declaration of the document.
        keys: From the document inward to the name.
        below: Whether it is written without its owner.
    """

    kind: str
    name: str
    needs: str
    path: str
    keys: DataPath
    below: bool = False


class UndecidedName(msgspec.Struct, frozen=True, kw_only=True):
    """An expression that makes a name of the cell in a run."""

    path: str
    expression: str


class _Expected(msgspec.Struct, frozen=True):
    """What a place or key is to name: by annotations, or by the type of a whole parameter."""

    says: Annotations
    owner: object = None
    type: Any = None


class NameUses:
    """Finds the names of one cell in behaviors.

    Args:
        cell: The cell that the behaviors are written for.
        signature_of: Returns the signature of a state by its name; None for an unknown one.
    """

    def __init__(self, cell: Cell, signature_of: SignatureOf) -> None:
        self._cell = cell
        self._signature_of = signature_of
        self._expected: dict[int, dict[str, list[_Expected]]] = {}
        self._found: dict[int, dict[DataPath, NameUse]] = {}
        self.undecided: list[UndecidedName] = []
        """The expressions met so far that are more than a key."""

    def of(self, behavior: Behavior) -> tuple[NameUse, ...]:
        """Return the names in a document, each place once; not those in the behaviors that it refers to."""
        self._read(behavior)
        return tuple(self._found[id(behavior)].values())

    def _read(self, behavior: Behavior) -> Mapping[str, list[_Expected]]:
        """Return what each parameter and key of a behavior names, by its name."""
        known = self._expected.get(id(behavior))
        if known is not None:
            return known
        expected = self._expected[id(behavior)] = {}
        self._found[id(behavior)] = {}
        for path, node in behavior.nodes():
            for keys, value, due in self._values(behavior, path, node):
                self._take(behavior, path, keys, value, due, frozenset())
        return expected

    def _values(self, behavior: Behavior, path: str, node: NodeSpec) -> Iterator[tuple[DataPath, object, _Expected]]:
        inside = (*behavior.data_path(path), "with")
        signature = self._signature_of(node.state) if node.state is not None else None
        referred = behavior.references.get(node.behavior) if node.behavior is not None else None
        for name, value in node.parameters.items():
            if signature is not None and name in signature.parameters:
                annotation = signature.parameters[name].type
                if isinstance(value, str) and only_name(template(value)) is not None:
                    says = next((part.says for part in annotated_values(annotation, value)), _NOTHING)
                    yield (*inside, name), value, _Expected(says, _owner(behavior, node, says), annotation)
                    continue
                for part in annotated_values(annotation, value):
                    due = _Expected(part.says, _owner(behavior, node, part.says))
                    yield (*inside, name, *part.steps), part.value, due
            elif referred is not None:
                for due in self._read(referred).get(name, ()) if name in referred.parameters else ():
                    yield (*inside, name), value, due

    def _take(
        self, behavior: Behavior, path: str, keys: DataPath, value: object, due: _Expected, seen: frozenset[str]
    ) -> None:
        key = only_name(template(value)) if isinstance(value, str) else None
        if key is not None:
            if key not in seen:
                self._expected[id(behavior)].setdefault(key, []).append(due)
                for where, at, each in _definitions(behavior, key):
                    self._take(behavior, where, at, each, due, seen | {key})
            return
        if due.type is not None:
            parts = list(annotated_values(due.type, value))
            for part in parts:
                self._note(behavior, path, (*keys, *part.steps), part.value, _Expected(part.says, due.owner))
            if not parts and isinstance(value, list):
                # The choices of a parameter, or the items of a foreach, of which the key has one.
                for index, each in enumerate(cast("list[object]", value)):
                    self._take(behavior, path, (*keys, index), each, due, seen)
            return
        for steps, each in _plain_values(value):
            self._note(behavior, path, (*keys, *steps), each, due)

    def _note(self, behavior: Behavior, path: str, keys: DataPath, value: object, due: _Expected) -> None:
        if isinstance(value, str) and "${" in value:
            if due.says.keys() & _NAMING and only_name(template(value)) is None:
                self.undecided.append(UndecidedName(path=path, expression=value))
            return
        use = self._use(path, keys, value, due)
        if use is not None:
            self._found[id(behavior)].setdefault(keys, use)

    def _use(self, path: str, keys: DataPath, value: object, due: _Expected) -> NameUse | None:
        entry = due.owner if "entry_of" in due.says else due.says.get("entry")
        needs = is_kind(due.says.get("cell_name", due.says.get("cell_label")))
        if isinstance(entry, str) and isinstance(value, str) and value:
            return NameUse(kind=entry, name=value, needs=entry, path=path, keys=keys)
        is_number = needs in ("output", "input") and isinstance(value, int) and not isinstance(value, bool)
        besides = cast("Sequence[object]", due.says.get("or", ()))
        if needs is None or not (is_number or isinstance(value, str)) or value == "" or value in besides:
            return None
        below = due.says.get("of") is not None
        if below and not isinstance(due.owner, str):
            return None
        name = f"{due.owner}/{value}" if below else str(value)
        kind = thing_kind(self._cell, needs, name)
        return NameUse(kind=kind, name=name, needs=needs, path=path, keys=keys, below=below) if kind else None


def thing_kind(cell: Cell, needs: str, name: str) -> str:
    """Return which kind of thing of a cell a name means; empty for what the cell does not have, such as `world`."""
    document = cell.document
    if needs in (*_OWNED, "planner"):
        return needs
    if "/" in name:
        return "link"
    own = {"detector": "camera", "robot": "robot", "controller": "robot", **dict.fromkeys(tool_kinds(), "robot")}.get(
        needs
    )
    return next((kind for kind, names in document.named_things.items() if name in names and own in (None, kind)), "")


def _owner(behavior: Behavior, node: NodeSpec, says: Annotations) -> object:
    """Return the name that a name is below, or the kind of an entry, as far as the document says it."""
    of = says.get("of", says.get("entry_of"))
    value = node.parameters.get(str(of)) if of is not None else None
    key = only_name(template(value)) if isinstance(value, str) else None
    if key is None:
        return value
    return next((each for _, _, each in _definitions(behavior, key)), None)


def _definitions(behavior: Behavior, key: str) -> Iterator[tuple[str, DataPath, object]]:
    """Yield node path, place and value of everything in a document that gives a key its value."""
    data = cast("dict[str, object]", behavior.source.data)
    declared = _at(data, ("parameters", key))
    if isinstance(declared, dict):
        for name in ("default", "choices"):
            if name in declared:
                yield "", ("parameters", key, name), cast("object", declared[name])
    started = _at(data, ("userdata", key))
    if started is not None:
        yield "", ("userdata", key), started
    for path, node in behavior.nodes():
        here = behavior.data_path(path)
        body = _at(data, (*here, node.kind))
        if isinstance(body, dict):
            inside = cast("dict[str, object]", body)
            started = _at(inside, ("userdata", key))
            if started is not None:
                yield path, (*here, node.kind, "userdata", key), started
            if node.foreach is not None and node.foreach.item == key and "items" in inside:
                yield path, (*here, node.kind, "items"), inside["items"]
        for name, to in node.outputs.items():
            if to == key and name in node.parameters:
                yield path, (*here, "with", name), node.parameters[name]


def _at(value: object, keys: Sequence[str | int]) -> object:
    for key in keys:
        if isinstance(value, dict) and key in value:
            value = cast("dict[str | int, object]", value)[key]
        elif isinstance(value, list) and isinstance(key, int) and key < len(cast("list[object]", value)):
            value = cast("list[object]", value)[key]
        else:
            return None
    return value


def _plain_values(value: object) -> Iterator[tuple[DataPath, object]]:
    if isinstance(value, list | tuple):
        for index, each in enumerate(cast("list[object]", value)):
            yield from (((index, *steps), plain) for steps, plain in _plain_values(each))
    elif isinstance(value, dict):
        for key, each in cast("dict[str, object]", value).items():
            yield from (((key, *steps), plain) for steps, plain in _plain_values(each))
    else:
        yield (), value
