"""The drawn cell in Foxglove: each body as the primitive that it is, in its frame."""

from __future__ import annotations

import struct
from typing import Any

from engine.messages import SceneDescription, VisualGeometry
from engine.recording.foxglove_scene import scene_update
from engine.recording.foxglove_types import FoxgloveColor, FoxgloveTime, FoxgloveVector3

WHITE = (1.0, 1.0, 1.0, 1.0)


def _body(kind: str, size_m: tuple[float, ...] = (), **more: Any) -> VisualGeometry:
    return VisualGeometry(name=kind, frame="f", kind=kind, size_m=size_m, rgba=WHITE, xyz=(1.0, 0.0, 0.0), **more)


def test_every_kind_of_body_has_its_primitive() -> None:
    vertices = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    bodies = (
        _body("box", (1.0, 2.0, 3.0)),
        _body("sphere", (0.5,)),
        _body("cylinder", (0.5, 2.0)),
        _body("mesh", vertices=vertices, faces=struct.pack("<3I", 0, 1, 2)),
    )
    box, sphere, cylinder, mesh = scene_update(SceneDescription(geometries=bodies), 1_500_000_000).entities
    assert (box.timestamp, box.frame_id, box.frame_locked, box.cubes[0].size) == (
        FoxgloveTime(1, 500_000_000), "f", True, FoxgloveVector3(1.0, 2.0, 3.0),
    )  # fmt: skip
    assert box.cubes[0].pose.position == FoxgloveVector3(1.0, 0.0, 0.0)
    assert sphere.spheres[0].size == FoxgloveVector3(1.0, 1.0, 1.0)
    assert cylinder.cylinders[0].size == FoxgloveVector3(1.0, 1.0, 2.0)
    assert mesh.triangles[0].points == (FoxgloveVector3(0, 0, 0), FoxgloveVector3(1, 0, 0), FoxgloveVector3(0, 1, 0))
    assert (mesh.triangles[0].indices, mesh.triangles[0].color) == ((0, 1, 2), FoxgloveColor(*WHITE))


def test_a_body_of_an_unknown_kind_is_left_out() -> None:
    assert scene_update(SceneDescription(geometries=(_body("blob"),)), 0).entities == ()


def test_a_scene_replaces_the_one_before_so_that_an_unplugged_module_vanishes() -> None:
    (deletion,) = scene_update(SceneDescription(geometries=()), 1_500_000_000).deletions
    assert (deletion.type, deletion.timestamp) == (1, FoxgloveTime(1, 500_000_000))
