"""Bodies for fixes of findings, and for moving, restoring and comparing documents."""

from __future__ import annotations

from typing import Annotated

import msgspec
from msgspec import Meta

from editor_web.http_bodies.common_bodies import RequestBody
from editor_web.http_bodies.document_bodies import DocumentBody, Id, Text
from engine.editing.fixes import Fix
from engine.library import FindingView


class FixesBody(FindingView, frozen=True, kw_only=True):
    """A finding of a text with its fixes."""

    fixes: tuple[Fix, ...]


class DeletedDocumentBody(msgspec.Struct, frozen=True, kw_only=True):
    """A deleted document that can be restored; `saved_at` is when its last text was first seen."""

    id: str
    saved_at: float


class MoveBody(RequestBody, frozen=True, kw_only=True):
    """The new id of a document; with `follow`, references to it are updated."""

    id: Id
    follow: bool


class MoveResultBody(msgspec.Struct, frozen=True, kw_only=True):
    """A moved document: the ids whose references were updated, and those whose references were not."""

    document: DocumentBody
    updated: tuple[str, ...]
    left: tuple[str, ...]


class CompareBody(RequestBody, frozen=True, kw_only=True):
    """Two texts of a document to compare."""

    before: Annotated[Text, Meta(description="The older text")]
    after: Annotated[Text, Meta(description="The newer text")]
