"""The difference of two graphs of a document: what a page needs to turn the graph it has into the new one."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping
from typing import Annotated

import msgspec
from msgspec import Meta

from engine.editing.analysis.document_graph import DrawnNode, Lines
from engine.library.behavior_graph import GraphTransition

# The text of a drawn node as it is kept; what it describes is a node of the graph.
DrawnNodeText = Annotated[msgspec.Raw, Meta(extra_json_schema={"$ref": "#/components/schemas/DocumentNode"})]


class GraphDifference(msgspec.Struct, frozen=True, kw_only=True):
    """How the graph of the text with the hash `base` becomes another one; nodes are named by path.

    `nodes` are those that are new or say something else, without children, transitions and lines. `children` are the
    names of all children, in order, where these changed; a node that is no child any more is gone. `arrows` are the
    transitions between children of a node, by the child that they leave, where they changed. `shifts` are pairs of a
    line of the old graph and a number of lines by which everything from there on moved; `lines` are line, column and
    last line of all other nodes.
    """

    base: str
    nodes: dict[str, DrawnNodeText]
    children: dict[str, tuple[str, ...]]
    arrows: dict[str, dict[str, tuple[GraphTransition, ...]]]
    shifts: tuple[tuple[int, int], ...]
    lines: dict[str, Lines]


def graph_difference(base: str, before: Mapping[str, DrawnNode], now: Mapping[str, DrawnNode]) -> GraphDifference:
    """Return the difference of two graphs, each by path.

    Args:
        base: The hash of the text of `before`.
        before: The old graph.
        now: The new graph.
    """
    nodes: dict[str, msgspec.Raw] = {}
    children: dict[str, tuple[str, ...]] = {}
    arrows: dict[str, dict[str, tuple[GraphTransition, ...]]] = {}
    kept: list[tuple[str, Lines, Lines]] = []
    lines: dict[str, Lines] = {}
    for path, node in now.items():
        was = before.get(path)
        if node.arrows != (was.arrows if was is not None else ()):
            container, _, name = path.rpartition("/")
            arrows.setdefault(container, {})[name] = node.arrows
        if was is None:
            nodes[path], children[path], lines[path] = msgspec.Raw(node.own), node.children, node.lines
            continue
        if was.own != node.own:
            nodes[path] = msgspec.Raw(node.own)
        if was.children != node.children:
            children[path] = node.children
        kept.append((path, was.lines, node.lines))
    shifts = _shifts(kept)
    begins, moves = [begin for begin, _ in shifts], [by for _, by in shifts]
    lines |= {path: new for path, old, new in kept if shifted(old, begins, moves) != new}
    return GraphDifference(base=base, nodes=nodes, children=children, arrows=arrows, shifts=tuple(shifts), lines=lines)


def shifted(lines: Lines, begins: list[int], moves: list[int]) -> Lines:
    """Return the lines of a node after shifts: the first old lines, in order, and by how much they moved."""
    first, last = bisect_right(begins, lines[0]) - 1, bisect_right(begins, lines[2]) - 1
    return (
        lines[0] + (moves[first] if first >= 0 else 0),
        lines[1],
        lines[2] + (moves[last] if last >= 0 else 0),
    )


def _shifts(kept: list[tuple[str, Lines, Lines]]) -> list[tuple[int, int]]:
    found: list[tuple[int, int]] = []
    by, furthest = 0, 0
    for _, old, new in sorted(kept, key=lambda each: each[1]):
        # A node that changed its place in the document moved by itself.
        if old[0] >= furthest and new[0] - old[0] != by:
            by = new[0] - old[0]
            found.append((old[0], by))
        furthest = max(furthest, old[0])
    return found
