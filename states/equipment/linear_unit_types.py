"""The parameters of the states of linear units, and how far a carriage is from its place."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from engine.errors import MeasuredValue

UnitPlaceName = Annotated[
    str,
    Meta(
        description="Name of one of its places; empty for `place_m`",
        extra_json_schema={"cell_name": "unit_place", "of": "device"},
    ),
]
UnitPlaceMetres = Annotated[
    float | None,
    Meta(
        description="Place along the rail instead of a name; 0 is where the cell document has the carriage",
        extra_json_schema={"unit": "m"},
    ),
]
PlaceTolerance = Annotated[
    float, Meta(gt=0, description="Permitted distance from the place", extra_json_schema={"unit": "m"})
]


def require_one_place(place: str, place_m: float | None) -> None:
    """Raise ValueError unless exactly one of both is given."""
    if bool(place) == (place_m is not None):
        raise ValueError("give either `place` or `place_m`")


def place_words(place: str, place_m: float | None) -> str:
    """Return a place in words."""
    return place or f"{place_m:.3f} m"


def compared_place(error_m: float, tolerance_m: float) -> tuple[MeasuredValue, ...]:
    """Return the distance from a place as a measured value with its limit."""
    return (MeasuredValue(quantity="distance", measured=1e3 * abs(error_m), unit="mm", most=1e3 * tolerance_m),)
