"""The axes along which a path, a velocity or a step of the tool is given."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

Axes = Annotated[
    Literal["world", "base", "tool"],
    msgspec.Meta(description="Reference axes: those of the world, of the arm's base or of the tool"),
]
