"""A text that is read again after an edit has the tree of a full read, and shares what did not change."""

from __future__ import annotations

import random

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from benchmarks.edits import flat_document
from benchmarks.large_document import large_document
from engine.editing import Draft, apply_edits
from engine.editing.apply import apply_edits_to_draft
from engine.editing.outline import Outline
from engine.editing.syntax import Member, Scalar, Syntax
from tests.engine.check.random_behaviors import behaviors
from tests.engine.editing.edit_fixtures import context, read_edits
from tests.engine.editing.layouts import Layout, Plain, chances
from tests.engine.editing.random_edits import any_edits
from tests.tiers import examples

HEAD = "flexcell: 1\nname: x\noutcomes: [done]\nroot:\n"
WAIT = "      {name}: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: {to}}}}}\n"
TEXT = (
    HEAD
    + "  # Above the machine.\n  machine:\n    initial: a\n    states:\n"
    + WAIT.format(name="a", to="b")
    + "      # Of b.\n      b:\n        state: flow.Log\n        with:\n"
    + "          message: |\n            one\n\n            two\n"
    + "        transitions: {done: c}\n\n"
    + WAIT.format(name="c", to="done")
    + "        # Deeper, below c.\nview:\n  root/a: [1, 2]\n"
)


def _shape(found: Syntax | Member | None) -> object:
    """Everything that is known of a part of a text."""
    if found is None or isinstance(found, Scalar):
        return found and (found.start, found.end, found.value, found.style)
    if isinstance(found, Member):
        return found.start, found.at, _shape(found.key), _shape(found.value), found.stop
    return found.start, found.end, found.flow, found.column, found.data, [_shape(each) for each in found.members]


def _check(draft: Draft) -> None:
    again = Draft(draft.given, file=draft.file)
    collections, others = list(draft.collections()), list(again.collections())
    assert _shape(collections[0]) == _shape(others[0])
    assert all(draft.source_of(found.data) is found and found.origin is draft.origin for found in collections)
    assert draft.data == again.data


@settings(max_examples=examples(60, nightly=200), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_any_edits_leave_the_tree_of_a_full_read(data: Plain, chance: random.Random, draw: st.DataObject) -> None:
    draft = Draft(Layout(chance).document(data), file="x.yaml")
    for _ in range(3):
        edits, problem = read_edits([draw.draw(any_edits(list(Outline(draft.data).refs)))])
        assume(problem is None)
        text = draft.given
        done = apply_edits_to_draft(draft, edits, context=context())
        draft = done.draft or Draft(text, file="x.yaml")
        _check(draft)


@pytest.mark.parametrize("text", [TEXT, TEXT.rstrip("\n"), flat_document(20), large_document(80)])
def test_edits_of_every_kind_leave_the_tree_of_a_full_read(text: str) -> None:
    refs = [ref for ref in Outline(Draft(text, file="x.yaml").data).refs.values() if ref.parent is not None]
    for ref in refs[:: max(1, len(refs) // 12)]:
        for raw in (
            {"edit": "set_positions", "positions": {ref.path: [7, 9]}},
            {"edit": "set_field", "path": ref.path, "field": "notes", "value": "a note"},
            {"edit": "set_field", "path": ref.path, "field": "description", "value": "one\ntwo"},
            {"edit": "rename_node", "path": ref.path, "name": "another"},
            {"edit": "duplicate", "paths": [ref.path]},
            {"edit": "remove_nodes", "paths": [ref.path]},
        ):
            edits, _ = read_edits([raw])
            done = apply_edits(text, edits, file="x.yaml", context=context())
            if done.draft is not None:
                _check(done.draft)


def test_only_what_differs_is_read_again() -> None:
    draft = Draft(flat_document(50), file="x.yaml")
    before = {id(found): found for found in draft.collections()}
    edits, _ = read_edits([{"edit": "set_parameter", "path": "root/s7", "name": "duration_s", "value": 3}])
    done = apply_edits_to_draft(draft, edits, context=context())
    assert done.draft is not None
    fresh = [found for found in done.draft.collections() if id(found) not in before]
    texts = [done.text[found.start : found.end].strip() for found in fresh if len(found.members) < 4]
    assert "{duration_s: 3}" in texts
    assert len(fresh) <= 7
