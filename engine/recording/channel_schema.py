"""JSON Schemas of recorded channels, in the subset that Foxglove supports.

Foxglove requires an object whose properties each have one plain type, arrays of plain items, and no
references. Other fields of a message (unions, nested lists, free dictionaries) are omitted from
the schema, never from the message.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, cast

import msgspec

JsonSchema = dict[str, Any]

_PLAIN = ("boolean", "string", "number", "integer")
_DEEPEST = 8


def channel_schema(kind: Any, *, title: str) -> bytes:
    """Return the schema of a message type, or of a union of them, as JSON text."""
    (root,), definitions = msgspec.json.schema_components([kind], schema_hook=_any_value)
    options: list[JsonSchema] = root.get("anyOf", [root])
    objects = [_object(option, definitions, _DEEPEST) for option in options]
    merged = _merged([found for found in objects if found is not None])
    return msgspec.json.encode({"title": title, **merged})


def _any_value(kind: type) -> JsonSchema:
    """Return a schema for a type that msgspec cannot describe: any value."""
    return {"description": f"any {kind.__name__}"}


def _merged(objects: list[JsonSchema]) -> JsonSchema:
    """Return the common schema of several: a property is kept if all schemas with it agree on its type."""
    properties: dict[str, JsonSchema | None] = {}
    for each in objects:
        for name, schema in each["all"].items():
            agreed = name not in properties or properties[name] == schema
            properties[name] = schema if agreed else None
    required = [name for name in properties if all(name in each["required"] for each in objects)]
    return {
        "type": "object",
        "properties": {name: schema for name, schema in properties.items() if schema is not None},
        "required": required,
    }


def _object(schema: JsonSchema, definitions: Mapping[str, JsonSchema], depth: int) -> JsonSchema | None:
    """Return required names and all properties (None if a type is not plain), or None for a non-object."""
    found = _resolved(schema, definitions)
    if found.get("type") != "object" or depth == 0:
        return None
    properties: dict[str, JsonSchema] = found.get("properties", {})
    return {
        "required": found.get("required", []),
        "all": {name: _plain(each, definitions, depth) for name, each in properties.items()},
    }


def _plain(schema: JsonSchema, definitions: Mapping[str, JsonSchema], depth: int) -> JsonSchema | None:
    found = _resolved(schema, definitions)
    kind = found.get("type")
    if "enum" in found and all(isinstance(value, str) for value in cast("list[object]", found["enum"])):
        kind = "string"
    if kind in _PLAIN:
        encoded = {"contentEncoding": "base64"} if found.get("contentEncoding") == "base64" else {}
        return {"type": kind, **encoded}
    if kind == "array":
        return _array(found, definitions, depth)
    if kind == "object" and (inner := _object(found, definitions, depth - 1)) is not None:
        return _merged([inner])
    return None


def _array(schema: JsonSchema, definitions: Mapping[str, JsonSchema], depth: int) -> JsonSchema | None:
    options: list[JsonSchema] = schema.get("prefixItems") or [schema.get("items") or {}]
    items = [_plain(option, definitions, depth) for option in options]
    first = items[0]
    if first is None or first["type"] == "array" or "contentEncoding" in first or any(i != first for i in items):
        return None
    return {"type": "array", "items": first}


def _resolved(schema: JsonSchema, definitions: Mapping[str, JsonSchema]) -> JsonSchema:
    reference: str | None = schema.get("$ref")
    return definitions[reference.rpartition("/")[2]] if reference is not None else schema
