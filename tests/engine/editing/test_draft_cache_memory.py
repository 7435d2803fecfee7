"""Texts under edit are given back as soon as nobody needs them, and few are kept."""

from __future__ import annotations

import gc
import weakref
from pathlib import Path

import pytest

from benchmarks.large_document import large_document
from engine.editing.draft_cache import MAX_ENTRIES, DraftCache
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft
from tests.engine.editing.edit_fixtures import context, read_edits

TEXT = "flexcell: 1\nname: x\noutcomes: [a]\nroot: {state: flow.Wait, with: {duration_s: 1}, description: "


def test_a_draft_has_no_cycles() -> None:
    """Without the collector nothing of it is left: each collection in it holds the origin."""
    gc.disable()
    try:
        draft = Draft(f"{TEXT}x}}\n", file="x.yaml")
        left = [weakref.ref(draft), *(weakref.ref(found.origin) for found in draft.collections())]
        del draft
        assert [each() for each in left] == [None] * len(left)
    finally:
        gc.enable()


@pytest.mark.parametrize(
    "edit",
    [
        {"edit": "rename_node", "path": "root/area_0/step_0/wait_3", "name": "other"},
        {"edit": "duplicate", "paths": ["root/area_0/step_0/wait_3"]},
        {"edit": "set_parameter", "path": "root/area_0/step_0/wait_3", "name": "duration_s", "value": 7},
    ],
)
def test_an_edit_leaves_nothing_to_the_collector(tmp_path: Path, edit: dict[str, object]) -> None:
    """Texts that went out of use and the behaviors that they described are freed without it."""
    drafts, known = DraftCache(kept=1), context(tmp_path)
    edits, _ = read_edits([edit])
    text, file = large_document(60), tmp_path / "x.yaml"
    drafts.examine(text, file=file, context=known)
    gc.collect()
    gc.disable()
    try:
        for _ in range(3):
            drafts.edit(text, edits, file=file, context=known, check=True)
        assert gc.collect() < 50  # a few of the libraries; each text has hundreds
    finally:
        gc.enable()


def test_of_long_texts_only_the_last_are_kept(tmp_path: Path) -> None:
    """What they hold together is bounded."""
    drafts = DraftCache()
    context = ProjectContext({}, tmp_path, tmp_path)
    for letter in "abc":
        text = f"{TEXT}{letter}}}\n" + "\n" * (MAX_ENTRIES // 2)
        drafts.draw(text, file=tmp_path / "x.yaml", context=context)
    assert drafts.kept_entries <= MAX_ENTRIES
