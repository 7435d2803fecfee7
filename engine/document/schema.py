"""JSON Schemas of the document formats, generated from the models and committed with them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import cast

import msgspec

from engine.document.behavior import BehaviorDocument
from engine.document.cell import CellDocument
from engine.document.entries_document import EntriesDocument
from engine.document.equipment.equipment_document import EquipmentDocument
from engine.document.faults import FaultsDocument
from engine.document.module_document import ModuleDocument
from engine.document.parameter_spec import any_value
from engine.document.project_file import ProjectDocument
from engine.document.substitutes import SubstitutesDocument
from engine.document.sweep import SweepDocument

SCHEMA_FOLDER = Path(__file__).parent / "schemas"
_MODELS = {
    "behavior": BehaviorDocument,
    "cell": CellDocument,
    "entries": EntriesDocument,
    "equipment": EquipmentDocument,
    "faults": FaultsDocument,
    "module": ModuleDocument,
    "project": ProjectDocument,
    "substitutes": SubstitutesDocument,
    "sweep": SweepDocument,
}


def schema_texts() -> dict[str, str]:
    """Return the JSON Schema of each format as text, by file name."""
    texts: dict[str, str] = {}
    for name, model in _MODELS.items():
        schema = {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": f"flexcell {name} document",
            **msgspec.json.schema(model, schema_hook=any_value),
        }
        text = json.dumps(one_line_texts(schema), indent=2, ensure_ascii=False) + "\n"
        # A model that holds nodes is named without them.
        texts[f"{name}.schema.json"] = text.replace("_NodeSpec_", "").replace("[NodeSpec]", "")
    return texts


def write_schemas(folder: Path = SCHEMA_FOLDER) -> tuple[Path, ...]:
    """Write the schema files into `folder` and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    written: list[Path] = []
    for name, text in schema_texts().items():
        file = folder / name
        file.write_text(text, encoding="utf-8")
        written.append(file)
    return tuple(written)


def one_line_texts(value: object) -> object:
    """Remove the line breaks and indents of docstrings from descriptions."""
    if isinstance(value, str):
        return " ".join(value.split())
    if isinstance(value, dict):
        return {key: one_line_texts(item) for key, item in cast("dict[str, object]", value).items()}
    if isinstance(value, list | tuple):
        return [one_line_texts(item) for item in cast("list[object]", value)]
    return value
