"""Parameter types of the magnet states; the name of a magnet is that of its arm."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

MagnetName = Annotated[
    str, Meta(min_length=1, description="The arm that carries the magnet", extra_json_schema={"cell_name": "magnet"})
]


def magnet_address(arm: str) -> str:
    """Return the bus namespace, and resource, of the magnet on an arm."""
    return f"{arm}/magnet"
