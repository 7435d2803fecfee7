"""States to hold, release and check a part, by the kind of the tool."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated

import msgspec
from msgspec import Meta

from engine.cell import ToolKind, tool_kinds
from engine.registry import installed_state
from engine.state import State
from engine.wording import did_you_mean

ToolName = Annotated[
    str,
    Meta(
        min_length=1,
        description="Kind of the tool at the flange of the arm, such as `gripper`",
        extra_json_schema={"cell_name": "tool", "of": "robot"},
    ),
]


def require_tool(tool: str) -> None:
    """Raise ValueError where there is no such kind of tool; any is accepted while no models are installed."""
    kinds = tool_kinds()
    if kinds and tool not in kinds:
        raise ValueError(f"there is no kind of tool `{tool}`: {did_you_mean(tool, kinds)}")


def tool_resource(robot: str, tool: ToolName) -> str:
    """Return the bus namespace, and resource, of the tool of an arm."""
    return f"{robot}/{tool}"


def hold_state(robot: str, tool: ToolName, part: str, settings: Mapping[str, object]) -> State:
    """Return the state that makes the tool hold a part: `held`, `missed` or `failed`.

    Args:
        robot: The arm.
        tool: The kind of its tool.
        part: The part.
        settings: Values for the parameters that some kinds have; a kind takes those that it has.
    """
    kind = tool_kinds()[tool]
    return _state(kind.hold, kind, robot, part, settings)


def release_state(robot: str, tool: ToolName, part: str) -> State:
    """Return the state that makes the tool release its part; its failure outcome is `failed`."""
    kind = tool_kinds()[tool]
    return _state(kind.release, kind, robot, part, {})


def check_held_state(robot: str, tool: ToolName, part: str) -> State:
    """Return the state that checks whether the tool holds its part: `held` or `lost`."""
    kind = tool_kinds()[tool]
    return _state(kind.check, kind, robot, part, {})


def _state(name: str, kind: ToolKind, robot: str, part: str, settings: Mapping[str, object]) -> State:
    state = installed_state(name)
    own = {key: value for key, value in settings.items() if key in state.__struct_fields__}
    return msgspec.convert({kind.name: robot, "part": part, **own}, state)
