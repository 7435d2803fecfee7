"""How states that hold something name the part that it is about."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

PartLabel = Annotated[str, Meta(description="The part it is about, as messages shall name it")]


def part_label(part: str) -> str:
    """Name the part in a message, whether or not the behavior says which it is."""
    return f"part {part}" if part else "a part"
