"""Cache of parsed texts under edit: the next edit of a text does not parse it again."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from engine.editing.apply import EditResult, apply_edits, apply_edits_to_draft
from engine.editing.diagnostics import DocumentAnalysis, analyze_unreadable_text, draw_document, with_findings
from engine.editing.draft import Draft
from engine.editing.edit import AnyEdit
from engine.editing.project_context import ProjectContext
from engine.errors import DocumentError
from engine.host.gc_pause import gc_paused
from engine.library.behavior_library import FindingView

MAX_TEXTS = 6
"""Maximum number of texts kept: the last steps of a few pages; a text of 1,000 states takes about 10 MB."""
MAX_ENTRIES = 60_000
"""Maximum number of entries in all kept texts, each about 500 bytes; the newest text is always kept."""


@dataclass
class _CachedDraft:
    """Cached data of one text; the edit that uses its draft consumes it."""

    drawn: DocumentAnalysis
    draft: Draft | None


class DraftCache:
    """Parses, edits and checks texts, and caches the last ones; thread-safe."""

    def __init__(self, *, kept: int = MAX_TEXTS) -> None:
        self._kept = kept
        self._cache: OrderedDict[tuple[Path, str], _CachedDraft] = OrderedDict()
        self._lock = threading.Lock()

    @property
    def kept_entries(self) -> int:
        """Number of entries in the cached texts, counted by their separators."""
        return sum(text.count("\n") + text.count(",") for _, text in self._cache)

    def draw(self, text: str, *, file: Path, context: ProjectContext) -> DocumentAnalysis:
        """Parse a text and build its graph; the check runs only if the text cannot be read."""
        with gc_paused():
            draft = self._taken(file, text)
            try:
                draft = draft or Draft(text, file=str(file))
            except DocumentError as error:
                return analyze_unreadable_text(text, error, file=file, context=context)
            return self._put(draft, file, context)

    def edit(
        self, text: str, edits: Sequence[AnyEdit], *, file: Path, context: ProjectContext
    ) -> tuple[EditResult, DocumentAnalysis]:
        """Apply edits to a text, all or none, and build the graph of the result."""
        with gc_paused():
            done = self._edited(text, edits, file, context)
            if done.draft is not None:
                return done, self._put(done.draft, file, context)
        return done, self.draw(text, file=file, context=context)

    def examine(self, text: str, *, file: Path, context: ProjectContext) -> DocumentAnalysis:
        """Build the graph and the findings of a text."""
        drawn = self.draw(text, file=file, context=context)
        with gc_paused():
            return with_findings(drawn, text, file=file, context=context)

    def findings(self, text: str, *, file: Path, context: ProjectContext) -> tuple[FindingView, ...]:
        """Check a text; a cached graph is reused."""
        with self._lock:
            sheet = self._cache.get((file, text))
        drawn = sheet.drawn if sheet is not None else self.draw(text, file=file, context=context)
        with gc_paused():
            return with_findings(drawn, text, file=file, context=context).findings

    def _edited(self, text: str, edits: Sequence[AnyEdit], file: Path, context: ProjectContext) -> EditResult:
        draft = self._taken(file, text)
        if draft is not None:
            return apply_edits_to_draft(draft, edits, context=context)
        return apply_edits(text, edits, file=str(file), context=context)

    def _taken(self, file: Path, text: str) -> Draft | None:
        """Remove the draft of a text from the cache and return it: the caller may change it."""
        with self._lock:
            sheet = self._cache.get((file, text))
            if sheet is None:
                return None
            draft, sheet.draft = sheet.draft, None
            return draft

    def _put(self, draft: Draft, file: Path, context: ProjectContext) -> DocumentAnalysis:
        drawn = draw_document(draft, file=file, context=context)
        with self._lock:
            self._cache[file, draft.given] = _CachedDraft(drawn, draft)
            self._cache.move_to_end((file, draft.given))
            while len(self._cache) > 1 and self._too_much():
                self._cache.popitem(last=False)
        return drawn

    def _too_much(self) -> bool:
        return len(self._cache) > self._kept or self.kept_entries > MAX_ENTRIES
