"""Each text that a shipped state takes declares in its type what it names, so that checks and pick lists know it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import cast

import pytest

from engine.cell.cell_names import is_kind
from engine.document import load_source
from engine.document.signature import Schema, read_signature
from engine.registry import load_states

BEHAVIORS = Path(__file__).parents[2] / "behaviors"
NAMES = frozenset(
    ("cell_name", "new_cell_name", "cell_label", "entry", "entry_of", "new_entry", "new_entry_of", "entry_kind")
)
KINDS_OF_THE_CELL = ("cell_name", "new_cell_name", "cell_label")
NAMELESS = frozenset(
    (
        "flow.Log.message",
        "bus.CheckMessage.condition",
        "bus.WaitForMessage.condition",
        "motion.IdentifyFriction.joints[]",
        "calibration.FourPointTool.poses[].frame",
        "calibration.ThreePointFrame.points[].frame",
    )
)
"""What is written for people, expressions over a message, joints, which depend on the model of the robot, and frames of
poses that a state has measured.
"""


def _texts(schema: Schema, definitions: Mapping[str, Schema], at: str, says: frozenset[str]) -> Iterator[str]:
    """Yield where a value may be a text without choices that declares nothing."""
    says |= NAMES & schema.keys()
    reference = str(schema.get("$ref", ""))
    if reference:
        yield from _texts(definitions[reference.rpartition("/")[2]], definitions, at, says)
    for key in ("anyOf", "prefixItems"):
        for option in cast("list[Schema]", schema.get(key, [])):
            yield from _texts(option, definitions, at, says)
    for key in ("items", "additionalProperties"):
        if isinstance(inner := schema.get(key), dict):
            yield from _texts(cast("Schema", inner), definitions, f"{at}[]", says)
    for name, inner in cast("dict[str, Schema]", schema.get("properties", {})).items():
        yield from _texts(inner, definitions, f"{at}.{name}", frozenset())
    if schema.get("type") == "string" and "enum" not in schema and not says:
        yield at


def _parameters() -> Iterator[tuple[str, Schema]]:
    for state in load_states().values():
        signature = read_signature(state)
        for key in signature.parameters.values():
            yield f"{signature.name}.{key.name}", key.schema


def _unnamed(where: str, schema: Schema) -> list[str]:
    return list(_texts(schema, cast("Mapping[str, Schema]", schema.get("$defs", {})), where, frozenset()))


def test_no_parameter_that_names_something_is_a_plain_text() -> None:
    """A new one names its kind: `Meta(extra_json_schema={"cell_name": "robot"})`; see the guide on states."""
    found = {place for where, schema in _parameters() for place in _unnamed(where, schema)}
    assert found == NAMELESS


@pytest.mark.parametrize(
    "schema",
    [
        {"type": "string"},
        {"anyOf": [{"type": "null"}, {"type": "string"}]},
        {
            "$ref": "#/$defs/Target",
            "$defs": {"Target": {"type": "object", "properties": {"frame": {"type": "string"}}}},
        },
        {"type": "array", "items": {"type": "string"}},
    ],
)
def test_a_plain_text_is_found_wherever_it_stands(schema: Schema) -> None:
    """In an alternative, a struct or a list."""
    assert _unnamed("x", schema)


def test_each_declared_kind_is_one_that_a_cell_lists() -> None:
    """A misspelt kind would be checked by nobody."""
    due: list[object] = [schema for _, schema in _parameters()]
    kinds: set[object] = set()
    while due:
        here = due.pop()
        if isinstance(here, dict):
            said = cast("dict[str, object]", here)
            kinds |= {
                said[key] for key in ("cell_name", "new_cell_name", "cell_label") if isinstance(said.get(key), str)
            }
            due += said.values()
        elif isinstance(here, list):
            due += cast("list[object]", here)
    assert {"robot", "part", "frame"} <= kinds
    assert [kind for kind in kinds if is_kind(kind) is None] == []


def test_each_text_parameter_of_a_shipped_behavior_has_choices_or_names_something() -> None:
    found = [
        f"{file.stem}.{name}"
        for file in sorted(BEHAVIORS.rglob("*.yaml"))
        if file.parent.name not in ("cells", "entries")
        for name, spec in _declared(file).items()
        if spec.get("type") == "string" and not NAMES & spec.keys() and "choices" not in spec
    ]
    assert found == []
    assert _declared(BEHAVIORS / "pick_and_place" / "confirmed_move.yaml")["target"]["entry"] == "joints"


def _declared(file: Path) -> dict[str, dict[str, object]]:
    data = cast("dict[str, object]", load_source(file).data)
    return cast("dict[str, dict[str, object]]", data.get("parameters", {}))
