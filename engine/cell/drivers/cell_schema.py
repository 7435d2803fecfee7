"""The JSON Schema of cell documents with the options of the installed drivers."""

from __future__ import annotations

import json
from typing import Any

import msgspec

from engine.cell.drivers.driver import Driver
from engine.cell.drivers.driver_assignments import DeviceKind, driven_kind
from engine.cell.drivers.driver_registry import installed_drivers
from engine.document.schema import one_line_texts, schema_texts


def cell_schema_text() -> str:
    """Return the schema: `driver` is `sim`, the options of an installed driver, or those of an unknown one."""
    schema: dict[str, Any] = json.loads(schema_texts()["cell.schema.json"])
    drivers = tuple(installed_drivers().values())
    parts, definitions = msgspec.json.schema_components(
        [driver.options for driver in drivers], ref_template="#/$defs/{name}"
    )
    schema["$defs"] |= one_line_texts(definitions)
    options = dict(zip((driver.kind for driver in drivers), parts, strict=True))
    places: dict[str, DeviceKind] = {"RobotSpec": "arm", "GripperSpec": "tool", "EquipmentSpec": "equipment"}
    for place, device in places.items():
        entry = schema["$defs"][place]["properties"]["driver"]
        offered = [options[driver.kind] for driver in drivers if driven_kind(driver) == device]
        entry["anyOf"] = [
            *(each for each in entry["anyOf"] if each.get("type") != "object"),
            *offered,
            _another(driver for driver in drivers if driven_kind(driver) == device),
        ]
    return json.dumps(schema, indent=2, ensure_ascii=False) + "\n"


def _another(drivers: Any) -> dict[str, object]:
    """Return the schema of a driver that is not installed here: any options, and a name of its own."""
    known: list[str] = sorted(driver.kind for driver in drivers if isinstance(driver, Driver))
    kind = {"type": "string", **({"not": {"enum": known}} if known else {})}
    return {"type": "object", "properties": {"kind": kind}, "required": ["kind"]}
