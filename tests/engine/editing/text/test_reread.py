"""A text that is read again after an edit has the tree of a full read, and shares what did not change."""

from __future__ import annotations

import random
from collections.abc import Callable
from functools import partial

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from benchmarks.edits import flat_document
from benchmarks.large_document import large_document
from engine.editing import Draft, apply_edits
from engine.editing.edits.apply import apply_edits_to_draft
from engine.editing.text.outline import Outline
from engine.editing.text.reread import is_equal_data
from engine.editing.text.syntax import Member, Scalar, Syntax
from engine.errors import DocumentError
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


def _nodes(outline: Outline) -> list[object]:
    return [
        (ref.path, ref.name, ref.kind, ref.keys, id(ref.data), ref.parent and ref.parent.path)
        for ref in outline.refs.values()
    ]


def _check(draft: Draft) -> None:
    again = Draft(draft.given, file=draft.file)
    collections, others = list(draft.collections()), list(again.collections())
    assert _shape(collections[0]) == _shape(others[0])
    assert all(draft.source_of(found.data) is found and found.origin is draft.origin for found in collections)
    assert len(draft.sources) == len(collections)
    assert draft.data == again.data


@settings(max_examples=examples(60, nightly=200), deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_any_edits_leave_the_tree_of_a_full_read(data: Plain, chance: random.Random, draw: st.DataObject) -> None:
    draft = Draft(Layout(chance).document(data), file="x.yaml")
    for _ in range(3):
        edits, problem = read_edits([draw.draw(any_edits(list(Outline(draft.data).refs)))])
        assume(problem is None)
        text = draft.given
        done = apply_edits_to_draft(draft, edits, context=context(), outline=Outline(draft.data))
        draft = done.draft or Draft(text, file="x.yaml")
        _check(draft)
        if done.outline is not None:
            assert _nodes(done.outline) == _nodes(Outline(draft.data))


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


@settings(max_examples=150, deadline=None)
@given(data=behaviors(), chance=chances, draw=st.data())
def test_any_other_text_is_read_as_by_a_full_read(data: Plain, chance: random.Random, draw: st.DataObject) -> None:
    """Text that was typed: lines removed, repeated, moved, replaced, indented."""
    text = Layout(chance).document(data)
    draft = Draft(text, file="x.yaml")
    for _ in range(3):
        text = _typed(text, draw)
        refusal = _refusal(partial(Draft, file="x.yaml"), text)
        if refusal is not None:
            assert _refusal(draft.reread, text) == refusal
            return
        draft = draft.reread(text)
        assert is_equal_data(draft.data, Draft(text, file="x.yaml").data)
        _check(draft)


def _refusal(read: Callable[[str], Draft], text: str) -> tuple[str, object] | None:
    try:
        read(text)
    except DocumentError as error:
        return error.message, error.where
    return None


def _typed(text: str, draw: st.DataObject) -> str:
    lines = text.split("\n")
    number = draw.draw(st.integers(0, len(lines) - 1))
    other = draw.draw(st.integers(0, len(lines) - 1))
    line = lines[number]
    match draw.draw(st.sampled_from(["remove", "repeat", "move", "indent", "cut", "put", "insert"])):
        case "remove":
            del lines[number]
        case "repeat":
            lines.insert(other, line)
        case "move":
            lines.insert(other, lines.pop(number))
        case "indent":
            lines[number] = draw.draw(st.sampled_from(["  " + line, line[2:], line[1:]]))
        case "cut":
            lines[number] = line[: draw.draw(st.integers(0, len(line)))]
        case "put":
            lines[number] = line + draw.draw(st.sampled_from(TYPED))
        case _:
            indent = " " * (len(line) - len(line.lstrip(" ")))
            lines.insert(number, indent + draw.draw(st.sampled_from(TYPED)))
    return "\n".join(lines)


TYPED = (
    "", " ", "# note", "x:", "x: 1", "state: flow.Wait", "'", '"', "{", "}", "[", "|", ">", "a: |", "- x", ": ", "---",
    "...", "  deeper: 1", "root:", "view: {}", "&a", "? x", "\t", "x: {a: 1,", "x: 'a", "y: 'b'", "é", "%TAG",
)  # fmt: skip


def test_a_step_back_reads_only_what_differs() -> None:
    text = flat_document(50)
    draft = Draft(text, file="x.yaml")
    edits, _ = read_edits([{"edit": "rename_node", "path": "root/s7", "name": "other"}])
    done = apply_edits_to_draft(draft, edits, context=context())
    assert done.draft is not None
    before = {id(found) for found in done.draft.collections()}
    back = done.draft.reread(text)
    _check(back)
    assert sum(id(found) not in before for found in back.collections()) <= 12
