"""Outcomes of the nodes of a document, from states and other documents; the document may be incomplete."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from engine.check.analyzed_behavior import Catalogue
from engine.check.cell.entry_references import Entries
from engine.document.nodes.concurrency_condition import ConcurrencyCondition, deciding, read_entry
from engine.document.nodes.node_kind import MACHINES
from engine.document.nodes.node_spec import FOREACH_OUTCOMES, TREE_OUTCOMES
from engine.document.signature import StateSignature, read_signature
from engine.document.text.yaml_source import load_source
from engine.editing.text.outline import NodeRef, Outline, Plain, targets_of
from engine.errors import DocumentError, StateError


@dataclass(frozen=True)
class NodeOutcomes:
    """The outcomes of a node, and those of them that are a success."""

    outcomes: tuple[str, ...]
    success: tuple[str, ...]


StoredEntryNames = Callable[[Path], Entries | None]
"""Returns the names, by kind, of the entries in the store of a cell, by the cell's file; None if it is not open."""


@dataclass
class ProjectContext:
    """Context of a document: states, stores, and the files that it may reference.

    Args:
        catalogue: The states by name.
        folder: Folder of the document; references are relative to it.
        project: Folder that references must not leave.
        stored: Entries in the stores of open cells.
    """

    catalogue: Catalogue
    folder: Path
    project: Path
    stored: StoredEntryNames = lambda _: None
    _known: dict[str, NodeOutcomes | None] = field(default_factory=dict[str, "NodeOutcomes | None"])
    _of_states: dict[str, NodeOutcomes | None] = field(default_factory=dict[str, "NodeOutcomes | None"])

    def signature(self, state: str) -> StateSignature | None:
        """Return the signature of a state; None if there is no such state, or it is broken."""
        try:
            found = self.catalogue.get(state)
            return read_signature(found) if found is not None else None
        except StateError:
            return None  # the check says what is wrong with it

    def file_of(self, reference: str) -> Path | None:
        """Return the file of a referenced behavior; None if it is missing or outside the project."""
        try:
            file = (self.folder / reference).resolve()
            return file if file.is_relative_to(self.project.resolve()) and file.is_file() else None
        except (OSError, ValueError):
            return None  # not a valid path on this system

    def ends(self, outline: Outline, ref: NodeRef, *, known: dict[str, NodeOutcomes] | None = None) -> NodeOutcomes:
        """Return the outcomes of a node, without those of timeouts, guards and errors.

        Args:
            outline: All nodes.
            ref: The node.
            known: Cache of results by path, valid until the document changes; this call adds to it.
        """
        if known is None:
            return self._found(outline, ref, {})
        found = known.get(ref.path)
        if found is None:
            found = known[ref.path] = self._found(outline, ref, known)
        return found

    def outside_machine(self, outline: Outline, ref: NodeRef) -> tuple[str, ...]:
        """Return the outcomes of a machine to which its children lead."""
        return _outside({child.name: child for child in outline.children(ref)})

    def _found(self, outline: Outline, ref: NodeRef, known: dict[str, NodeOutcomes]) -> NodeOutcomes:
        data = ref.data
        if isinstance(data.get("state"), str):
            return self._of_state(str(data["state"]), data)
        if isinstance(data.get("behavior"), str):
            return self._of_reference(str(data["behavior"])) or _used(data)
        if ref.kind == "concurrency":
            return self._of_concurrency(outline, ref, known)
        if ref.kind == "foreach":
            return NodeOutcomes(FOREACH_OUTCOMES, FOREACH_OUTCOMES[:1])
        if ref.kind in MACHINES:
            return self._of_machine(outline, ref, known)
        return NodeOutcomes(TREE_OUTCOMES, TREE_OUTCOMES[:1])

    def _of_state(self, name: str, data: Plain) -> NodeOutcomes:
        if name not in self._of_states:
            found = self.signature(name)
            ends = NodeOutcomes(found.outcomes, found.success or found.outcomes) if found is not None else None
            self._of_states[name] = ends
        return self._of_states[name] or _used(data)

    def _of_reference(self, written: str) -> NodeOutcomes | None:
        if written not in self._known:
            self._known[written] = self._read(written)
        return self._known[written]

    def _read(self, written: str) -> NodeOutcomes | None:
        file = self.file_of(written)
        try:
            data = load_source(file).data if file is not None else None
        except DocumentError:
            return None  # the check says what is wrong with it
        if not isinstance(data, dict):
            return None
        document = cast("Plain", data)
        outcomes = texts(document.get("outcomes"))
        return NodeOutcomes(outcomes, texts(document.get("success")) or outcomes)

    def _of_concurrency(self, outline: Outline, ref: NodeRef, known: dict[str, NodeOutcomes]) -> NodeOutcomes:
        found = rules(ref)
        otherwise = ref.body.get("otherwise")
        found = deciding(found)
        named = [*(rule.outcome for rule in found), *([otherwise] if isinstance(otherwise, str) else [])]
        good = {child.name: self.ends(outline, child, known=known).success for child in outline.children(ref)}
        nominal = [rule.outcome for rule in found if rule.asks_only_for(lambda name, due: due in good.get(name, ()))]
        return NodeOutcomes(tuple(dict.fromkeys(named)), tuple(dict.fromkeys(nominal)))

    def _of_machine(self, outline: Outline, ref: NodeRef, known: dict[str, NodeOutcomes]) -> NodeOutcomes:
        children = {child.name: child for child in outline.children(ref)}
        outside = _outside(children)
        reached: set[str] = set()
        due: list[object] = [ref.body.get("initial")]
        while due:
            name = due.pop()
            if not isinstance(name, str) or name in reached:
                continue
            reached.add(name)
            child = children.get(name)
            wired = child.data.get("transitions") if child is not None else None
            if child is not None and isinstance(wired, dict):
                good = self.ends(outline, child, known=known).success
                due += [to for outcome, to in cast("Plain", wired).items() if outcome in good]
        return NodeOutcomes(outside, tuple(name for name in outside if name in reached))


def rules(ref: NodeRef) -> list[ConcurrencyCondition]:
    """Return the conditions of a concurrency container in order; empty for another node."""
    found: list[ConcurrencyCondition] = []
    listed = ref.body.get("conditions")
    for entry in cast("list[object]", listed) if isinstance(listed, list) else ():
        if isinstance(entry, dict):
            written = cast("Plain", entry)
            # A condition with several consequences is shown as several conditions.
            several = ({key: value} for key, value in written.items())
            each = (written,) if read_entry(written) is not None else several
            found += [rule for one in each if (rule := read_entry(one)) is not None]
    return found


def texts(value: object) -> tuple[str, ...]:
    """Return the text items of a list; empty for another value."""
    items: Iterable[object] = cast("list[object]", value) if isinstance(value, list) else ()
    return tuple(item for item in items if isinstance(item, str))


def _outside(children: Mapping[str, NodeRef]) -> tuple[str, ...]:
    """Return the targets of children of a machine other than its children."""
    found: dict[str, None] = {}
    for child in children.values():
        found.update(dict.fromkeys([target for target in targets_of(child.data) if target not in children]))
    return tuple(found)


def _used(data: Plain) -> NodeOutcomes:
    transitions = data.get("transitions")
    used = tuple(cast("Plain", transitions)) if isinstance(transitions, dict) else ()
    return NodeOutcomes(used, used)
