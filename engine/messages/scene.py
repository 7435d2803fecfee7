"""The visual scene of a cell."""

from __future__ import annotations

from engine.messages.geometry import Message, Quaternion, Vector3


class VisualGeometry(Message, frozen=True, kw_only=True):
    """One drawable body of the cell, fixed to `frame`.

    `kind` is box (full edge lengths), cylinder (radius, length), sphere (radius) or mesh;
    a mesh has float32 vertices (n x 3, metres) and uint32 faces (m x 3), both row-major bytes.
    """

    name: str
    frame: str
    kind: str
    size_m: tuple[float, ...] = ()
    vertices: bytes = b""
    faces: bytes = b""
    rgba: tuple[float, float, float, float] = (0.7, 0.7, 0.7, 1.0)
    xyz: Vector3 = (0.0, 0.0, 0.0)
    xyzw: Quaternion = (0.0, 0.0, 0.0, 1.0)


class SceneDescription(Message, frozen=True, kw_only=True):
    """All visual geometries of the cell, published once as the latest value of `cell/scene`."""

    geometries: tuple[VisualGeometry, ...]
