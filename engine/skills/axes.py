"""Along which axes a way, a velocity or a step of the tool is given."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

Axes = Annotated[
    Literal["world", "base", "tool"],
    msgspec.Meta(description="Axes it is given along: the world's, the arm's base's or the tool's"),
]
