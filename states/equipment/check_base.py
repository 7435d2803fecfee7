"""equipment.CheckBase: compares where the carriage of a linear unit is with a place."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from engine.cause_chain import cause_of, wrap_cause
from engine.errors import Cause, SkillFailed
from engine.skills.linear_units import ReadLinearUnit
from engine.state import Context, Outcome, State, nothing_to_undo
from states.equipment.device_parameter_types import DeviceName
from states.equipment.linear_unit_types import (
    PlaceTolerance,
    UnitPlaceMetres,
    UnitPlaceName,
    compared_place,
    place_words,
    require_one_place,
)


class CheckBase(State, frozen=True, kw_only=True):
    """Check that a carriage is at a place, within 1 mm unless said otherwise; writes the error.

    Its scale tells where it is, without one what the cell shows.
    """

    state_name: ClassVar[str] = "equipment.CheckBase"
    outcomes: ClassVar[tuple[str, ...]] = ("at_place", "off", "failed")
    success: ClassVar[tuple[str, ...]] = ("at_place",)
    outputs: ClassVar[Mapping[str, Any]] = {"error_m": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("error_m",)}
    undo = nothing_to_undo

    device: DeviceName
    place: UnitPlaceName = ""
    place_m: UnitPlaceMetres = None
    tolerance_m: PlaceTolerance = 0.001

    def __post_init__(self) -> None:
        require_one_place(self.place, self.place_m)

    async def run(self, ctx: Context) -> Outcome:
        """Read where it is and compare."""
        what = f"{self.device} is not at {place_words(self.place, self.place_m)}"
        request = ReadLinearUnit(place=self.place, place_m=self.place_m or 0.0)
        try:
            reading = await ctx.call(request, to=self.device)
        except SkillFailed as error:
            return Outcome("failed", cause=wrap_cause(what, cause_of(error), where=ctx.path, kind=self.state_name))
        place_m = reading.place_m if reading.scale_m is None else reading.scale_m
        error_m = place_m - reading.target_m
        if abs(error_m) <= self.tolerance_m:
            return Outcome("at_place", {"error_m": error_m})
        because = Cause(
            message=f"its carriage is {1e3 * abs(error_m):.2f} mm away",
            where=request.address(self.device),
            compared=compared_place(error_m, self.tolerance_m),
        )
        cause = wrap_cause(what, because, where=ctx.path, kind=self.state_name)
        return Outcome("off", {"error_m": error_m}, cause)
