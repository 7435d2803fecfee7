"""What of a drawn graph is taken for the next one, and what is not."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import msgspec
import pytest

from engine.editing import analyze_text
from engine.editing.draft_cache import DraftCache
from tests.engine.editing.edit_fixtures import analysis_of, context, read_edits

REFERRED = """\
    flexcell: 1
    name: part
    outcomes: [{outcomes}]
    success: [done]
    root:
      machine:
        initial: wait
        states:
          wait: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: done}}}}
    """
TEXT = """\
    flexcell: 1
    name: whole
    outcomes: [done]
    success: [done]
    root:
      machine:
        initial: first
        states:
          first:
            {kind}
            transitions: {{done: last}}
          last: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: done}}}}
    """
WITHIN = {
    "itself": "behavior: part.yaml",
    "in a machine": "machine: {initial: inner, states: {inner: {behavior: part.yaml, transitions: {done: done}}}}",
}


@pytest.mark.parametrize("kind", WITHIN.values(), ids=list(WITHIN))
def test_a_reference_is_drawn_again_with_what_its_file_says_now(kind: str, tmp_path: Path) -> None:
    """The text around it is the same: only the other file has changed."""
    part, file = tmp_path / "part.yaml", tmp_path / "whole.yaml"
    part.write_text(dedent(REFERRED).format(outcomes="done"), encoding="utf-8")
    text, drafts = dedent(TEXT).format(kind=kind), DraftCache()
    drafts.draw(text, file=file, context=context(tmp_path), check=True)
    part.write_text(dedent(REFERRED).format(outcomes="done, lost"), encoding="utf-8")
    edits, _ = read_edits([{"edit": "set_parameter", "path": "root/last", "name": "duration_s", "value": 2}])
    answer = drafts.edit(text, edits, file=file, context=context(tmp_path), check=True)
    expected = analyze_text(answer.text, file=file, context=context(tmp_path))
    assert "lost" in msgspec.json.encode(expected.graph).decode()
    assert analysis_of(answer) == expected


CANVAS_NOTE = {"text": "mind", "position": [1, 2], "size": [200, 90], "colour": "grey"}


def test_a_container_is_drawn_again_with_its_new_name_and_note(tmp_path: Path) -> None:
    kind = "machine: {initial: inner, states: {inner: {state: flow.Wait, transitions: {done: done}}}}"
    text, file, drafts = dedent(TEXT).format(kind=kind), tmp_path / "whole.yaml", DraftCache()
    for edit in (
        {"edit": "rename_node", "path": "root/first", "name": "begin"},
        {"edit": "set_field", "path": "root/begin", "field": "notes", "value": "looks"},
        {"edit": "set_positions", "positions": {"root/begin": [4, 5]}},
        {"edit": "set_canvas_note", "path": "root/begin", "name": "n1", "note": CANVAS_NOTE},
        {"edit": "set_canvas_note", "path": "root/begin", "name": "n1", "note": {**CANVAS_NOTE, "colour": "pink"}},
        {"edit": "rename_node", "path": "root/begin/inner", "name": "deep"},
    ):
        edits, _ = read_edits([edit])
        answer = drafts.edit(text, edits, file=file, context=context(tmp_path), check=True)
        assert answer.refused is None
        assert analysis_of(answer) == analyze_text(answer.text, file=file, context=context(tmp_path))
        text = answer.text
