"""Bodies of the cell page's editor: documents of the cell and its modules, and edits of their texts."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from editor_web.http_bodies.document_bodies import TextBody
from engine.editing.cells import AnyCellEdit, CellDraft


class CellDocumentBody(msgspec.Struct, frozen=True, kw_only=True):
    """A document of the cell on disk; `saved_at` is the time of its last change, seconds since 1970."""

    id: str
    saved_at: float
    draft: CellDraft


class CellEditsBody(TextBody, frozen=True, kw_only=True):
    """A text and the edits to apply, all or none."""

    edits: Annotated[tuple[AnyCellEdit, ...], Meta(max_length=500)]
