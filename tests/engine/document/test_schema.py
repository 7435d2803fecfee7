"""The committed JSON Schemas are those of the models."""

from __future__ import annotations

import json
from pathlib import Path

from engine.document.schema import SCHEMA_FOLDER, write_schemas


def test_the_committed_schemas_are_current(tmp_path: Path) -> None:
    """Run `write_schemas()` and commit when this fails."""
    fresh = {file.name: file.read_text(encoding="utf-8") for file in write_schemas(tmp_path)}
    committed = {file.name: file.read_text(encoding="utf-8") for file in SCHEMA_FOLDER.glob("*.json")}
    assert committed == fresh


def test_the_schema_of_a_node_has_the_keys_of_documents() -> None:
    """Keys are named as in YAML, not as in Python."""
    schema = json.loads((SCHEMA_FOLDER / "behavior.schema.json").read_text(encoding="utf-8"))
    assert {"state", "machine", "concurrency", "behavior", "with", "in", "out"} <= set(
        schema["$defs"]["NodeSpec"]["properties"]
    )
