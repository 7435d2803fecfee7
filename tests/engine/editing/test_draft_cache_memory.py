"""Texts under edit are given back as soon as nobody needs them, and few are kept."""

from __future__ import annotations

import gc
import weakref
from pathlib import Path

from engine.editing.draft_cache import MAX_ENTRIES, DraftCache
from engine.editing.project_context import ProjectContext
from engine.editing.text.draft import Draft

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


def test_of_long_texts_only_the_last_are_kept(tmp_path: Path) -> None:
    """What they hold together is bounded."""
    drafts = DraftCache()
    context = ProjectContext({}, tmp_path, tmp_path)
    for letter in "abc":
        text = f"{TEXT}{letter}}}\n" + "\n" * (MAX_ENTRIES // 2)
        drafts.draw(text, file=tmp_path / "x.yaml", context=context)
    assert drafts.kept_entries <= MAX_ENTRIES
