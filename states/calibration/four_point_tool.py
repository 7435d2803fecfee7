"""calibration.FourPointTool: computes the tool centre point from poses in which the tip touches one point."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from msgspec import Meta

from engine.cause_chain import wrap_cause
from engine.errors import Cause, MeasuredValue
from engine.messages import Pose, Vector3
from engine.state import Context, Outcome, State, nothing_to_undo
from states.calibration.calibration_parameter_types import PoseEntries, ResidualLimit, require_poses, resolve_poses
from states.calibration.tool_point_regression import estimate_tool_point
from states.motion.motion_target import RobotName

_ALL = ("tool_xyz_m", "point_m", "residual_m", "residuals_m")


class FourPointTool(State, frozen=True, kw_only=True):
    """Compute the tool centre point from four or more poses of the tool link in which the tip touches one fixed point.

    `motion.ReadPose` reads such a pose. Writes the tip in the tool link, as `motion.SetToolFrame` takes it, the point,
    the distance of the tip from it in each pose, and the greatest of them as `residual_m`. `poor` where that exceeds
    `limit_m`; `failed` where the orientations are too alike.
    """

    state_name: ClassVar[str] = "calibration.FourPointTool"
    outcomes: ClassVar[tuple[str, ...]] = ("good", "poor", "failed")
    success: ClassVar[tuple[str, ...]] = ("good",)
    outputs: ClassVar[Mapping[str, Any]] = {
        "tool_xyz_m": Vector3,
        "point_m": Vector3,
        "residual_m": float,
        "residuals_m": tuple[float, ...],
    }
    unwritten: ClassVar[Mapping[str, tuple[str, ...]]] = {"failed": _ALL}
    undo = nothing_to_undo

    robot: RobotName
    poses: Annotated[tuple[Pose, ...], Meta(description="Poses of the tool link, all in one frame")] = ()
    entries: PoseEntries = ()
    limit_m: ResidualLimit = 0.0005
    least_tilt_rad: Annotated[
        float,
        Meta(
            ge=0.05,
            le=1.57,
            description="Smallest tilt, between two poses, of the axis of the tool link that is tilted least",
            extra_json_schema={"unit": "rad"},
        ),
    ] = 0.35

    def __post_init__(self) -> None:
        require_poses(self.poses, self.entries, parameter="poses")

    async def run(self, ctx: Context) -> Outcome:
        """Read the poses and compare the residual with its limit."""
        what = f"the tool centre point of {self.robot} was not determined"
        poses = await resolve_poses(ctx, self.poses, self.entries)
        estimate = estimate_tool_point(poses, least_tilt_rad=self.least_tilt_rad, where=self.robot)
        if isinstance(estimate, Cause):
            return Outcome("failed", cause=wrap_cause(what, estimate, where=ctx.path, kind=self.state_name))
        residual_m = max(estimate.residuals_m)
        values = (estimate.tool_xyz_m, estimate.point_m, residual_m, estimate.residuals_m)
        outputs: dict[str, object] = dict(zip(_ALL, values, strict=True))
        if residual_m <= self.limit_m:
            return Outcome("good", outputs)
        worst = estimate.residuals_m.index(residual_m) + 1
        residual, limit = residual_m * 1e3, self.limit_m * 1e3
        because = Cause(
            message=f"in pose {worst} the tip is {residual:.2f} mm from the common point, {limit:.2f} mm allowed",
            where=self.robot,
            compared=(MeasuredValue(quantity="residual", measured=residual, unit="mm", most=limit),),
        )
        return Outcome("poor", outputs, wrap_cause(what, because, where=ctx.path, kind=self.state_name))
