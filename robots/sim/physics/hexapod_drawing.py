"""The legs of hexapods as they look: a tube at the base and a rod at the platform, which slide in each other.

Legs are no bodies of the world. Their frames, such as `jig/platform~tube_1`, follow from the poses of both plates.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from engine.messages import DRAWN_ONLY, Pose, VisualGeometry
from robots.model.transform import RigidTransform, cross
from robots.port import Array
from robots.scene.sim_scene import FixtureBody, SimScene

_TUBE, _ROD = "tube", "rod"
_RADII_M = {_TUBE: 0.009, _ROD: 0.005}
_COLORS = {_TUBE: (0.30, 0.33, 0.37, 1.0), _ROD: (0.85, 0.85, 0.87, 1.0)}
_UP = np.array([0.0, 0.0, 1.0])


def leg_geometries(scene: SimScene) -> Iterator[VisualGeometry]:
    """Yield both halves of each leg; a half is as long as the shortest leg permits."""
    for platform in _platforms(scene):
        assert platform.hexapod is not None
        shortest, longest = platform.hexapod.length_m
        length = min(0.95 * shortest, 0.55 * longest)
        for number in range(1, len(platform.hexapod.feet) + 1):
            for half in (_TUBE, _ROD):
                name = _frame(platform.name, half, number)
                yield VisualGeometry(
                    name=name,
                    frame=name,
                    kind="cylinder",
                    size_m=(_RADII_M[half], length),
                    rgba=_COLORS[half],
                    xyz=(0.0, 0.0, length / 2.0),
                    xyzw=(0.0, 0.0, 0.0, 1.0),
                )


def leg_frames(scene: SimScene, platforms: Mapping[str, Pose]) -> dict[str, Pose]:
    """Return the poses of both halves of all legs, whose z axis is along the leg; given those of the platforms."""
    found: dict[str, Pose] = {}
    fixtures = {fixture.name: fixture for fixture in scene.fixtures}
    for platform in _platforms(scene):
        legs = platform.hexapod
        assert legs is not None
        base = RigidTransform.from_pose(fixtures[legs.base].pose)
        top = RigidTransform.from_pose(platforms[platform.name])
        for number, (foot, joint) in enumerate(zip(legs.feet, legs.joints, strict=True), start=1):
            low, high = _point(base, foot), _point(top, joint)
            found[_frame(platform.name, _TUBE, number)] = _along(low, high)
            found[_frame(platform.name, _ROD, number)] = _along(high, low)
    return found


def _platforms(scene: SimScene) -> Iterator[FixtureBody]:
    return (fixture for fixture in scene.fixtures if fixture.hexapod is not None)


def _frame(platform: str, half: str, number: int) -> str:
    return f"{platform}{DRAWN_ONLY}{half}_{number}"


def _point(frame: RigidTransform, xyz: tuple[float, float, float]) -> Array:
    return frame.xyz + frame.rotation @ np.array(xyz)


def _along(start: Array, end: Array) -> Pose:
    """Return the pose at a point with its z axis towards another one."""
    direction = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
    x, y, z = cross(_UP, direction)
    w = 1.0 + float(_UP @ direction)
    # Straight down any axis in the plane is one to turn about.
    turn = np.array([x, y, z, w]) if w > 1e-9 else np.array([1.0, 0.0, 0.0, 0.0])
    turn /= np.linalg.norm(turn)
    return RigidTransform(xyz=start, xyzw=turn).to_pose("world")
