"""Edits and what the server makes of them, for the page's tests: the page shows some before the server has answered.

`python -m tests.engine.editing.optimistic_examples` writes them anew.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from textwrap import dedent

import msgspec

from engine.editing import Draft
from engine.editing.analysis.document_graph import DocumentNode
from engine.editing.analysis.graph_difference import GraphDifference
from engine.editing.draft_cache import DraftCache
from engine.editing.text.outline import NodeRef, Outline, transition_entries
from tests.engine.editing.edit_fixtures import context, read_edits
from tests.engine.editing.layouts import Plain

EXAMPLES = Path(__file__).parents[3] / "editor_web" / "frontend" / "testing" / "optimistic_edits.jsonl"
FILE = Path("no-such-project/x.yaml")
_TEXT = """\
flexcell: 1
name: both
outcomes: [good, bad]
root:
  machine:
    initial: look
    states:
      look: {state: test.Give, timeout: {after: 3 s, to: wait}, transitions: {a: wait, b: inside, c: bad}}
      wait:
        state: test.Count
        on_error: look
        disabled: full
        transitions: {more: look, full: inside}
      inside:
        machine:
          initial: one
          states:
            one: {state: test.Give, guard: {when: "true", to: two}, transitions: {a: two, b: one, c: lost}}
            two: {state: test.Count, transitions: {more: one}}
            three: {priority: {initial: first, states: {
              first: {state: test.Count, transitions: {more: first, full: over}}}}, transitions: {over: lost}}
        transitions: {lost: both}
      both:
        concurrency:
          states:
            left: {state: test.Give}
            right: {state: test.Count}
          conditions: [{good: {left: a}}]
          otherwise: bad
        transitions: {good: good, bad: branch}
      branch:
        tree: {sequence: [{state: test.Give}, {selector: [{state: test.Count}, {state: test.Count}]}]}
        transitions: {success: good, failure: look_2}
      look_2: {state: test.Give, transitions: {a: good, b: good, c: bad}}
      alone: {state: test.Count}
view: {root/look: [0, 0], root/wait: [300, 20.5], root/inside/one: [10, 10], root/inside/two: [200, 10]}
notes: {root/look: begins here, root/inside/one: the first}
"""


class Example(msgspec.Struct, frozen=True, kw_only=True):
    """Edits, and the difference that they make to the graph; None where they are refused."""

    edits: list[Plain]
    difference: GraphDifference | None


class Examples(msgspec.Struct, frozen=True, kw_only=True):
    """Edits of one graph."""

    graph: DocumentNode
    examples: list[Example]


def examples() -> Examples:
    """Return each edit that the page may know, made at each node."""
    text = dedent(_TEXT)
    drafts, known = DraftCache(), context(FILE.parent)
    drawn = drafts.draw(text, file=FILE, context=known)
    assert drawn.graph is not None
    made: list[Example] = []
    for raw in _edits(Outline(Draft(text, file="x.yaml").data)):
        edits, problem = read_edits(raw)
        assert problem is None, problem
        answer = drafts.edit(text, edits, file=FILE, context=known, graph=drawn.hash)
        made.append(Example(edits=raw, difference=answer.difference if answer.refused is None else None))
        # The graph that an answer is the difference from is the one drawn last.
        drafts.draw(text, file=FILE, context=known)
    return Examples(graph=drawn.graph, examples=made)


def _edits(outline: Outline) -> Iterator[list[Plain]]:
    for path, ref in outline.refs.items():
        yield [{"edit": "duplicate", "paths": [path]}]
        yield [{"edit": "remove_nodes", "paths": [path]}]
        yield [{"edit": "rename_node", "path": path, "name": "other"}]
        if ref.parent is not None:
            yield [{"edit": "set_initial", "path": ref.parent.path, "child": ref.name}]
            yield from _transitions(outline, ref, ref.parent)
    yield [{"edit": "set_transition", "path": "root/alone", "outcome": "full", "target": "look"}]
    yield [{"edit": "set_transition", "path": "root/alone", "outcome": "unknown", "target": "look"}]
    yield [{"edit": "clear_transition", "path": "root/alone", "outcome": "full"}]
    yield [{"edit": "duplicate", "paths": ["root/look", "root/wait"]}]
    yield [{"edit": "duplicate", "paths": ["root/both/right", "root/both/left"]}]
    yield [{"edit": "remove_nodes", "paths": ["root/look", "root/wait"]}]
    yield [{"edit": "rename_node", "path": "root/look", "name": "good"}]
    yield [
        {"edit": "duplicate", "paths": ["root/alone"]},
        {"edit": "rename_node", "path": "root/alone_2", "name": "third"},
    ]


def _transitions(outline: Outline, ref: NodeRef, parent: NodeRef) -> Iterator[list[Plain]]:
    targets = (outline.children(parent)[-1].name, "good")
    for _, outcome, _ in list(transition_entries({"transitions": ref.data.get("transitions")}))[:2]:
        yield [{"edit": "clear_transition", "path": ref.path, "outcome": outcome}]
        for target in targets:
            yield [{"edit": "set_transition", "path": ref.path, "outcome": outcome, "target": target}]


def encoded() -> bytes:
    """Return the graph, and below it the examples, each as JSON in a line."""
    made = examples()
    return b"".join(msgspec.json.encode(each) + b"\n" for each in (made.graph, *made.examples))


if __name__ == "__main__":
    EXAMPLES.write_bytes(encoded())
