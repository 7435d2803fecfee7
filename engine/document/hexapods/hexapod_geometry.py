"""The geometry of a hexapod: the lengths of its legs at a pose of the platform, and what is beyond their limits."""

from __future__ import annotations

import math
from collections.abc import Iterator

from engine.document.hexapods.hexapod_spec import HexapodSpec
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import compose_poses, interpolate_poses, invert_pose, rotate_vector

PATH_STEPS = 50
"""A straight path is looked at in so many steps."""


def legs_at(hexapod: HexapodSpec, pose: Pose) -> tuple[Vector3, ...]:
    """Return each leg as the vector from its joint on the base to that on the platform, in the frame of the base.

    `pose` is that of the platform in the frame of the base.
    """
    legs: list[Vector3] = []
    for foot, joint in zip(hexapod.joints_of_base(), hexapod.joints_of_platform(), strict=True):
        x, y, z = rotate_vector(pose.xyzw, joint)
        legs.append((pose.xyz[0] + x - foot[0], pose.xyz[1] + y - foot[1], pose.xyz[2] + z - foot[2]))
    return tuple(legs)


def leg_lengths_m(hexapod: HexapodSpec, pose: Pose) -> tuple[float, ...]:
    """Return the lengths of the six legs at a pose of the platform in the frame of the base."""
    return tuple(math.hypot(*leg) for leg in legs_at(hexapod, pose))


def beyond_limits(hexapod: HexapodSpec, pose: Pose) -> str:
    """Return which legs are beyond which limits at a pose in the frame of the base, and by how much; empty for none."""
    return "; ".join(_beyond(hexapod, pose))


def path_beyond_limits(hexapod: HexapodSpec, start: Pose, end: Pose, *, tool: Pose) -> str:
    """Return what is beyond limits first while a tool moves on a straight line with SLERP; empty for nothing.

    Args:
        hexapod: The hexapod.
        start: The pose of the platform in the frame of the base at the start.
        end: Its pose at the end.
        tool: The pose of the tool in the frame of the platform, which it holds.
    """
    first, last = compose_poses(start, tool), compose_poses(end, tool)
    back = invert_pose(tool)
    for step in range(1, PATH_STEPS + 1):
        share = step / PATH_STEPS
        found = beyond_limits(hexapod, compose_poses(interpolate_poses(first, last, share), back))
        if found:
            return found if step == PATH_STEPS else f"after {100 * share:.0f} % of the line: {found}"
    return ""


def _beyond(hexapod: HexapodSpec, pose: Pose) -> Iterator[str]:
    shortest, longest = hexapod.length_m
    normal = rotate_vector(pose.xyzw, (0.0, 0.0, 1.0))
    for number, leg in enumerate(legs_at(hexapod, pose), start=1):
        length = math.hypot(*leg)
        if length > longest:
            yield f"leg {number} would be {1e3 * (length - longest):.1f} mm longer than its {1e3 * longest:.1f} mm"
        if length < shortest:
            yield f"leg {number} would be {1e3 * (shortest - length):.1f} mm shorter than its {1e3 * shortest:.1f} mm"
        if length < 1e-9:
            continue
        for plate, axis in (("base", (0.0, 0.0, 1.0)), ("platform", normal)):
            cosine = sum(a * b for a, b in zip(leg, axis, strict=True)) / length
            lean = math.acos(max(-1.0, min(1.0, cosine)))
            if lean > hexapod.lean_rad:
                over, most = math.degrees(lean - hexapod.lean_rad), math.degrees(hexapod.lean_rad)
                yield f"leg {number} would lean {over:.1f}° more than {most:.1f}° at the {plate}"
