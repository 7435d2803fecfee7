"""How the nodes of a document can end, as far as states and other documents say, also where it is not finished."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import cast

from engine.check.analyzed_behavior import Catalogue
from engine.check.entry_references import Entries
from engine.document.concurrency_condition import ConcurrencyCondition, deciding, read_entry
from engine.document.node_spec import FOREACH_OUTCOMES, TREE_OUTCOMES
from engine.document.signature import StateSignature, read_signature
from engine.document.yaml_source import load_source
from engine.editing.outline import MACHINES, NodeRef, Outline, Plain, transition_entries
from engine.errors import DocumentError, StateError


@dataclass(frozen=True)
class NodeOutcomes:
    """The outcomes of something, and those of them that mean that nothing went wrong."""

    outcomes: tuple[str, ...]
    success: tuple[str, ...]


StoredEntryNames = Callable[[Path], Entries | None]
"""The names, by kind, of the entries that the store of a cell holds, by the cell's file; None where it is not open."""


@dataclass
class ProjectContext:
    """What is known around a document.

    Args:
        catalogue: The states by name.
        folder: Where the document lies; references are relative to it.
        project: Folder that references may not lead out of.
        stored: What the stores of open cells hold.
    """

    catalogue: Catalogue
    folder: Path
    project: Path
    stored: StoredEntryNames = lambda _: None
    _known: dict[str, NodeOutcomes | None] = field(default_factory=dict[str, "NodeOutcomes | None"])

    def signature(self, state: str) -> StateSignature | None:
        """Return what a state declares; None where there is none, or it is broken."""
        try:
            found = self.catalogue.get(state)
            return read_signature(found) if found is not None else None
        except StateError:
            return None  # the check says what is wrong with it

    def file_of(self, reference: str) -> Path | None:
        """Return the file of a referred behavior; None where it is missing or outside of the project."""
        try:
            file = (self.folder / reference).resolve()
            return file if file.is_relative_to(self.project.resolve()) and file.is_file() else None
        except (OSError, ValueError):
            return None  # no path that this system can have

    def ends(self, outline: Outline, ref: NodeRef, *, known: dict[str, NodeOutcomes] | None = None) -> NodeOutcomes:
        """Return how a node can end, apart from timeouts, guards and errors.

        Args:
            outline: All nodes.
            ref: Which.
            known: What was found by path before, as long as nothing is changed; more comes to it.
        """
        if known is None:
            return self._found(outline, ref, {})
        found = known.get(ref.path)
        if found is None:
            found = known[ref.path] = self._found(outline, ref, known)
        return found

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
        signature = self.signature(name)
        return (
            NodeOutcomes(signature.outcomes, signature.success or signature.outcomes)
            if signature is not None
            else _used(data)
        )

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
        said = cast("Plain", data)
        outcomes = texts(said.get("outcomes"))
        return NodeOutcomes(outcomes, texts(said.get("success")) or outcomes)

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
        targets = [target for child in children.values() for _, _, target in transition_entries(child.data)]
        reached: dict[str, None] = {}
        due: list[object] = [ref.body.get("initial")]
        while due:
            name = due.pop()
            if not isinstance(name, str) or name in reached:
                continue
            reached[name] = None
            if name in children:
                good = self.ends(outline, children[name], known=known).success
                wired = children[name].data.get("transitions")
                due += (
                    [to for outcome, to in cast("Plain", wired).items() if outcome in good]
                    if isinstance(wired, dict)
                    else []
                )
        outside = dict.fromkeys(target for target in targets if target not in children)
        return NodeOutcomes(tuple(outside), tuple(name for name in outside if name in reached))


def rules(ref: NodeRef) -> list[ConcurrencyCondition]:
    """Return the conditions of a concurrency container in order; nothing for another node."""
    found: list[ConcurrencyCondition] = []
    listed = ref.body.get("conditions")
    for entry in cast("list[object]", listed) if isinstance(listed, list) else ():
        if isinstance(entry, dict):
            written = cast("Plain", entry)
            # One that says too much is shown as several.
            several = ({key: value} for key, value in written.items())
            each = (written,) if read_entry(written) is not None else several
            found += [rule for one in each if (rule := read_entry(one)) is not None]
    return found


def texts(value: object) -> tuple[str, ...]:
    """Return the text items of a list; nothing for anything else."""
    items: Iterable[object] = cast("list[object]", value) if isinstance(value, list) else ()
    return tuple(item for item in items if isinstance(item, str))


def _used(data: Plain) -> NodeOutcomes:
    transitions = data.get("transitions")
    used = tuple(cast("Plain", transitions)) if isinstance(transitions, dict) else ()
    return NodeOutcomes(used, used)
