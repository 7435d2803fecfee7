"""Parameter types of the hand states; the name of a hand is that of its arm."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

HandName = Annotated[
    str, Meta(min_length=1, description="The arm that carries the hand", extra_json_schema={"cell_name": "hand"})
]
Percent = Annotated[
    float, Meta(ge=0, le=100, description="Target closing, 0 open to 100 closed", extra_json_schema={"unit": "%"})
]
ClosingTime = Annotated[float, Meta(gt=0, description="Duration of the motion", extra_json_schema={"unit": "s"})]


def hand_address(arm: str) -> str:
    """Return the bus namespace, and resource, of the hand on an arm."""
    return f"{arm}/hand"
