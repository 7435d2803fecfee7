"""cell.ExpectPart: checks position and orientation of a part."""

from __future__ import annotations

import math
from typing import Annotated, ClassVar

import msgspec
from msgspec import Meta

from engine.cause_chain import wrap_cause
from engine.errors import Cause, MeasuredValue, StateError
from engine.messages import FramePoses, PartPoses, Pose, Quaternion, Vector3
from engine.state import Context, Outcome, State, nothing_to_undo
from engine.wording import did_you_mean
from states.cell.part_orientation import Angle, ExpectedOrientation, orientation_fault, tilt_fault
from states.frames import FRAMES_TOPIC, PARTS_TOPIC, measured_pose
from states.scene.scene_parameter_types import PartName

Pair = tuple[float, float]
Metres = Annotated[float, Meta(gt=0, extra_json_schema={"unit": "m"})]
_METRES = {"unit": "m"}
_USUALLY_UP: Vector3 = (0.0, 0.0, 1.0)
"""The axis of parts that `PartPoses` does not list."""


class Region(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A rectangle along the world axes: centre, full edge lengths, and optionally a height range."""

    center_m: Annotated[Pair, Meta(extra_json_schema=_METRES)]
    size_m: Annotated[tuple[Metres, Metres], Meta(extra_json_schema=_METRES)]
    height_m: Annotated[Pair, Meta(extra_json_schema={**_METRES, "parts": ["low", "high"]})] | None = None

    def misses(self, xyz: Vector3) -> tuple[MeasuredValue, ...]:
        """Return the coordinates of a point that lie outside."""
        sides = [
            (center - size / 2, center + size / 2) for center, size in zip(self.center_m, self.size_m, strict=True)
        ]
        bounds = (*sides, self.height_m or (-math.inf, math.inf))
        return tuple(
            MeasuredValue(
                quantity=f"{axis} of its centre", measured=at * 1e3, unit="mm", least=low * 1e3, most=high * 1e3
            )
            for axis, at, (low, high) in zip("xyz", xyz, bounds, strict=True)
            if not low <= at <= high
        )

    def __str__(self) -> str:
        heights = f", heights {self.height_m[0]:.3f} to {self.height_m[1]:.3f} m" if self.height_m else ""
        width, length = self.size_m
        return f"within {width:.3f} x {length:.3f} m around ({self.center_m[0]:.3f}, {self.center_m[1]:.3f}){heights}"


class ExpectPart(State, frozen=True, kw_only=True):
    """Check that the centre of a part lies in a region, or within `tolerance_m` of a frame, and that it stands.

    A part stands if the axis that points up where the cell document places it points up within `tilt_rad`; with an
    `orientation` it is turned so instead. A part that may lie anyhow has a `tilt_rad` of 3.15.
    """

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
    tilt_rad: Annotated[Angle, Meta(description="Maximum tilt of the part's upward axis, without `orientation`")] = 0.17
    orientation: Annotated[
        ExpectedOrientation | None, Meta(description="Expected orientation, in `frame` or else in the world")
    ] = None

    def __post_init__(self) -> None:
        if (self.region is None) == (not self.frame):
            raise ValueError("give either `region` or `frame`")

    async def run(self, ctx: Context) -> Outcome:
        """Compare the latest measured pose of the part with what is expected."""
        parts = await ctx.latest(PARTS_TOPIC, PartPoses)
        pose = measured_pose(parts, self.part)
        if isinstance(pose, Cause):
            return self._elsewhere(ctx, pose)
        frame = await self._frame_pose(ctx) if self.frame else Pose(xyz=(0.0, 0.0, 0.0))
        position = _region_fault(self.region, pose.xyz) if self.region else self._frame_fault(frame.xyz, pose.xyz)
        turned = self._turned(parts, pose.xyzw, frame.xyzw)
        faults = [fault for fault in (position, turned) if fault is not None]
        return self._elsewhere(ctx, _joined(faults), toppled=position is None) if faults else Outcome("there")

    async def _frame_pose(self, ctx: Context) -> Pose:
        frames = await ctx.latest(FRAMES_TOPIC, FramePoses)
        if self.frame not in frames.names:
            raise StateError(
                f"the cell shows no frame {self.frame}", where=ctx.path, hint=did_you_mean(self.frame, frames.names)
            )
        row = frames.names.index(self.frame)
        return Pose(xyz=frames.xyz[row], xyzw=frames.xyzw[row])

    def _frame_fault(self, expected: Vector3, measured: Vector3) -> Cause | None:
        distance_m = math.dist(measured, expected)
        if distance_m <= self.tolerance_m:
            return None
        distance = f"{distance_m * 1e3:.1f} mm from {self.frame}, {self.tolerance_m * 1e3:.1f} mm allowed"
        return Cause(
            message=f"it lies at {_format_xyz(measured)}, {distance}",
            where=PARTS_TOPIC,
            compared=(
                MeasuredValue(
                    quantity=f"distance from {self.frame}",
                    measured=distance_m * 1e3,
                    unit="mm",
                    most=self.tolerance_m * 1e3,
                ),
            ),
        )

    def _turned(self, parts: PartPoses, measured: Quaternion, frame: Quaternion) -> Cause | None:
        if self.orientation is not None:
            return orientation_fault(self.orientation, measured, frame, where=PARTS_TOPIC)
        up = parts.up.get(self.part, _USUALLY_UP)
        return tilt_fault(up, measured, most_rad=self.tilt_rad, where=PARTS_TOPIC) if up is not None else None

    def _elsewhere(self, ctx: Context, because: Cause, *, toppled: bool = False) -> Outcome:
        expected = self.frame or "its region"
        message = f"part {self.part} does not lie at {expected}"
        if toppled:
            message = f"part {self.part} lies at {expected}, turned otherwise than expected"
        return Outcome("elsewhere", cause=wrap_cause(message, because, where=ctx.path, kind=self.state_name))


def _region_fault(region: Region, xyz: Vector3) -> Cause | None:
    misses = region.misses(xyz)
    if not misses:
        return None
    return Cause(message=f"it lies at {_format_xyz(xyz)}, not {region}", where=PARTS_TOPIC, compared=misses)


def _joined(faults: list[Cause]) -> Cause:
    compared = tuple(value for fault in faults for value in fault.compared)
    return Cause(message="; ".join(fault.message for fault in faults), where=PARTS_TOPIC, compared=compared)


def _format_xyz(xyz: Vector3) -> str:
    return f"({', '.join(f'{value:.3f}' for value in xyz)}) m"
