"""The drawn cell as a Foxglove scene: one entity a body, fixed to its frame."""

from __future__ import annotations

import struct

import msgspec

from engine.messages import SceneDescription, VisualGeometry
from engine.recording.foxglove_types import Color, Pose, Quaternion, Time, Vector3, time_of


class Cube(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.CubePrimitive`; also the shape of `foxglove.SpherePrimitive`, whose size is a diameter."""

    pose: Pose
    size: Vector3
    color: Color


class Cylinder(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.CylinderPrimitive`, along z."""

    pose: Pose
    size: Vector3
    bottom_scale: float = 1.0
    top_scale: float = 1.0
    color: Color


class Triangles(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.TriangleListPrimitive`."""

    pose: Pose
    points: tuple[Vector3, ...]
    color: Color
    indices: tuple[int, ...]


class SceneEntity(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.SceneEntity`: it stays, and moves with its frame."""

    timestamp: Time
    frame_id: str
    id: str
    lifetime: Time = Time(0, 0)
    frame_locked: bool = True
    cubes: tuple[Cube, ...] = ()
    spheres: tuple[Cube, ...] = ()
    cylinders: tuple[Cylinder, ...] = ()
    triangles: tuple[Triangles, ...] = ()


class SceneUpdate(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.SceneUpdate`."""

    entities: tuple[SceneEntity, ...]


def scene_update(scene: SceneDescription, at_ns: int) -> SceneUpdate:
    """Return what the 3D panel draws; bodies of a kind that it has no primitive for are left out."""
    stamp = time_of(at_ns)
    entities = (_entity(body, stamp) for body in scene.geometries)
    return SceneUpdate(entities=tuple(entity for entity in entities if entity is not None))


def _entity(body: VisualGeometry, stamp: Time) -> SceneEntity | None:
    pose = Pose(position=Vector3(*body.xyz), orientation=Quaternion(*body.xyzw))
    color = Color(*body.rgba)
    match body.kind, body.size_m:
        case "box", (x, y, z):
            cubes = (Cube(pose=pose, size=Vector3(x, y, z), color=color),)
            return SceneEntity(timestamp=stamp, frame_id=body.frame, id=body.name, cubes=cubes)
        case "sphere", (radius, *_):
            spheres = (Cube(pose=pose, size=Vector3(2 * radius, 2 * radius, 2 * radius), color=color),)
            return SceneEntity(timestamp=stamp, frame_id=body.frame, id=body.name, spheres=spheres)
        case "cylinder", (radius, length, *_):
            cylinders = (Cylinder(pose=pose, size=Vector3(2 * radius, 2 * radius, length), color=color),)
            return SceneEntity(timestamp=stamp, frame_id=body.frame, id=body.name, cylinders=cylinders)
        case "mesh", _:
            points = tuple(Vector3(*each) for each in struct.iter_unpack("<3f", body.vertices))
            indices = tuple(each for (each,) in struct.iter_unpack("<I", body.faces))
            triangles = (Triangles(pose=pose, points=points, color=color, indices=indices),)
            return SceneEntity(timestamp=stamp, frame_id=body.frame, id=body.name, triangles=triangles)
        case _:
            return None
