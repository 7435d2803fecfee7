"""JSON bodies for fixes of findings, references to a document, and moving or restoring it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from editor_web.http_bodies.common_bodies import HttpBody
from editor_web.http_bodies.document_bodies import DocumentBody, Id, Text


class FixBody(HttpBody):
    """A fix of a finding: the edits to send, and a title that describes them."""

    title: str
    edits: tuple[dict[str, object], ...]


class FixesBody(HttpBody):
    """The fixes of one finding of a text; `code`, `path`, `line` and `message` identify the finding."""

    code: str
    path: str
    line: int
    message: str
    fixes: tuple[FixBody, ...]


class ReferrerBody(HttpBody):
    """A behavior that refers to another one, and its referring nodes."""

    id: str
    name: str
    paths: tuple[str, ...]


class DeletedDocumentBody(HttpBody):
    """A deleted document that can be restored; `saved_at` is when its last text was first seen."""

    id: str
    saved_at: float


class MoveBody(HttpBody):
    """The new id of a document; with `follow`, references to it are updated."""

    id: Id
    follow: bool


class MoveResultBody(HttpBody):
    """A moved document: the ids whose references were updated, and those whose references were not."""

    document: DocumentBody
    followed: tuple[str, ...]
    left: tuple[str, ...]


class CompareBody(HttpBody):
    """Two texts of a document to compare."""

    before: Annotated[Text, Field(description="The older text")]
    after: Annotated[Text, Field(description="The newer text")]
