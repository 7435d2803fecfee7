"""What Foxglove asks of a JSON channel, after its documentation of custom schemas and its parser of them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

PLAIN = ("boolean", "string", "number", "integer")


def complaints(schema: dict[str, Any], at: str = "$") -> Iterator[str]:
    """Go through what Foxglove would not read in a schema."""
    if schema.get("type") != "object":
        yield f"{at}: type {schema.get('type')!r} is not object"
        return
    if not isinstance(schema.get("properties"), dict):
        yield f"{at}: no properties"
        return
    for name, inner in schema["properties"].items():
        yield from _field(inner, f"{at}.{name}")


def _field(schema: dict[str, Any], at: str) -> Iterator[str]:
    if "$ref" in schema or "anyOf" in schema:
        yield f"{at}: a reference or a union"
    kind = schema.get("type")
    if kind == "object":
        yield from complaints(schema, at)
    elif kind == "array":
        items: dict[str, Any] = schema["items"]
        if items.get("type") not in (*PLAIN, "object"):
            yield f"{at}: items {items!r}"
        elif items["type"] == "object":
            yield from complaints(items, f"{at}[]")
        elif "contentEncoding" in items:
            yield f"{at}: encoded items"
    elif kind not in PLAIN:
        yield f"{at}: type {kind!r}"
    elif schema.get("contentEncoding", "base64") != "base64":
        yield f"{at}: encoding {schema['contentEncoding']!r}"
