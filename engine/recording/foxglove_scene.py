"""The geometry of the cell as a Foxglove scene: one entity per body, fixed to its frame."""

from __future__ import annotations

import struct

import msgspec

from engine.messages import SceneDescription, VisualGeometry
from engine.recording.foxglove_types import (
    FoxgloveColor,
    FoxglovePose,
    FoxgloveQuaternion,
    FoxgloveTime,
    FoxgloveVector3,
    time_of,
)


class FoxgloveCube(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.CubePrimitive`; also the shape of `foxglove.SpherePrimitive`, whose size is a diameter."""

    pose: FoxglovePose
    size: FoxgloveVector3
    color: FoxgloveColor


class FoxgloveCylinder(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.CylinderPrimitive`, along z."""

    pose: FoxglovePose
    size: FoxgloveVector3
    bottom_scale: float = 1.0
    top_scale: float = 1.0
    color: FoxgloveColor


class FoxgloveTriangles(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.TriangleListPrimitive`."""

    pose: FoxglovePose
    points: tuple[FoxgloveVector3, ...]
    color: FoxgloveColor
    indices: tuple[int, ...]


class FoxgloveSceneEntity(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.FoxgloveSceneEntity`: it stays, and moves with its frame."""

    timestamp: FoxgloveTime
    frame_id: str
    id: str
    lifetime: FoxgloveTime = FoxgloveTime(0, 0)
    frame_locked: bool = True
    cubes: tuple[FoxgloveCube, ...] = ()
    spheres: tuple[FoxgloveCube, ...] = ()
    cylinders: tuple[FoxgloveCylinder, ...] = ()
    triangles: tuple[FoxgloveTriangles, ...] = ()


class FoxgloveSceneEntityDeletion(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.SceneEntityDeletion`; `type` 1 deletes all entities before the timestamp."""

    timestamp: FoxgloveTime
    type: int = 1
    id: str = ""


class FoxgloveSceneUpdate(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.FoxgloveSceneUpdate`."""

    deletions: tuple[FoxgloveSceneEntityDeletion, ...]
    entities: tuple[FoxgloveSceneEntity, ...]


def scene_update(scene: SceneDescription, at_ns: int) -> FoxgloveSceneUpdate:
    """Return the scene of the 3D panel, without bodies for which Foxglove has no primitive; it replaces all before."""
    stamp = time_of(at_ns)
    entities = (_entity(body, stamp) for body in scene.geometries)
    return FoxgloveSceneUpdate(
        deletions=(FoxgloveSceneEntityDeletion(timestamp=stamp),),
        entities=tuple(entity for entity in entities if entity is not None),
    )


def _entity(body: VisualGeometry, stamp: FoxgloveTime) -> FoxgloveSceneEntity | None:
    pose = FoxglovePose(position=FoxgloveVector3(*body.xyz), orientation=FoxgloveQuaternion(*body.xyzw))
    color = FoxgloveColor(*body.rgba)
    match body.kind, body.size_m:
        case "box", (x, y, z):
            cubes = (FoxgloveCube(pose=pose, size=FoxgloveVector3(x, y, z), color=color),)
            return FoxgloveSceneEntity(timestamp=stamp, frame_id=body.frame, id=body.name, cubes=cubes)
        case "sphere", (radius, *_):
            spheres = (FoxgloveCube(pose=pose, size=FoxgloveVector3(2 * radius, 2 * radius, 2 * radius), color=color),)
            return FoxgloveSceneEntity(timestamp=stamp, frame_id=body.frame, id=body.name, spheres=spheres)
        case "cylinder", (radius, length, *_):
            cylinders = (
                FoxgloveCylinder(pose=pose, size=FoxgloveVector3(2 * radius, 2 * radius, length), color=color),
            )
            return FoxgloveSceneEntity(timestamp=stamp, frame_id=body.frame, id=body.name, cylinders=cylinders)
        case "mesh", _:
            points = tuple(FoxgloveVector3(*each) for each in struct.iter_unpack("<3f", body.vertices))
            indices = tuple(each for (each,) in struct.iter_unpack("<I", body.faces))
            triangles = (FoxgloveTriangles(pose=pose, points=points, color=color, indices=indices),)
            return FoxgloveSceneEntity(timestamp=stamp, frame_id=body.frame, id=body.name, triangles=triangles)
        case _:
            return None
