"""Generates the interface to the browser: `openapi.json`, and the page's TypeScript types.

    python -m editor_web.schema

Both files are committed; a test compares them with the output of this module.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, cast, get_args

import msgspec

from editor_web import app
from editor_web.live.live_frames import (
    DocumentsChanged,
    Hello,
    LiveDelta,
    LiveSnapshot,
    OperateRun,
    Ping,
    Pong,
    ShowLayers,
    WatchRun,
)
from editor_web.past import PastRunState, RunFailure, Timeline
from editor_web.teaching.teaching_messages import SCHEMAS as TEACHING
from engine.document.parameter_spec import any_value
from engine.editing import AnyEdit

HERE = Path(__file__).parent
OPENAPI = HERE / "openapi.json"
TYPES = HERE / "frontend" / "src" / "api" / "types.ts"
Schema = dict[str, Any]
_SIMPLE = {"string": "string", "integer": "number", "number": "number", "boolean": "boolean", "null": "null"}
# Schemas of the framework, or for the command line only.
_SERVER_ONLY = {"HTTPValidationError", "ValidationError", "BusRequestBody", "BusMessageBody"}


def openapi() -> str:
    """Return the OpenAPI description of the HTTP interface, without the version, which changes with each release."""
    described = app.openapi()
    document = {**described, "info": {**described["info"], "version": "1"}}
    return json.dumps(document, indent=2, sort_keys=True) + "\n"


def typescript() -> str:
    """Return the TypeScript types of all HTTP bodies and websocket frames."""
    schemas = {**_http_schemas(), **_live_schemas(), **_edit_schemas()}
    parts = ["// Made by `python -m editor_web.schema`; edit the Python models instead.\n"]
    parts.append("import type { Dict } from '../document/dict'\n")
    parts += [_interface(name, schemas[name]) for name in sorted(schemas)]
    parts.append("export type Frame = Hello | LiveSnapshot | LiveDelta | DocumentsChanged | Ping\n")
    parts.append(f"export type Edit = {' | '.join(_EDITS)}\n")
    return "\n".join(parts)


def _http_schemas() -> dict[str, Schema]:
    schemas = cast("dict[str, Schema]", app.openapi()["components"]["schemas"])
    return {name: schema for name, schema in schemas.items() if name not in _SERVER_ONLY}


def _live_schemas() -> dict[str, Schema]:
    _, components = msgspec.json.schema_components(
        [
            Hello,
            LiveSnapshot,
            LiveDelta,
            DocumentsChanged,
            Ping,
            Pong,
            WatchRun,
            OperateRun,
            ShowLayers,
            Timeline,
            PastRunState,
            RunFailure,
            *TEACHING,
        ],
        ref_template="#/components/schemas/{name}",
    )
    return dict(components)


def _edit_schemas() -> dict[str, Schema]:
    _, components = msgspec.json.schema_components(
        [AnyEdit], schema_hook=any_value, ref_template="#/components/schemas/{name}"
    )
    return dict(components)


def _interface(name: str, schema: Schema) -> str:
    required = set(schema.get("required", []))
    lines: list[str] = []
    if "description" in schema:
        text = " ".join(str(schema["description"]).split())
        lines.append(f"/** {text} */")
    lines.append(f"export interface {name} {{")
    for key, value in schema.get("properties", {}).items():
        # The server always sends complete bodies; the page may omit defaults.
        optional = "?" if key not in required and name in _SENT else ""
        lines.append(f"  readonly {key}{optional}: {_type(value)}")
    lines.append("}\n")
    return "\n".join(lines)


_EDITS = tuple(str(each.__name__) for each in get_args(AnyEdit))
_SENT = {
    *_EDITS,
    "Edge",
    "DemonstrationBody",
    "NewDocumentBody",
    "BreakpointBody",
    "RunPositionBody",
    "OperateRun",
    "ResumeBody",
    "StartBody",
    "StepBody",
    "StopBody",
    "DemonstrationStepBody",
    "SupervisionBody",
    "WatchRun",
}


def _type(schema: Schema) -> str:
    if "$ref" in schema:
        return str(schema["$ref"]).rsplit("/", 1)[-1]
    if "enum" in schema:
        return " | ".join(json.dumps(value) for value in schema["enum"])
    if "const" in schema:
        return json.dumps(schema["const"])
    if "anyOf" in schema:
        return " | ".join(_type(part) for part in schema["anyOf"])
    if schema.get("type") == "array":
        return _array(schema)
    if schema.get("type") == "object":
        given = schema.get("additionalProperties")
        inner = cast("Schema", given) if isinstance(given, dict) else {}
        return f"Dict<{_type(inner)}>"
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
