"""How states name the planning scene and what is in it."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

CELL = "cell"
"""The bus namespace that answers for the planning scene."""

ObstacleName = Annotated[
    str, Meta(min_length=1, description="Name of the obstacle", extra_json_schema={"cell_name": "obstacle"})
]
NewObstacleName = Annotated[
    str, Meta(min_length=1, description="Name of the obstacle", extra_json_schema={"new_cell_name": "obstacle"})
]
PartName = Annotated[
    str, Meta(min_length=1, description="Name of the part in the cell", extra_json_schema={"cell_name": "part"})
]
CarriedName = Annotated[
    str,
    Meta(
        min_length=1,
        description="Name of the part, or of an obstacle that was put",
        extra_json_schema={"cell_name": "scene_part"},
    ),
]
TouchingName = Annotated[
    str,
    Meta(
        min_length=1,
        description="An obstacle, a part, an arm, or a link of it as `arm/link`",
        extra_json_schema={"cell_name": "body"},
    ),
]
