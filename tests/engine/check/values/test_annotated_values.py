"""The walk along a type gives each plain value with what the annotations say of it."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec
import pytest
from msgspec import Meta

from engine.check.values.annotated_values import annotated_values

Metres = Annotated[float, Meta(extra_json_schema={"unit": "m"})]
Named = Annotated[str, Meta(description="Which", extra_json_schema={"cell_name": "robot"})]


class Inner(msgspec.Struct, forbid_unknown_fields=True):
    """A struct with one field that is annotated and one that is not."""

    name: Named
    free: str = ""


class Other(msgspec.Struct, forbid_unknown_fields=True):
    """A struct with a list of which one item is annotated."""

    far: tuple[Metres, float]


@pytest.mark.parametrize(
    ("annotation", "value", "found"),
    [
        (Named, "left", [((), "left", {"cell_name": "robot"})]),
        (Named | None, "left", [((), "left", {"cell_name": "robot"})]),
        (str, "left", []),
        (tuple[Metres, ...], [1, 2], [((0,), 1, {"unit": "m"}), ((1,), 2, {"unit": "m"})]),
        (
            Annotated[tuple[float, float], Meta(extra_json_schema={"unit": "m"})],
            [1, "x", 3],
            [((0,), 1, {"unit": "m"}), ((1,), "x", {"unit": "m"})],
        ),
        (dict[str, Metres], {"a": 1}, [(("a",), 1, {"unit": "m"})]),
        (Inner | Named, {"name": "left", "free": "x"}, [(("name",), "left", {"cell_name": "robot"})]),
        (Inner | Named, "left", [((), "left", {"cell_name": "robot"})]),
        (Inner | None, {"neither": 1}, []),
        (Other, {"far": [1, 2]}, [(("far", 0), 1, {"unit": "m"})]),
        (list[Inner], [{"name": "a"}, {"name": 3}], [((0, "name"), "a", None), ((1, "name"), 3, None)]),
        (Annotated[Inner, Meta(extra_json_schema={"unit": "m"})], {"name": "a"}, [(("name",), "a", None)]),
    ],
)
def test_values_are_found_with_what_is_said_of_them(annotation: Any, value: object, found: list[Any]) -> None:
    """Through unions, lists and structs; a struct passes nothing on, and descriptions are left out."""
    expected = [(steps, each, {"cell_name": "robot"} if says is None else says) for steps, each, says in found]
    assert [(part.steps, part.value, part.says) for part in annotated_values(annotation, value)] == expected
