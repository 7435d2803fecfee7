"""Search by name over what a project and its cell have: behaviors and their nodes, entries, runs, items."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from heapq import nsmallest
from typing import Literal

import msgspec

from engine.document.nodes.node_kinds import node_icon
from engine.library.behavior_graph import GraphNode
from engine.library.behavior_library import BehaviorView

NameKind = Literal["behavior", "node", "state", "entry", "run", "item", "topic"]


class NameHit(msgspec.Struct, frozen=True, kw_only=True):
    """Something that has a name.

    `id` is that of a behavior, also for its node at `path`; the name of a state class; the name of an entry, of kind
    `path`; the id of a run; the address of an item of the cell, also for its topic `path`.
    `icon` is the name of the icon of a node, a state class or a behavior.
    """

    kind: NameKind
    id: str
    title: str
    detail: str
    path: str = ""
    icon: str = ""


def behavior_names(behaviors: Iterable[BehaviorView]) -> Iterator[NameHit]:
    """Yield behaviors and their nodes; nodes of behaviors that others refer to come with their own behavior only."""
    for each in behaviors:
        detail = f"{each.id} {each.description}".rstrip()
        yield NameHit(kind="behavior", id=each.id, title=each.name, detail=detail, icon=node_icon("behavior"))
        if each.graph is not None:
            yield from _nodes(each, each.graph)


def _nodes(behavior: BehaviorView, parent: GraphNode) -> Iterator[NameHit]:
    for node in parent.children if parent.kind != "behavior" else ():
        detail = f"{node.title} · {behavior.name} · {node.path}"
        yield NameHit(kind="node", id=behavior.id, path=node.path, title=node.name, detail=detail, icon=node.icon)
        yield from _nodes(behavior, node)


def search_names(text: str, names: Iterable[NameHit], *, limit: int) -> tuple[NameHit, ...]:
    """Return the names that have every word of a text, best first.

    A word in the title counts for more than one in the detail, its beginning for more than its middle; equal ones keep
    their order. Upper and lower case are the same.

    Args:
        text: Words, separated by blanks; without any nothing is found.
        names: What is searched.
        limit: The most that are returned.
    """
    words = text.lower().split()
    if not words:
        return ()
    ranked = ((_distance(words, name), number, name) for number, name in enumerate(names))
    best = nsmallest(limit, (each for each in ranked if each[0] is not None), key=lambda each: each[:2])
    return tuple(name for _, _, name in best)


def _distance(words: list[str], name: NameHit) -> int | None:
    """Return how far a name is from the words, 0 for the name itself; None if one of them is not in it."""
    title, detail = name.title.lower(), name.detail.lower()
    total = 0 if title == " ".join(words) else 1
    for word in words:
        if title.startswith(word):
            continue
        if word in title:
            total += 2
        elif word in detail:
            total += 5
        else:
            return None
    return total
