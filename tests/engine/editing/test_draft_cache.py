"""Texts that are being edited are read once, and what is kept of them is never told wrong."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.large_document import large_document
from engine.editing import DocumentAnalysis, Draft, ProjectContext, analyze_text, apply_edits
from engine.editing.draft_cache import DraftCache
from engine.registry import load_states
from tests.engine.editing.edit_fixtures import read_edits

TEXT = large_document(60)
NODE = "root/area_0/step_0/wait_3"


@pytest.fixture
def context(tmp_path: Path) -> ProjectContext:
    """What is known in an empty project."""
    return ProjectContext(load_states(), tmp_path, tmp_path)


def test_edits_one_after_the_other_are_what_they_are_without_a_cache(tmp_path: Path, context: ProjectContext) -> None:
    """Also after a step back, whose text was used up, and with the same text in another file."""
    file, drafts = tmp_path / "x.yaml", DraftCache(kept=2)
    edits, _ = read_edits([{"edit": "duplicate", "paths": [NODE]}])
    text = TEXT
    for at in (file, file, file, tmp_path / "y.yaml"):
        answer = drafts.edit(text, edits, file=at, context=context)
        done = drawn = answer
        alone = apply_edits(text, edits, file=str(at), context=context)
        assert (done.text, done.changed, done.refused) == (alone.text, alone.changed, None)
        assert drafts.examine(done.text, file=at, context=context) == analyze_text(done.text, file=at, context=context)
        assert not drawn.checked
        text = done.text
    again = drafts.edit(TEXT, edits, file=file, context=context)
    assert again.text == apply_edits(TEXT, edits, file=str(file), context=context).text


def test_a_refused_edit_leaves_the_text_as_it_was(tmp_path: Path, context: ProjectContext) -> None:
    file, drafts = tmp_path / "x.yaml", DraftCache()
    drafts.draw(TEXT, file=file, context=context)
    removed, _ = read_edits(
        [{"edit": "remove_nodes", "paths": [NODE]}, {"edit": "remove_nodes", "paths": ["root/nowhere"]}]
    )
    answer = drafts.edit(TEXT, removed, file=file, context=context)
    done = drawn = answer
    assert (done.text, done.refused is None) == (TEXT, False)
    assert drawn.graph == analyze_text(TEXT, file=file, context=context).graph


def test_findings_of_a_text_that_was_just_drawn_are_those_of_a_whole_look(
    tmp_path: Path, context: ProjectContext
) -> None:
    file, drafts = tmp_path / "x.yaml", DraftCache()
    text = TEXT.replace("state: flow.Decide", "state: flow.Nothing", 1)
    drawn = drafts.draw(text, file=file, context=context)
    found = drafts.examine(text, file=file, context=context).findings
    assert (drawn.findings, drawn.checked) == ((), False)
    assert found == analyze_text(text, file=file, context=context).findings
    assert [each.code for each in found] == ["unknown-state"]


@pytest.mark.parametrize("text", ["flexcell: [", "- a list", ""])
def test_a_text_that_cannot_be_read_says_so_in_every_way(text: str, tmp_path: Path, context: ProjectContext) -> None:
    file, drafts = tmp_path / "x.yaml", DraftCache()
    edits, _ = read_edits([{"edit": "duplicate", "paths": [NODE]}])
    expected: DocumentAnalysis = analyze_text(text, file=file, context=context)
    assert drafts.draw(text, file=file, context=context) == expected
    assert drafts.examine(text, file=file, context=context).findings == expected.findings
    answer = drafts.edit(text, edits, file=file, context=context)
    done = drawn = answer
    assert (done.text, drawn.findings, drawn.graph) == (text, expected.findings, None)
    assert done.refused is not None


def test_what_an_edit_leaves_alone_keeps_its_bytes_and_reads_as_a_fresh_look(
    tmp_path: Path, context: ProjectContext
) -> None:
    """A draft that was written and read back is as good as one of the text it wrote."""
    edits, _ = read_edits([{"edit": "rename_node", "path": NODE, "name": "other"}])
    done = apply_edits(TEXT, edits, file="x.yaml", context=context)
    assert done.draft is not None
    assert done.draft.data == Draft(done.text, file="x.yaml").data
    changed = [(a, b) for a, b in zip(TEXT.split("\n"), done.text.split("\n"), strict=True) if a != b]
    assert changed == [
        ("                    transitions: {done: wait_3}", "                    transitions: {done: other}"),
        ("                  wait_3:", "                  other:"),
    ]
