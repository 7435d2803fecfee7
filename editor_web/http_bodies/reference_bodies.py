"""The JSON around documents: fixes of findings, who refers to a document, moving and restoring it."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from editor_web.http_bodies.common_bodies import HttpBody
from editor_web.http_bodies.document_bodies import DocumentBody, Id, Text


class FixBody(HttpBody):
    """What would mend a finding: the edits to send, and what they do in words."""

    title: str
    edits: tuple[dict[str, object], ...]


class FixesBody(HttpBody):
    """The fixes of one finding of a text; `code`, `path`, `line` and `message` say of which."""

    code: str
    path: str
    line: int
    message: str
    fixes: tuple[FixBody, ...]


class ReferrerBody(HttpBody):
    """A behavior that refers to another one, and the nodes that do."""

    id: str
    name: str
    paths: tuple[str, ...]


class DeletedDocumentBody(HttpBody):
    """A document that has gone and can be restored; `saved_at` is when its last text was first seen."""

    id: str
    saved_at: float


class MoveBody(HttpBody):
    """Where a document goes; with `follow`, references to it are written anew."""

    id: Id
    follow: bool


class MoveResultBody(HttpBody):
    """A document at its new place: whose references follow, and whose could not."""

    document: DocumentBody
    followed: tuple[str, ...]
    left: tuple[str, ...]


class CompareBody(HttpBody):
    """Two texts of a document to be compared."""

    before: Annotated[Text, Field(description="The older one")]
    after: Annotated[Text, Field(description="The newer one")]
