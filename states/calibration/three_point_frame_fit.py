"""A frame from its origin, a point on its x axis, and one or more points in its xy plane on the side of y."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from engine.errors import Cause, MeasuredValue
from engine.messages import Pose, Quaternion, Vector3
from states.calibration.vectors import add, cross, dot, scale, subtract

LEAST_POINTS = 3


class FrameFit(NamedTuple):
    """The frame, and the greatest distance of a point from its xy plane: zero with one point in the plane."""

    pose: Pose
    residual_m: float


def fit_frame(points: Sequence[Pose], *, least_m: float, where: str) -> FrameFit | Cause:
    """Return the frame of its origin, a point on +x and points in the xy plane, or why they do not determine it.

    y points to the side of the first point in the plane; more points determine the plane by least squares.

    Args:
        points: Poses at the points, in this order, in one frame; their orientations are ignored.
        least_m: Smallest distance of the point on x from the origin, and of the first point in the plane from the x
            axis.
        where: The place that a cause names.
    """
    if len(points) < LEAST_POINTS:
        message = f"{len(points)} points are given, at least {LEAST_POINTS} needed"
        compared = MeasuredValue(quantity="points", measured=len(points), unit="", least=LEAST_POINTS)
        return Cause(message=message, where=where, compared=(compared,))
    frames = sorted({point.frame for point in points})
    if len(frames) > 1:
        return Cause(message=f"the points are in different frames: {', '.join(frames)}", where=where)
    origin, on_x, *in_plane = (point.xyz for point in points)
    along = subtract(on_x, origin)
    length = math.hypot(*along)
    if not length >= least_m:
        return _too_near("the point on x", "the origin", length, least_m, where)
    x = scale(along, 1.0 / length)
    offsets = [subtract(point, origin) for point in in_plane]
    beside = [subtract(offset, scale(x, dot(offset, x))) for offset in offsets]
    distance = math.hypot(*beside[0])
    if not distance >= least_m:
        return _too_near("the point in the plane", "the x axis", distance, least_m, where)
    v = scale(beside[0], 1.0 / distance)
    w = cross(x, v)
    # The line through the x axis, in the plane across it, that is nearest to all points.
    pairs = [(dot(each, v), dot(each, w)) for each in beside]
    turn = 0.5 * math.atan2(sum(2.0 * a * b for a, b in pairs), sum(a * a - b * b for a, b in pairs))
    cosine, sine = math.cos(turn), math.sin(turn)
    y = add(scale(v, cosine), scale(w, sine))
    residual = max(abs(b * cosine - a * sine) for a, b in pairs)
    return FrameFit(Pose(xyz=origin, xyzw=_quaternion(x, y, cross(x, y)), frame=frames[0]), residual)


def _too_near(point: str, other: str, distance_m: float, least_m: float, where: str) -> Cause:
    distance, least = distance_m * 1e3, least_m * 1e3
    compared = MeasuredValue(quantity=f"distance of {point} from {other}", measured=distance, unit="mm", least=least)
    message = f"{point} is {distance:.2f} mm from {other}, at least {least:.2f} mm needed"
    return Cause(message=message, where=where, compared=(compared,))


def _quaternion(x: Vector3, y: Vector3, z: Vector3) -> Quaternion:
    """Return the orientation of three orthonormal axes; the largest component is computed first (Shepperd, 1978)."""
    trace = x[0] + y[1] + z[2]
    choices = (x[0], y[1], z[2], trace)
    largest = choices.index(max(choices))
    raw = (
        (1.0 + 2.0 * x[0] - trace, y[0] + x[1], z[0] + x[2], y[2] - z[1]),
        (y[0] + x[1], 1.0 + 2.0 * y[1] - trace, z[1] + y[2], z[0] - x[2]),
        (z[0] + x[2], z[1] + y[2], 1.0 + 2.0 * z[2] - trace, x[1] - y[0]),
        (y[2] - z[1], z[0] - x[2], x[1] - y[0], 1.0 + trace),
    )[largest]
    length = math.hypot(*raw)
    a, b, c, d = (value / length for value in raw)
    return (a, b, c, d)
