"""Convex shapes and obstacles made of them, used on the bus and by planners.

Metres; the frame of a shape is at its centre.
"""

from __future__ import annotations

from engine.messages.geometry import Message, Pose, Vector3

AT_ORIGIN = Pose(xyz=(0.0, 0.0, 0.0))


class Box(Message, frozen=True, kw_only=True, tag_field="kind", tag="box"):
    """A box with full edge lengths."""

    size_m: Vector3


class Cylinder(Message, frozen=True, kw_only=True, tag_field="kind", tag="cylinder"):
    """A cylinder along z."""

    radius_m: float
    length_m: float


class Sphere(Message, frozen=True, kw_only=True, tag_field="kind", tag="sphere"):
    """A sphere."""

    radius_m: float


class Capsule(Message, frozen=True, kw_only=True, tag_field="kind", tag="capsule"):
    """A cylinder along z with a half sphere at either end; `length_m` is without them."""

    radius_m: float
    length_m: float


class Hull(Message, frozen=True, kw_only=True, tag_field="kind", tag="hull"):
    """The convex hull of at least four points that are not coplanar, such as the vertices of a mesh."""

    points_m: tuple[Vector3, ...]


Shape = Box | Cylinder | Sphere | Capsule | Hull


class Solid(Message, frozen=True, kw_only=True):
    """A shape with its pose in the frame of its owner."""

    shape: Shape
    pose: Pose = AT_ORIGIN


class Obstacle(Message, frozen=True, kw_only=True):
    """An obstacle of one or more solids at `pose` in the world."""

    name: str
    solids: tuple[Solid, ...]
    pose: Pose = AT_ORIGIN

    @classmethod
    def of(cls, name: str, shape: Shape, pose: Pose) -> Obstacle:
        """Return the obstacle of one shape at `pose` in the world."""
        return cls(name=name, solids=(Solid(shape=shape),), pose=pose)
