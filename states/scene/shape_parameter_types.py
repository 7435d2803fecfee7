"""Shapes as behaviors write them, the way fixtures of a cell are written: a word and its full lengths."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Literal

from msgspec import Meta

from engine.messages.shapes import Box, Capsule, Cylinder, Shape, Sphere

ShapeName = Annotated[
    Literal["box", "cylinder", "sphere", "capsule"], Meta(description="What it is, or what is around it")
]
Lengths = Annotated[
    tuple[Annotated[float, Meta(gt=0)], ...],
    Meta(
        description="Edges of a box; diameter and length of a cylinder or capsule, whole; diameter of a sphere",
        extra_json_schema={"unit": "m"},
    ),
]

_DUE: Mapping[str, str] = {
    "box": "its edges x, y and z",
    "cylinder": "its diameter and length",
    "sphere": "its diameter",
    "capsule": "its diameter and length, which is no less",
}


def shape_of(name: str, size_m: tuple[float, ...]) -> Shape:
    """Return the shape of these full lengths in metres.

    Raises:
        ValueError: other lengths are due; says which.
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
            raise ValueError(f"`size_m` of a {name} is {_DUE[name]}")
