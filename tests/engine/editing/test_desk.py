"""Texts that are being edited are read once, and what is kept of them is never told wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.large_document import large_document
from engine.editing import Draft, Examination, Knowledge, apply_edits, examine, read_edits
from engine.editing.desk import Desk
from engine.registry import load_states

TEXT = large_document(60)
NODE = "root/area_0/step_0/wait_3"


@pytest.fixture
def knowledge(tmp_path: Path) -> Knowledge:
    """What is known in an empty project."""
    return Knowledge(load_states(), tmp_path, tmp_path)


def test_edits_one_after_the_other_are_what_they_are_without_a_desk(tmp_path: Path, knowledge: Knowledge) -> None:
    """Also after a step back, whose text was used up, and with the same text in another file."""
    file, desk = tmp_path / "x.yaml", Desk(kept=2)
    edits, _ = read_edits([{"edit": "duplicate", "paths": [NODE]}])
    text = TEXT
    for at in (file, file, file, tmp_path / "y.yaml"):
        done, drawn = desk.edit(text, edits, file=at, knowledge=knowledge)
        alone = apply_edits(text, edits, file=str(at), knowledge=knowledge)
        assert (done.text, done.changed, done.refused) == (alone.text, alone.changed, None)
        assert desk.examine(done.text, file=at, knowledge=knowledge) == examine(done.text, file=at, knowledge=knowledge)
        assert not drawn.checked
        text = done.text
    again, _ = desk.edit(TEXT, edits, file=file, knowledge=knowledge)
    assert again.text == apply_edits(TEXT, edits, file=str(file), knowledge=knowledge).text


def test_a_refused_edit_leaves_the_text_as_it_was(tmp_path: Path, knowledge: Knowledge) -> None:
    file, desk = tmp_path / "x.yaml", Desk()
    desk.draw(TEXT, file=file, knowledge=knowledge)
    removed, _ = read_edits(
        [{"edit": "remove_nodes", "paths": [NODE]}, {"edit": "remove_nodes", "paths": ["root/nowhere"]}]
    )
    done, drawn = desk.edit(TEXT, removed, file=file, knowledge=knowledge)
    assert (done.text, done.refused is None) == (TEXT, False)
    assert drawn.graph == examine(TEXT, file=file, knowledge=knowledge).graph


def test_findings_of_a_text_that_was_just_drawn_are_those_of_a_whole_look(tmp_path: Path, knowledge: Knowledge) -> None:
    file, desk = tmp_path / "x.yaml", Desk()
    text = TEXT.replace("state: flow.Decide", "state: flow.Nothing", 1)
    drawn = desk.draw(text, file=file, knowledge=knowledge)
    found = desk.findings(text, file=file, knowledge=knowledge)
    assert (drawn.findings, drawn.checked) == ((), False)
    assert found == examine(text, file=file, knowledge=knowledge).findings
    assert [each.code for each in found] == ["unknown-state"]


@pytest.mark.parametrize("text", ["flexcell: [", "- a list", ""])
def test_a_text_that_cannot_be_read_says_so_in_every_way(text: str, tmp_path: Path, knowledge: Knowledge) -> None:
    file, desk = tmp_path / "x.yaml", Desk()
    edits, _ = read_edits([{"edit": "duplicate", "paths": [NODE]}])
    expected: Examination = examine(text, file=file, knowledge=knowledge)
    assert desk.draw(text, file=file, knowledge=knowledge) == expected
    assert desk.findings(text, file=file, knowledge=knowledge) == expected.findings
    done, drawn = desk.edit(text, edits, file=file, knowledge=knowledge)
    assert (done.text, drawn) == (text, expected)
    assert done.refused is not None


def test_what_an_edit_leaves_alone_keeps_its_bytes_and_reads_as_a_fresh_look(
    tmp_path: Path, knowledge: Knowledge
) -> None:
    """A draft that was written and read back is as good as one of the text it wrote."""
    edits, _ = read_edits([{"edit": "rename_node", "path": NODE, "name": "other"}])
    done = apply_edits(TEXT, edits, file="x.yaml", knowledge=knowledge)
    assert done.draft is not None
    assert done.draft.data == Draft(done.text, file="x.yaml").data
    changed = [(a, b) for a, b in zip(TEXT.split("\n"), done.text.split("\n"), strict=True) if a != b]
    assert changed == [
        ("                    transitions: {done: wait_3}", "                    transitions: {done: other}"),
        ("                  wait_3:", "                  other:"),
    ]
