"""The part name in the messages of states that grasp, hold or release."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

PartLabel = Annotated[str, Meta(description="Name of the part in messages", extra_json_schema={"cell_label": "part"})]


def part_label(part: str) -> str:
    """Return the part's name for a message, or `a part` if the behavior gives none."""
    return f"part {part}" if part else "a part"
