"""Shapes as behaviors and fixtures of a cell write them: a name and full lengths."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from msgspec import Meta

from engine.messages.shapes import Box, Capsule, Cylinder, Shape, Sphere

ShapeName = Annotated[
    Literal["box", "cylinder", "sphere", "capsule"], Meta(description="Shape of the obstacle, or its bounding shape")
]
Lengths = Annotated[
    tuple[Annotated[float, Meta(gt=0)], ...],
    Meta(
        description="Edges of a box; diameter and overall length of a cylinder or capsule; diameter of a sphere",
        extra_json_schema={"unit": "m"},
    ),
]

_REQUIRED_LENGTHS: Mapping[str, str] = {
    "box": "its edges x, y and z",
    "cylinder": "its diameter and length",
    "sphere": "its diameter",
    "capsule": "its diameter and its length of at least the diameter",
}


def shape_of(name: str, size_m: tuple[float, ...]) -> Shape:
    """Return the shape with these full lengths in metres.

    Raises:
        ValueError: the shape needs other lengths; the message names them.
    """
    match name, size_m:
        case "box", (x, y, z):
            return Box(size_m=(x, y, z))
        case "cylinder", (diameter, length):
            return Cylinder(radius_m=diameter / 2, length_m=length)
        case "sphere", (diameter,):
            return Sphere(radius_m=diameter / 2)
        case "capsule", (diameter, length) if length >= diameter:
            return Capsule(radius_m=diameter / 2, length_m=length - diameter)
        case _:
            raise ValueError(f"`size_m` of a {name} is {_REQUIRED_LENGTHS[name]}")
