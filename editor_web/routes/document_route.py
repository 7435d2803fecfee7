"""Error responses of document routes: 404 for a missing document, 409 with both texts for a concurrent change."""

from __future__ import annotations

from collections.abc import Callable, Coroutine
from typing import Any

from fastapi import Request, Response
from fastapi.responses import JSONResponse
from fastapi.routing import APIRoute

from editor_web.http_bodies.common_bodies import ErrorBody
from editor_web.http_bodies.document_bodies import ConflictBody, MergeConflictBody
from engine.editing import DocumentConflict, NoSuchDocument


class DocumentRoute(APIRoute):
    """A route whose handler may raise the errors of `engine.editing.DocumentRepository`."""

    def get_route_handler(self) -> Callable[[Request], Coroutine[Any, Any, Response]]:
        """Return the handler with these errors turned into responses."""
        handler = super().get_route_handler()

        async def handle_with_errors(request: Request) -> Response:
            try:
                return await handler(request)
            except NoSuchDocument as error:
                body = ErrorBody(message=error.message, where=str(error.where or ""), hint=error.hint or "")
                return JSONResponse(body.model_dump(), status_code=404)
            except DocumentConflict as error:
                return JSONResponse(_conflict(error).model_dump(), status_code=409)

        return handle_with_errors


def _conflict(error: DocumentConflict) -> ConflictBody:
    return ConflictBody(
        message=error.message,
        where=str(error.where or ""),
        hint=error.hint or "",
        theirs=error.theirs.text,
        theirs_hash=error.theirs.hash,
        merged=error.merged,
        conflicts=tuple(MergeConflictBody.model_validate(each) for each in error.conflicts),
    )
