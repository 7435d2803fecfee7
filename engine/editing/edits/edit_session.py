"""The session that edits work on: a draft, its nodes, and the update of references to renamed and moved nodes."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import cast

from engine.document.nodes.concurrency_condition import AT_LEAST, PREEMPT, WHEN
from engine.document.nodes.node_kind import MACHINES, NAMED, SLOTS
from engine.editing.project_context import NodeOutcomes, ProjectContext
from engine.editing.text.draft import Draft
from engine.editing.text.outline import NodeRef, Outline, Plain, targets_of, transition_entries

NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_-]{0,63}")
DanglingTarget = Callable[[Plain, str], "str | None"]
"""Returns the new target of a transition whose target left its container, from node and target; None removes it."""


class EditSession:
    """One document under edit; edits change its data, and call `stale` where nodes come, go or get other names."""

    def __init__(self, draft: Draft, context: ProjectContext, outline: Outline | None = None) -> None:
        self.draft = draft
        self.context = context
        self._changed: dict[int, Plain] = {}
        self._outline = outline

    @property
    def outline(self) -> Outline:
        """The current nodes."""
        if self._outline is None:
            self._outline = Outline(self.draft.data)
        return self._outline

    def stale(self) -> None:
        """Mark the outline as outdated; it is rebuilt on the next access."""
        self._outline = None

    def at(self, path: str) -> NodeRef:
        """Return a node; raises EditRefused if there is no such node."""
        return self.outline.at(path)

    def ends(self, ref: NodeRef) -> NodeOutcomes:
        """Return the outcomes of a node."""
        return self.context.ends(self.outline, ref)

    def mark(self, node: Plain) -> None:
        """Record that a node was created or changed."""
        self._changed[id(node)] = node

    def changed(self) -> tuple[str, ...]:
        """Return the paths of the nodes that were created or changed and still exist, in the order of the edits."""
        paths = {id(ref.data): path for path, ref in self.outline.refs.items()}
        return tuple(paths[known] for known in self._changed if known in paths)

    def free_name(self, container: NodeRef, name: str, taken: Iterable[str] = ()) -> str:
        """Return a free name for a new child: this one, or with a number; never an outcome of the container."""
        base = re.sub(r"[^A-Za-z0-9_-]+", "_", name).lstrip("-")[:56] or "node"
        used = {*(child.name for child in self.outline.children(container)), *taken}
        if container.kind in MACHINES:
            used |= set(self.outcomes_inside(container))
        number, name = 2, base
        while name in used:
            name = f"{base}_{number}"
            number += 1
        return name

    def outcomes_inside(self, container: NodeRef) -> tuple[str, ...]:
        """Return the transition targets of children of a machine other than its children."""
        is_machine = container.kind in MACHINES and not isinstance(container.data.get("behavior"), str)
        led_to = self.context.outside_machine(self.outline, container) if is_machine else self.ends(container).outcomes
        return tuple(dict.fromkeys((*led_to, *self._meant_outcomes(container))))

    def _meant_outcomes(self, container: NodeRef) -> tuple[str, ...]:
        """Return the declared outcomes, whether or not anything inside leads to them yet."""
        if container.parent is not None:
            transitions = container.data.get("transitions")
            return tuple(map(str, cast("Plain", transitions))) if isinstance(transitions, dict) else ()
        listed = self.draft.data.get("outcomes")
        return tuple(map(str, cast("list[object]", listed))) if isinstance(listed, list) else ()


def named_children(container: NodeRef) -> Plain:
    """Return the mapping of named children of a container, as written; it is created if missing."""
    body = container.data.get(container.kind)
    if not isinstance(body, dict):
        body = container.data[container.kind] = {}
    inside = cast("Plain", body)
    if not isinstance(inside.get("states"), dict):
        inside["states"] = {}
    return cast("Plain", inside["states"])


def rename_key(mapping: Plain, old: str, new: str) -> None:
    """Rename a key of a mapping; the entry keeps its position."""
    kept = {new if key == old else key: value for key, value in mapping.items()}
    mapping.clear()
    mapping.update(kept)


def insert_key(mapping: Plain, key: str, value: object, index: int | None) -> None:
    """Insert an entry into a mapping at a position; by default at the end."""
    items = list(mapping.items())
    items.insert(len(items) if index is None else max(0, index), (key, value))
    mapping.clear()
    mapping.update(items)


def assign_child_roles(container: NodeRef, nodes: list[Plain]) -> None:
    """Assign roles to the children of a tree node with roles, in order: the roles that were taken before."""
    taken = [key for key in SLOTS[container.kind] if isinstance(container.body.get(key), dict)]
    container.body.update(zip(taken, nodes, strict=True))


def remove_entry(node: Plain, key: str, entry: str) -> None:
    """Remove an entry from a mapping of a node, and the mapping itself with its last entry."""
    mapping = node.get(key)
    if isinstance(mapping, dict):
        cast("Plain", mapping).pop(entry, None)
        if not mapping:
            del node[key]


@dataclass
class ReferenceUpdate:
    """Keeps references valid while nodes are renamed, moved and removed.

    Create it before the nodes change; `finish` then updates transitions, initial children, conditions, policies, canvas
    positions and all notes to the new paths of the nodes.
    """

    session: EditSession
    _refs: list[NodeRef] = field(default_factory=list[NodeRef])

    def __post_init__(self) -> None:
        self._refs = list(self.session.outline.refs.values())

    def finish(self, *, instead: dict[int, str] | None = None, dangling: DanglingTarget | None = None) -> None:
        """Update all references.

        Args:
            instead: New target name for nodes that left a container, by the id of their data.
            dangling: Returns the new target of transitions whose target is no sibling any more; without it they are
                removed.
        """
        self.session.stale()
        after = {id(ref.data): ref for ref in self.session.outline.refs.values()}
        before = {ref.path: ref for ref in self._refs}
        inside: dict[str, dict[str, NodeRef]] = {ref.path: {} for ref in self._refs}
        moved: dict[str, set[str]] = {}
        for ref in self._refs:
            if ref.parent is not None:
                inside[ref.parent.path][ref.name] = ref
                now = after.get(id(ref.data))
                if now is None or now.name != ref.name or not _is_inside(now, ref.parent):
                    moved.setdefault(ref.parent.path, set()).add(ref.name)
        for ref in self._refs:
            now = after.get(id(ref.data))
            if now is None:
                continue
            if ref.path in moved:
                self._follow_container(now, inside[ref.path], after, instead or {})
            around = ref.parent
            if around is None or around.kind not in NAMED or around.path not in moved:
                continue
            # What stays where it is follows only what moved.
            gone = moved[around.path]
            if ref.name in gone or not gone.isdisjoint(targets_of(now.data)):
                self._follow_leads(now, around, inside[around.path], after, instead or {}, dangling)
        for key in ("view", "notes", "canvas_notes"):
            self._follow_paths(key, before, after)

    def _follow_leads(
        self,
        now: NodeRef,
        home: NodeRef,
        beside: dict[str, NodeRef],
        after: dict[int, NodeRef],
        instead: dict[int, str],
        dangling: DanglingTarget | None,
    ) -> None:
        for mapping, key, target in list(transition_entries(now.data)):
            meant = beside.get(target)
            there = after.get(id(meant.data)) if meant is not None else None
            if there is not None and _beside(there, now):
                self._lead(now.data, mapping, key, there.name)
                continue
            stays = now.parent is not None and now.parent.data is home.data
            if meant is None and stays:
                continue
            to = instead.get(id(meant.data)) if meant is not None and stays else None
            if to is None and dangling is not None:
                to = dangling(now.data, target)
            self._lead(now.data, mapping, key, to)

    def _lead(self, node: Plain, mapping: Plain, key: str, target: str | None) -> None:
        if target is not None:
            if mapping[key] != target:
                mapping[key] = target
        elif mapping is node.get("transitions"):
            remove_entry(node, "transitions", key)

    def _follow_container(
        self, now: NodeRef, inside: dict[str, NodeRef], after: dict[int, NodeRef], instead: dict[int, str]
    ) -> None:
        names: dict[str, str | None] = {}
        for name, child in inside.items():
            there = after.get(id(child.data))
            stays = there is not None and there.parent is not None and there.parent.data is now.data
            names[name] = there.name if stays and there is not None else instead.get(id(child.data))
        if all(name == to for name, to in names.items()):
            return
        body = now.body
        if now.kind in MACHINES:
            self._follow_initial(now, body, names)
        elif now.kind == "concurrency":
            _follow_conditions(body, names)
        elif now.kind == "parallel" and isinstance(body.get("policy"), list):
            policy = cast("list[object]", body["policy"])
            kept = [to for name in policy if (to := names.get(str(name), str(name))) is not None]
            if kept:
                policy[:] = kept
            else:
                del body["policy"]

    def _follow_initial(self, now: NodeRef, body: Plain, names: dict[str, str | None]) -> None:
        initial = body.get("initial")
        if not isinstance(initial, str) or initial not in names:
            return
        first = next((child.name for child in self.session.outline.children(now)), None)
        to = names[initial] or first
        if to is None:
            del body["initial"]
        elif to != initial:
            body["initial"] = to

    def _follow_paths(self, key: str, before: dict[str, NodeRef], after: dict[int, NodeRef]) -> None:
        places = self.session.draft.data.get(key)
        if not isinstance(places, dict):
            return
        known = cast("Plain", places)
        kept: Plain = {}
        for path, value in known.items():
            ref = before.get(path)
            now = after.get(id(ref.data)) if ref is not None else None
            if ref is None:
                kept[path] = value
            elif now is not None:
                kept[now.path] = value
        if list(kept) == list(known):
            return
        known.clear()
        known.update(kept)
        if not known:
            del self.session.draft.data[key]


def _is_inside(node: NodeRef, container: NodeRef) -> bool:
    return node.parent is not None and node.parent.data is container.data


def _beside(one: NodeRef, two: NodeRef) -> bool:
    return one.parent is not None and two.parent is not None and one.parent.data is two.parent.data


def _follow_conditions(body: Plain, names: dict[str, str | None]) -> None:
    listed = body.get("conditions")
    if not isinstance(listed, list):
        return
    conditions = cast("list[object]", listed)
    emptied: list[object] = []
    for entry in conditions:
        if not isinstance(entry, dict):
            continue
        written = cast("Plain", entry)
        for value in written.values():
            if isinstance(value, dict):
                _follow_when(cast("Plain", value), names)
        preempted = written.get(PREEMPT)
        if isinstance(preempted, list):
            _follow_preempted(cast("list[object]", preempted), names)
        if all(value in ({}, []) for value in written.values()) or preempted == [] or written.get(WHEN) == {}:
            emptied.append(written)
    conditions[:] = [entry for entry in conditions if not any(entry is gone for gone in emptied)]


def _follow_preempted(listed: list[object], names: dict[str, str | None]) -> None:
    kept: list[object] = []
    for name in listed:
        to = names.get(name, name) if isinstance(name, str) else name
        if to is not None and to not in kept:
            kept.append(to)
    if kept != listed:
        listed[:] = kept


def _follow_when(when: Plain, names: dict[str, str | None]) -> None:
    if not any(name in names and names[name] != name for name in when):
        return
    kept: Plain = {}
    for name, due in when.items():
        to = names.get(name, name) if isinstance(due, str) else name
        if to is not None:
            kept[to] = due
    children = sum(isinstance(due, str) for due in kept.values())
    count = kept.get(AT_LEAST)
    if isinstance(count, int) and count > children:
        del kept[AT_LEAST]
    when.clear()
    when.update(kept)
