"""A cell of boxes and cylinders: a table with two trays and two arms that swing."""

from __future__ import annotations

import math

from engine.messages import FramePoses, Quaternion, SceneDescription, Vector3, VisualGeometry

_ARMS = {"left": (-0.55, 1.0), "right": (0.55, -1.0)}


def new_scene() -> SceneDescription:
    """Make a table with two trays and two arms of boxes and cylinders."""
    geometries = [
        _box("table", "world", (1.6, 1.2, 0.04), (0.0, 0.0, -0.02), (0.72, 0.69, 0.64, 1.0)),
        _box("tray_north", "world", (0.36, 0.22, 0.02), (0.0, 0.28, 0.01), (0.25, 0.44, 0.56, 1.0)),
        _box("tray_south", "world", (0.36, 0.22, 0.02), (0.0, -0.28, 0.01), (0.56, 0.42, 0.25, 1.0)),
    ]
    for name in _ARMS:
        geometries += [
            VisualGeometry(
                name=f"{name}_base",
                frame=f"{name}/base",
                kind="cylinder",
                size_m=(0.08, 0.2),
                xyz=(0.0, 0.0, 0.1),
                rgba=(0.85, 0.86, 0.88, 1.0),
            ),
            _box(f"{name}_upper", f"{name}/upper", (0.09, 0.09, 0.4), (0.0, 0.0, 0.2), (0.9, 0.91, 0.93, 1.0)),
            _box(f"{name}_fore", f"{name}/fore", (0.07, 0.07, 0.4), (0.0, 0.0, 0.2), (0.2, 0.22, 0.26, 1.0)),
        ]
    return SceneDescription(geometries=tuple(geometries))


def frames_at(time_s: float) -> FramePoses:
    """Pose both arms, swinging from side to side."""
    rows: list[tuple[str, Vector3, Quaternion]] = []
    for name, (x, sign) in _ARMS.items():
        yaw = 0.5 * math.sin(1.5 * time_s + sign)
        lean = sign * (0.5 + 0.2 * math.sin(2.0 * time_s))
        rows.append((f"{name}/base", (x, 0.0, 0.0), (0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))))
        upper = _turn(yaw, lean)
        rows.append((f"{name}/upper", (x, 0.0, 0.2), upper))
        elbow = (
            x + 0.4 * math.sin(lean) * math.cos(yaw),
            0.4 * math.sin(lean) * math.sin(yaw),
            0.2 + 0.4 * math.cos(lean),
        )
        rows.append((f"{name}/fore", elbow, _turn(yaw, lean + sign * 1.5)))
    return FramePoses(
        time_s=time_s,
        names=tuple(r[0] for r in rows),
        xyz=tuple(r[1] for r in rows),
        xyzw=tuple(r[2] for r in rows),
    )


def _turn(yaw: float, pitch: float) -> Quaternion:
    cy, sy, cp, sp = math.cos(yaw / 2), math.sin(yaw / 2), math.cos(pitch / 2), math.sin(pitch / 2)
    return (-sy * sp, cy * sp, sy * cp, cy * cp)


def _box(
    name: str, frame: str, size_m: Vector3, xyz: Vector3, rgba: tuple[float, float, float, float]
) -> VisualGeometry:
    return VisualGeometry(name=name, frame=frame, kind="box", size_m=size_m, xyz=xyz, rgba=rgba)
