"""How states name the planning scene and what is in it."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

CELL = "cell"
"""The bus namespace that answers for the planning scene."""

ObstacleName = Annotated[str, Meta(min_length=1, description="Name of the obstacle")]
PartName = Annotated[str, Meta(min_length=1, description="Name of the part in the cell")]
TouchingName = Annotated[
    str, Meta(min_length=1, description="An obstacle, a part, an arm, or a link of it as `arm/link`")
]
