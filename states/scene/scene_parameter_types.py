"""Parameter types for the planning scene and its bodies."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

CELL = "cell"
"""Bus namespace of the planning scene services."""

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
        description="Name of the part, or of an obstacle that `scene.PutObstacle` added",
        extra_json_schema={"cell_name": "scene_part"},
    ),
]
TouchingName = Annotated[
    str,
    Meta(
        min_length=1,
        description="Obstacle, part, arm, or link of an arm as `arm/link`",
        extra_json_schema={"cell_name": "body"},
    ),
]
