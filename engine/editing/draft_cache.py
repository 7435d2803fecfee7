"""Cache of texts under edit, read and drawn: the next edit reads and draws only what it changes."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from engine.editing.apply import EditedText, apply_edits, apply_edits_to_draft
from engine.editing.diagnostics import (
    DocumentAnalysis,
    analyze_graph,
    analyze_unreadable_text,
    text_hash,
    with_findings,
)
from engine.editing.document_graph import DrawnGraph
from engine.editing.draft import Draft
from engine.editing.edit import AnyEdit
from engine.editing.graph_difference import GraphDifference, graph_difference
from engine.editing.outline import Outline
from engine.editing.project_context import ProjectContext
from engine.errors import DocumentError

MAX_TEXTS = 6
"""Maximum number of texts kept: the last steps of a few pages; a text of 1,000 states takes about 10 MB."""
MAX_ENTRIES = 60_000
"""Maximum number of entries in all kept texts, each about 500 bytes; the newest text is always kept."""


@dataclass
class _CachedDraft:
    """Cached data of one text; whoever uses its draft takes it out."""

    graph: DrawnGraph
    outline: Outline
    draft: Draft | None


@dataclass(frozen=True, kw_only=True)
class EditAnswer(EditedText, DocumentAnalysis):
    """A text after edits with its graph and findings, and the difference from the graph that the asker has.

    It crosses to the page without the graph where there is a difference.
    """

    difference: GraphDifference | None = None


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

    def draw(self, text: str, *, file: Path, context: ProjectContext, check: bool = False) -> DocumentAnalysis:
        """Parse a text and build its graph; the check runs if asked for, and if the text cannot be read."""
        kept, sheet = self._taken(file, text)
        try:
            draft = kept or Draft(text, file=str(file))
        except DocumentError as error:
            return analyze_unreadable_text(text, error, file=file, context=context)
        outline = sheet.outline if sheet is not None and kept is not None else Outline(draft.data)
        graph = sheet.graph if sheet is not None else None
        return self._analyzed(draft, outline, file, context, graph, check=check)[0]

    def edit(
        self,
        text: str,
        edits: Sequence[AnyEdit],
        *,
        file: Path,
        context: ProjectContext,
        check: bool = False,
        graph: str | None = None,
    ) -> EditAnswer:
        """Apply edits to a text, all or none, and build the graph of the result.

        Args:
            text: The text.
            edits: The edits.
            file: The file of the text.
            context: The states and behaviors around it.
            check: Whether to find the problems of the result.
            graph: The hash of the text of which the asker has the graph, if any.
        """
        draft, sheet = self._taken(file, text)
        if draft is not None and sheet is not None:
            done = apply_edits_to_draft(draft, edits, context=context, outline=sheet.outline)
        else:
            done = apply_edits(text, edits, file=str(file), context=context)
        if done.draft is None or done.outline is None:
            return _answer(done, self.draw(text, file=file, context=context, check=check))
        before = sheet.graph if sheet is not None else None
        analysis, now = self._analyzed(done.draft, done.outline, file, context, before, check=check)
        difference = None
        base = text_hash(text)
        if before is not None and before.root is not None and now.root is not None and graph == base:
            difference = graph_difference(base, before.nodes, now.nodes)
        return _answer(done, analysis, difference)

    def examine(self, text: str, *, file: Path, context: ProjectContext) -> DocumentAnalysis:
        """Build the graph and the findings of a text."""
        return self.draw(text, file=file, context=context, check=True)

    def _taken(self, file: Path, text: str) -> tuple[Draft | None, _CachedDraft | None]:
        """Return the draft of a text, and what else is known of it; the draft is taken out, to be changed."""
        with self._lock:
            sheet = self._cache.get((file, text))
            if sheet is None:
                return None, None
            draft, sheet.draft = sheet.draft, None
            return draft, sheet

    def _analyzed(
        self,
        draft: Draft,
        outline: Outline,
        file: Path,
        context: ProjectContext,
        before: DrawnGraph | None,
        *,
        check: bool,
    ) -> tuple[DocumentAnalysis, DrawnGraph]:
        drawn, graph = analyze_graph(draft, outline, file=file, context=context, before=before)
        if check:
            drawn = with_findings(drawn, draft.given, file=file, context=context, draft=draft)
        with self._lock:
            self._cache[file, draft.given] = _CachedDraft(graph, outline, draft)
            self._cache.move_to_end((file, draft.given))
            while len(self._cache) > 1 and self._too_much():
                self._cache.popitem(last=False)
        return drawn, graph

    def _too_much(self) -> bool:
        return len(self._cache) > self._kept or self.kept_entries > MAX_ENTRIES


def _answer(done: EditedText, analysis: DocumentAnalysis, difference: GraphDifference | None = None) -> EditAnswer:
    # The fields as they are: a copy of a large graph would take longer than the edit.
    return EditAnswer(
        **vars(analysis), text=done.text, changed=done.changed, refused=done.refused, difference=difference
    )
