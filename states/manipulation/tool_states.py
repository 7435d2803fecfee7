"""States to release and check a part, by kind of tool."""

from __future__ import annotations

from typing import Annotated, Literal

from msgspec import Meta

from engine.state import State
from states.gripper.check_held import CheckHeld as GripperCheckHeld
from states.gripper.open import Open as GripperOpen
from states.hand.check_held import CheckHeld as HandCheckHeld
from states.hand.open import Open as HandOpen
from states.magnet.check_held import CheckHeld as MagnetCheckHeld
from states.magnet.off import Off as MagnetOff

ToolKind = Annotated[
    Literal["gripper", "magnet", "hand"],
    Meta(
        description="Kind of tool: gripper with two fingers, magnet, or hand with one motor",
        extra_json_schema={"cell_name": "tool", "of": "robot"},
    ),
]


def tool_resource(robot: str, tool: ToolKind) -> str:
    """Return the bus namespace, and resource, of the tool of an arm."""
    return f"{robot}/{tool}"


def release_state(robot: str, tool: ToolKind, part: str) -> State:
    """Return the state that opens the tool or switches it off; its failure outcome is `failed`."""
    match tool:
        case "gripper":
            return GripperOpen(gripper=robot, part=part)
        case "magnet":
            return MagnetOff(magnet=robot, part=part)
        case "hand":
            return HandOpen(hand=robot, part=part)


def check_held_state(robot: str, tool: ToolKind, part: str) -> State:
    """Return the state that checks whether the tool holds its part: `held` or `lost`."""
    match tool:
        case "gripper":
            return GripperCheckHeld(gripper=robot, part=part)
        case "magnet":
            return MagnetCheckHeld(magnet=robot, part=part)
        case "hand":
            return HandCheckHeld(hand=robot, part=part)
