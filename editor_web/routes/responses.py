"""Responses from the engine's own structs, without a body model in between."""

from __future__ import annotations

import msgspec
from fastapi import Response


def json_response(value: object) -> Response:
    """Return a value as JSON."""
    return Response(msgspec.json.encode(value), media_type="application/json")
