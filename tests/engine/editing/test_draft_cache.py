"""Texts that are being edited are read once, and what is kept of them is never told wrong."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, ClassVar

import pytest
from msgspec import Meta

from benchmarks.large_document import large_document
from engine.document import parse_behavior
from engine.document.loader import survey_behavior
from engine.document.nodes.node_spec import NodeSpec
from engine.editing import DocumentAnalysis, Draft, ProjectContext, analyze_text, apply_edits
from engine.editing.analysis.diagnostics import text_hash
from engine.editing.draft_cache import DraftCache
from engine.editing.edits.apply import apply_edits_to_draft
from engine.editing.text.draft_source import keep_nodes, syntax_source
from engine.editing.text.outline import Outline
from engine.registry import load_states
from engine.state import Context, Outcome, State
from tests.engine.editing.edit_fixtures import analysis_of, read_edits

TEXT = large_document(60)
NODE = "root/area_0/step_0/wait_3"
WAITING = """\
flexcell: 1
name: waiting
parameters:
  time: {type: integer, default: 1}
outcomes: [done]
root:
  machine:
    initial: a
    states:
      a: {state: x.Wait, with: {duration: 1}, transitions: {done: b}}
      b: {state: x.Wait, with: {duration: "${time}"}, transitions: {done: done}}
"""


class _Short(State, frozen=True, kw_only=True):
    """Wait."""

    state_name: ClassVar[str] = "x.Wait"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    duration: Annotated[int, Meta(le=5)]

    async def run(self, ctx: Context) -> Outcome:
        """Do not wait."""
        return Outcome("done")


class _Long(_Short, frozen=True, kw_only=True):
    """Wait for a text."""

    duration: str  # pyright: ignore[reportIncompatibleVariableOverride, reportGeneralTypeIssues]


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


def test_a_node_that_did_not_change_is_judged_anew_where_what_it_uses_did(tmp_path: Path) -> None:
    """Another class of its state, and another default of the parameter in its expression."""
    file, drafts = tmp_path / "x.yaml", DraftCache()
    contexts = [ProjectContext({"x.Wait": each}, tmp_path, tmp_path) for each in (_Short, _Long, _Short)]
    for context in contexts:
        found = drafts.examine(WAITING, file=file, context=context)
        assert found == analyze_text(WAITING, file=file, context=context)
    codes: list[list[str]] = []
    text = WAITING
    for default in (2, 9, 3):
        parameters = {"time": {"type": "integer", "default": default}}
        edits, _ = read_edits([{"edit": "set_document", "changes": {"parameters": parameters}}])
        answer = drafts.edit(text, edits, file=file, context=contexts[0], check=True)
        text = answer.text
        assert analysis_of(answer) == analyze_text(text, file=file, context=contexts[0])
        codes.append([each.code for each in answer.findings])
    assert codes == [[], ["bad-parameter"], []]


def test_only_nodes_that_changed_are_decoded_again(tmp_path: Path, context: ProjectContext) -> None:
    outline = Outline((draft := Draft(TEXT, file="x.yaml")).data)
    first = _decoded_nodes(draft, outline, tmp_path)
    edits, _ = read_edits([{"edit": "set_parameter", "path": NODE, "name": "duration_s", "value": 7}])
    done = apply_edits_to_draft(draft, edits, context=context, outline=outline)
    assert done.draft is not None
    assert done.outline is not None
    second = _decoded_nodes(done.draft, done.outline, tmp_path)
    around = {"root", *(NODE[:at] for at, letter in enumerate(NODE) if letter == "/"), NODE}
    assert {path for path, node in second.items() if node is not first[path]} == around
    assert second == dict(parse_behavior(done.text, file="x.yaml").nodes())


def _decoded_nodes(draft: Draft, outline: Outline, folder: Path) -> dict[str, NodeSpec]:
    behavior = survey_behavior(folder / "x.yaml", draft.given, source=syntax_source(draft)).behavior
    assert behavior is not None
    keep_nodes(behavior, draft, outline)
    return dict(behavior.nodes())


def test_a_step_back_and_typed_text_are_what_they_are_without_a_cache(tmp_path: Path, context: ProjectContext) -> None:
    """They are read with the tree of the newest text, which is used up by that."""
    file, drafts = tmp_path / "x.yaml", DraftCache()
    edits, _ = read_edits([{"edit": "rename_node", "path": NODE, "name": "other"}])
    drafts.draw(TEXT, file=file, context=context)
    base = text_hash(TEXT)
    renamed = drafts.edit(TEXT, edits, file=file, context=context, check=True, graph=base)
    again = drafts.edit(TEXT, edits, file=file, context=context, check=True, graph=base)
    assert again == renamed
    typed = renamed.text.replace("state: flow.Decide", "state: flow.Nothing", 1)
    assert drafts.examine(typed, file=file, context=context) == analyze_text(typed, file=file, context=context)
