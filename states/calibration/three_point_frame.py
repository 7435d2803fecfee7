"""calibration.ThreePointFrame: computes a frame from points that a calibrated tool touches."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.cause_chain import wrap_cause
from engine.errors import Cause, MeasuredValue
from engine.messages import Pose
from engine.state import Context, Outcome, State, nothing_to_undo
from states.calibration.calibration_parameter_types import PoseEntries, ResidualLimit, require_poses, resolve_poses
from states.calibration.three_point_frame_fit import fit_frame


class ThreePointFrame(State, frozen=True, kw_only=True):
    """Compute a frame from three points: its origin, one on its +x axis, and one in its xy plane on the side of y.

    Each is a pose of the tool centre point, or an entry of one; orientations are ignored. More points in the plane are
    fitted by least squares. Writes the pose of the frame, and as `residual_m` the greatest distance of a point from
    the plane, zero for three points. `poor` where it exceeds `limit_m`; `failed` where points are too near to one
    another or to the x axis.
    """

    state_name: ClassVar[str] = "calibration.ThreePointFrame"
    outcomes: ClassVar[tuple[str, ...]] = ("good", "poor", "failed")
    success: ClassVar[tuple[str, ...]] = ("good",)
    outputs: ClassVar[Mapping[str, Any]] = {"pose": Pose, "residual_m": float}
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": ("pose", "residual_m")}
    undo = nothing_to_undo

    points: Annotated[tuple[Pose, ...], Meta(description="Poses at the origin, on +x, then in the xy plane")] = ()
    entries: PoseEntries = ()
    limit_m: ResidualLimit = 0.0005
    least_m: Annotated[
        float,
        Meta(
            ge=0.001,
            description="Smallest distance of the second point from the first, and of the third from the x axis",
            extra_json_schema={"unit": "m"},
        ),
    ] = 0.05

    def __post_init__(self) -> None:
        require_poses(self.points, self.entries, parameter="points")

    async def run(self, ctx: Context) -> Outcome:
        """Read the points and compare the residual with its limit."""
        what = "the frame was not determined"
        points = await resolve_poses(ctx, self.points, self.entries)
        fit = fit_frame(points, least_m=self.least_m, where=ctx.path)
        if isinstance(fit, Cause):
            return Outcome("failed", cause=wrap_cause(what, fit, where=ctx.path, kind=self.state_name))
        outputs: dict[str, object] = {"pose": fit.pose, "residual_m": fit.residual_m}
        if fit.residual_m <= self.limit_m:
            return Outcome("good", outputs)
        residual, limit = fit.residual_m * 1e3, self.limit_m * 1e3
        because = Cause(
            message=f"a point is {residual:.2f} mm from the xy plane, {limit:.2f} mm allowed",
            where=ctx.path,
            compared=(MeasuredValue(quantity="residual", measured=residual, unit="mm", most=limit),),
        )
        return Outcome("poor", outputs, wrap_cause(what, because, where=ctx.path, kind=self.state_name))
