"""Answers that are made of the engine's own structs, without a wire model between."""

from __future__ import annotations

import msgspec
from fastapi import Response


def json_response(value: object) -> Response:
    """Return a value as JSON."""
    return Response(msgspec.json.encode(value), media_type="application/json")
