"""The part that states grasp, hold or release: its name in messages, and whether it is what the tool holds."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta, UnsetType

from engine.errors import Cause
from engine.messages import HoldEvidence

UNKNOWN_BODY = "?"
"""Name of a touched body that a tool cannot name."""

PartLabel = Annotated[
    str,
    Meta(
        description="Name of the part; where the tool measures which body it touches, another one is not held",
        extra_json_schema={"cell_label": "part"},
    ),
]


def part_label(part: str) -> str:
    """Return the part's name for a message, or `a part` if the behavior gives none."""
    return f"part {part}" if part else "a part"


def wrong_part(expected: str, held: str | UnsetType, *, where: str) -> Cause | None:
    """Return why the body in a tool is not the expected part; None if it is, or if one of them has no name."""
    if not expected or isinstance(held, UnsetType) or held in ("", UNKNOWN_BODY, expected):
        return None
    return Cause(message=f"it holds {held}, by contact, and not {expected}", where=where)


def hold_evidence(*contacts: str, otherwise: HoldEvidence) -> HoldEvidence:
    """Return `contact` if a contact names a body, else what the tool measures beside its contacts.

    A tool with no place that feels a contact cannot tell that anything is held.
    """
    if not contacts:
        return "not measured"
    return "contact" if any(body and body != UNKNOWN_BODY for body in contacts) else otherwise
