"""cell.ExpectPart: checks the position of a part."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar

import msgspec
from msgspec import Meta

from engine.cause_chain import wrap_cause
from engine.errors import Cause, MeasuredValue, StateError
from engine.messages import FramePoses, Vector3
from engine.state import Context, Outcome, State, nothing_to_undo
from engine.suggestions import did_you_mean
from states.frames import FRAMES_TOPIC, PARTS_TOPIC, part_in_world
from states.scene.scene_parameter_types import PartName

Pair = tuple[float, float]
Metres = Annotated[float, Meta(gt=0, extra_json_schema={"unit": "m"})]
_METRES = {"unit": "m"}


class Region(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A rectangle along the world axes: centre, full edge lengths, and optionally a height range."""

    center_m: Annotated[Pair, Meta(extra_json_schema=_METRES)]
    size_m: Annotated[tuple[Metres, Metres], Meta(extra_json_schema=_METRES)]
    height_m: Annotated[Pair, Meta(extra_json_schema={**_METRES, "parts": ["low", "high"]})] | None = None

    def contains(self, xyz: Vector3) -> bool:
        """Return whether a point lies inside, edges included."""
        inside = all(abs(xyz[axis] - self.center_m[axis]) <= self.size_m[axis] / 2 for axis in (0, 1))
        low, high = self.height_m or (-math.inf, math.inf)
        return inside and low <= xyz[2] <= high

    def __str__(self) -> str:
        heights = f", heights {self.height_m[0]:.3f} to {self.height_m[1]:.3f} m" if self.height_m else ""
        width, length = self.size_m
        return f"within {width:.3f} x {length:.3f} m around ({self.center_m[0]:.3f}, {self.center_m[1]:.3f}){heights}"


class ExpectPart(State, frozen=True, kw_only=True):
    """Check that the centre of a part lies in a region, or within `tolerance_m` of a frame of the cell."""

    state_name: ClassVar[str] = "cell.ExpectPart"
    outcomes: ClassVar[tuple[str, ...]] = ("there", "elsewhere")
    success: ClassVar[tuple[str, ...]] = ("there",)
    undo = nothing_to_undo

    part: PartName
    region: Annotated[Region | None, Meta(description="Expected region of the part's centre, in the world frame")] = (
        None
    )
    frame: Annotated[
        str,
        Meta(description="Expected frame of the cell at the part's centre", extra_json_schema={"cell_name": "frame"}),
    ] = ""
    tolerance_m: Annotated[
        float, Meta(gt=0, description="Maximum distance from the frame", extra_json_schema={"unit": "m"})
    ] = 0.05

    def __post_init__(self) -> None:
        if (self.region is None) == (not self.frame):
            raise ValueError("give either `region` or `frame`")

    async def run(self, ctx: Context) -> Outcome:
        """Compare the latest measured pose of the part with the region or the frame."""
        pose = await part_in_world(ctx, self.part)
        if isinstance(pose, Cause):
            return self._elsewhere(ctx, pose)
        xyz = pose.xyz
        fault = _region_fault(self.region, xyz) if self.region else await self._frame_fault(ctx, xyz)
        return self._elsewhere(ctx, fault) if fault is not None else Outcome("there")

    async def _frame_fault(self, ctx: Context, xyz: Vector3) -> Cause | None:
        frames = await ctx.latest(FRAMES_TOPIC, FramePoses)
        if self.frame not in frames.names:
            raise StateError(
                f"the cell shows no frame {self.frame}", where=ctx.path, hint=did_you_mean(self.frame, frames.names)
            )
        distance_m = math.dist(xyz, frames.xyz[frames.names.index(self.frame)])
        if distance_m <= self.tolerance_m:
            return None
        distance = f"{distance_m:.3f} m from {self.frame}, {self.tolerance_m:.3f} m allowed"
        return Cause(
            message=f"it lies at {_format_xyz(xyz)}, {distance}",
            where=PARTS_TOPIC,
            compared=(
                MeasuredValue(
                    quantity=f"distance from {self.frame}", measured=distance_m, unit="m", most=self.tolerance_m
                ),
            ),
        )

    def _elsewhere(self, ctx: Context, because: Cause) -> Outcome:
        expected = self.frame or "its region"
        message = f"part {self.part} does not lie at {expected}"
        return Outcome("elsewhere", cause=wrap_cause(message, because, where=ctx.path, kind=self.state_name))


def _region_fault(region: Region, xyz: Vector3) -> Cause | None:
    if region.contains(xyz):
        return None
    return Cause(message=f"it lies at {_format_xyz(xyz)}, not {region}", where=PARTS_TOPIC)


def _format_xyz(xyz: Vector3) -> str:
    return f"({', '.join(f'{value:.3f}' for value in xyz)}) m"
