"""Free notes on the canvas: added, changed, moved, followed, merged and compared, without a meaning for a run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
import pytest

from engine.document import Behavior, parse_behavior
from engine.editing.analysis.document_diff import compare_texts
from engine.editing.text.node_merge import merge_by_nodes
from engine.errors import DocumentError
from tests.engine.editing.edit_fixtures import changed, difference, edited, read_edits, refusal
from tests.engine.editing.edits.test_node_edits import TEXT

NOTE = {"text": "Mind the gap", "position": [40, -20.04], "size": [200, 90], "colour": "blue"}
NESTED = """\
flexcell: 1
name: nested
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: inner
    states:
      inner:
        machine:
          initial: one
          states:
            one: {state: test.Give, transitions: {a: good, b: bad, c: bad}}
        transitions: {good: good, bad: bad}
view:
  root/inner: [100, 200]
canvas_notes:
  root:
    n1: {text: outside, position: [0, 0], size: [200, 90], colour: grey}
  root/inner:
    n1: {text: inside, position: [10, 20], size: [200, 90], colour: pink}   # by the night shift
"""


def note(path: str = "root/both", name: str = "n1", **other: object) -> dict[str, Any]:
    return {"edit": "set_canvas_note", "path": path, "name": name, "note": {**NOTE, **other}}


def parsed(text: str) -> Behavior:
    return parse_behavior(text, file=Path("x.yaml"))


def test_a_note_is_added_changed_and_removed() -> None:
    made = edited(TEXT, note())
    assert difference(TEXT, made) == [
        "+canvas_notes:",
        "+  root/both:",
        "+    n1: {text: Mind the gap, position: [40, -20], size: [200, 90], colour: blue}",
    ]
    more = edited(made, note(name="n2", text="and here"))
    assert difference(made, more) == [
        "+    n2: {text: and here, position: [40, -20], size: [200, 90], colour: blue}",
    ]
    moved = edited(made, note(position=[50, 0], text="Two\nlines", colour="green"))
    assert '    n1: {text: "Two\\nlines", position: [50, 0], size: [200, 90], colour: green}' in moved
    assert edited(moved, {**note(), "note": None}) == TEXT
    assert changed(TEXT, note()) == ("root/both",)
    assert "no note `n2`" in refusal(made, {**note(name="n2"), "note": None})


def test_a_comment_behind_a_note_stays() -> None:
    made = edited(NESTED, note("root/inner", text="inside", position=[10, 20], colour="yellow"))
    assert "colour: yellow}   # by the night shift\n" in made


@pytest.mark.parametrize(
    "other", [{"colour": "#ff0000"}, {"size": [1, 90]}, {"position": [1e9, 0]}, {"text": 3}, {"angle": 1}]
)
def test_a_note_with_a_mistake_is_no_edit_and_refused_where_it_stands(other: dict[str, Any]) -> None:
    made = note()
    assert read_edits([{**made, "note": {**NOTE, **other}}])[1] is not None
    wrong = msgspec.json.encode({**NOTE, **other}).decode()
    with pytest.raises(DocumentError) as refused:
        parsed(NESTED + f"    n2: {wrong}\n")
    assert str(refused.value.where).startswith("x.yaml:22:")


def test_notes_follow_a_container_that_gets_another_name_and_go_with_it() -> None:
    renamed = edited(NESTED, {"edit": "rename_node", "path": "root/inner", "name": "hold"})
    assert "  root/hold:\n    n1: {text: inside" in renamed
    more = edited(NESTED, {"edit": "duplicate", "paths": ["root/inner"]})
    gone = edited(more, {"edit": "remove_nodes", "paths": ["root/inner"]})
    assert "inside" not in gone
    assert "outside" in gone


def test_notes_of_a_container_that_is_ungrouped_stay_where_they_are_seen() -> None:
    made = edited(NESTED, {"edit": "ungroup", "path": "root/inner"})
    assert "root/inner" not in made
    assert "n1_2: {text: inside, position: [110, 220], size: [200, 90], colour: pink}" in made


def test_notes_mean_nothing_to_a_run_and_are_drawn() -> None:
    bare = NESTED.partition("canvas_notes")[0]
    assert parsed(NESTED).meaning == parsed(bare).meaning
    document = parsed(NESTED).document
    assert document.canvas_notes["root/inner"]["n1"].text == "inside"


def test_notes_of_two_people_are_merged_one_by_one_and_places_never_conflict() -> None:
    mine = edited(NESTED, note("root", "n2"), note("root", "n1", text="outside", position=[5, 5], colour="grey"))
    theirs = edited(NESTED, note("root", "n3"), note("root", "n1", text="beside", position=[9, 9], colour="grey"))
    made = merge_by_nodes(NESTED, mine, theirs, file="x.yaml", sides={})
    assert made is not None
    assert made.conflicts == ()
    notes = parsed(made.text).document.canvas_notes["root"]
    assert sorted(notes) == ["n1", "n2", "n3"]
    assert (notes["n1"].text, notes["n1"].position) == ("beside", (5, 5))
    other = edited(NESTED, note("root", "n1", text="here", position=[0, 0], colour="grey"))
    both = merge_by_nodes(NESTED, other, theirs, file="x.yaml", sides={})
    assert both is not None
    assert [(each.path, each.field, each.mine) for each in both.conflicts] == [("root", "canvas note n1.text", "here")]


def test_a_note_that_was_only_moved_is_layout() -> None:
    moved = edited(NESTED, note("root", text="outside", position=[5, 5], colour="grey"))
    assert compare_texts(NESTED, moved, file="x.yaml").layout_only
    written = edited(NESTED, note("root", text="anew", position=[0, 0], colour="grey"))
    found = compare_texts(NESTED, written, file="x.yaml")
    assert not found.layout_only
    assert [(each.field, each.after) for each in found.changes[0].fields] == [("canvas_notes.root.n1.text", "anew")]
