"""Parameter types of the gripper states; the name of a gripper is that of its arm."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

GripperName = Annotated[
    str, Meta(min_length=1, description="The arm that carries the gripper", extra_json_schema={"cell_name": "gripper"})
]


def gripper_address(arm: str) -> str:
    """Return the bus namespace, and resource, of the gripper on an arm."""
    return f"{arm}/gripper"
