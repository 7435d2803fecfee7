"""The parameters of the states of tool changers."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

ChangeableToolName = Annotated[
    str,
    Meta(
        min_length=1,
        description="Name of the tool: a part of the cell with `tool:`",
        extra_json_schema={"cell_name": "changeable_tool"},
    ),
]
ToolChangerName = Annotated[
    str,
    Meta(min_length=1, description="The arm with the tool changer", extra_json_schema={"cell_name": "tool_changer"}),
]
_POINT = {"cell_name": "tool_point", "of": "tool"}
ToolPointName = Annotated[
    str, Meta(min_length=1, description="Name of a tool centre point of the tool", extra_json_schema=_POINT)
]
FirstToolPointName = Annotated[
    str,
    Meta(description="Name of a tool centre point of the tool; its first one by default", extra_json_schema=_POINT),
]
