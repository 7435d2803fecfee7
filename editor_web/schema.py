"""Generates the interface to the browser: `openapi.json`, and the page's TypeScript types.

    python -m editor_web.schema

Both files are committed; a test compares them with the output of this module.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args

from editor_web import app
from editor_web.cell_view.past_view import PastViewState
from editor_web.http_bodies.json_schemas import BodyTypes, Schema, component_schemas
from editor_web.live import live_frames
from editor_web.sockets.cell_past_view import PastViewRequest
from editor_web.teaching import handle_drag, teaching_messages
from editor_web.telemetry.bus_bodies import GoalStreamLine
from editor_web.telemetry.data_frames import DataFrame, DataSubscription
from engine.editing import AnyEdit
from engine.skills.entries import EntryHistory, EntryRecord
from engine.skills.teaching import Capture, SaveCapture, TeachStatus
from engine.skills.trigger_document import TriggerDocument
from engine.stop import StopStatus

HERE = Path(__file__).parent
OPENAPI = HERE / "openapi.json"
TYPES = HERE / "frontend" / "src" / "api" / "types.ts"
# What crosses in websockets and streams, and so stands in no route; and the skills that the page calls by name.
_STREAMED = BodyTypes(
    sent=[
        live_frames.Frame,
        DataFrame,
        GoalStreamLine,
        teaching_messages.ToPage,
        handle_drag.HandleStatus,
        PastViewState,
        StopStatus,
        *(Capture, EntryHistory, EntryRecord, TeachStatus, TriggerDocument),
    ],
    taken=[
        live_frames.Request,
        DataSubscription,
        teaching_messages.FromPage,
        handle_drag.ShowHandle,
        handle_drag.DragKeepAlive,
        PastViewRequest,
        AnyEdit,
        SaveCapture,
    ],
)
_UNIONS = {
    "DataFrame": DataFrame,
    "Edit": AnyEdit,
    "Frame": live_frames.Frame,
    "GoalStreamLine": GoalStreamLine,
    "TeachingFrame": teaching_messages.ToPage,
    "TeachingMessage": teaching_messages.FromPage,
}
_NAMED = {" | ".join(each.__name__ for each in get_args(union)): name for name, union in _UNIONS.items()}
_SIMPLE = {"string": "string", "integer": "number", "number": "number", "boolean": "boolean", "null": "null"}
# The parameters of a generic class, as msgspec appends them to its name.
_PARAMETERS = re.compile(r"_.*_$")


def openapi() -> str:
    """Return the OpenAPI description of the HTTP interface, without the version, which changes with each release."""
    described = app.openapi()
    document = {**described, "info": {**described["info"], "version": "1"}}
    return json.dumps(document, indent=2, sort_keys=True) + "\n"


def typescript() -> str:
    """Return the TypeScript types of all HTTP bodies and websocket frames."""
    schemas = component_schemas(app.body_types() + _STREAMED)
    parts = ["// Made by `python -m editor_web.schema`; edit the Python models instead.\n"]
    parts.append("import type { Dict } from '../document/dict'\n")
    parts += [_declaration(name, schemas[name]) for name in sorted(schemas)]
    parts += [f"export type {name} = {_names(union)}\n" for name, union in _UNIONS.items()]
    return "\n".join(parts)


def _names(union: Any) -> str:
    return " | ".join(each.__name__ for each in get_args(union))


def _declaration(name: str, schema: Schema) -> str:
    return "\n".join([*_comment(schema), *_body(_PARAMETERS.sub("", name), schema), ""])


def _comment(schema: Schema) -> Iterator[str]:
    if "description" in schema:
        text = " ".join(str(schema["description"]).split())
        yield f"/** {text} */"


def _body(name: str, schema: Schema) -> Iterator[str]:
    if "properties" not in schema and schema.get("type") != "object":
        yield f"export type {name} = {_type(schema)}"
        return
    required = set(schema.get("required", []))
    yield f"export interface {name} {{"
    for key, value in schema.get("properties", {}).items():
        yield f"  readonly {key}{'' if key in required else '?'}: {_type(value)}"
    yield "}"


def _type(schema: Schema) -> str:
    if "$ref" in schema:
        return _PARAMETERS.sub("", str(schema["$ref"]).rsplit("/", 1)[-1])
    if "enum" in schema:
        return " | ".join(json.dumps(value) for value in schema["enum"])
    if "const" in schema:
        return json.dumps(schema["const"])
    if "anyOf" in schema:
        parts = list(dict.fromkeys(_type(part) for part in schema["anyOf"]))
        whole = " | ".join(parts)
        return "unknown" if "unknown" in parts else _NAMED.get(whole, whole)
    if schema.get("type") == "array":
        return _array(schema)
    if schema.get("type") == "object":
        return f"Dict<{_type(schema.get('additionalProperties', {}))}>"
    return _SIMPLE.get(str(schema.get("type")), "unknown")


def _array(schema: Schema) -> str:
    if "prefixItems" in schema:
        return f"readonly [{', '.join(_type(part) for part in schema['prefixItems'])}]"
    inner = _type(schema.get("items", {}))
    return f"readonly ({inner})[]" if " " in inner else f"readonly {inner}[]"


def main() -> None:
    """Write both files."""
    OPENAPI.write_text(openapi(), encoding="utf-8")
    TYPES.parent.mkdir(parents=True, exist_ok=True)
    TYPES.write_text(typescript(), encoding="utf-8")


if __name__ == "__main__":
    main()
