"""Marks of a page: the points, the box or the axes of a value that is being taught."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec
import numpy as np
import viser

from editor_web.cell_view.rendering.canvas import TAUGHT, Canvas
from editor_web.cell_view.rendering.geometry import Rgb
from engine.messages import Quaternion, Vector3

_COLOUR: Rgb = (37, 99, 235)
_WARNING: Rgb = (220, 38, 38)
_OPACITY = 0.25
_POINT_M = 0.008
_AXES_M = 0.1
_AXES_RADIUS_M = 0.003


_MOST_POINTS = 2500
_Length = Annotated[float, msgspec.Meta(gt=0.0, le=1000.0)]


class MarkedBody(msgspec.Struct, frozen=True, kw_only=True):
    """A body where it will be: `size_m` are edges x, y, z of a box, diameter and length of a cylinder, a diameter.

    `pose` is that of its centre in the world. With `warns` it is red.
    """

    shape: Literal["box", "cylinder", "sphere"]
    size_m: Annotated[tuple[_Length, ...], msgspec.Meta(min_length=1, max_length=3)]
    pose: tuple[Vector3, Quaternion]
    warns: bool = False


class Marks(msgspec.Struct, frozen=True, kw_only=True):
    """What a page sees marked: points, a box by its least and greatest coordinates, the axes of a pose, a body.

    Positions are in metres, the orientation is a quaternion x y z w.
    """

    points: Annotated[tuple[Vector3, ...], msgspec.Meta(max_length=_MOST_POINTS)] = ()
    box: tuple[Vector3, Vector3] | None = None
    axes: tuple[Vector3, Quaternion] | None = None
    body: MarkedBody | None = None

    @property
    def is_empty(self) -> bool:
        """Whether nothing is marked."""
        return not self.points and self.box is None and self.axes is None and self.body is None


NO_MARKS = Marks()


class MarkLayer:
    """Draws the marks of one page, even if planned paths are hidden."""

    def __init__(self, server: Canvas) -> None:
        self._server = server
        self._drawn = NO_MARKS
        self._handles: list[viser.SceneNodeHandle] = []

    def draw(self, marks: Marks) -> None:
        """Draw the marks in the place of those before."""
        if marks == self._drawn:
            return
        self._drawn = marks
        with self._server.atomic():
            for handle in self._handles:
                handle.remove()
            self._handles = self._added(marks)

    def _added(self, marks: Marks) -> list[viser.SceneNodeHandle]:
        scene = self._server.scene
        added: list[viser.SceneNodeHandle] = [
            scene.add_icosphere(f"{TAUGHT}/marks/{at}", radius=_POINT_M, color=_COLOUR, position=xyz)
            for at, xyz in enumerate(marks.points)
        ]
        if marks.box is not None:
            low, high = (np.asarray(corner) for corner in marks.box)
            x, y, z = (high - low).tolist()
            added.append(
                scene.add_box(
                    f"{TAUGHT}/marks/box",
                    dimensions=(x, y, z),
                    position=(low + high) / 2,
                    color=_COLOUR,
                    opacity=_OPACITY,
                )
            )
        if marks.axes is not None:
            xyz, (x, y, z, w) = marks.axes
            added.append(
                scene.add_frame(
                    f"{TAUGHT}/marks/axes",
                    axes_length=_AXES_M,
                    axes_radius=_AXES_RADIUS_M,
                    position=xyz,
                    wxyz=(w, x, y, z),
                )
            )
        if marks.body is not None:
            added.append(self._solid(marks.body))
        return added

    def _solid(self, body: MarkedBody) -> viser.SceneNodeHandle:
        scene, name = self._server.scene, f"{TAUGHT}/marks/body"
        colour = _WARNING if body.warns else _COLOUR
        first_m, last_m = body.size_m[0], body.size_m[-1]
        xyz, (x, y, z, w) = body.pose
        wxyz = (w, x, y, z)
        match body.shape:
            case "sphere":
                return scene.add_icosphere(name, radius=first_m / 2.0, color=colour, opacity=_OPACITY, position=xyz)
            case "cylinder":
                return scene.add_cylinder(
                    name, first_m / 2.0, last_m, color=colour, opacity=_OPACITY, position=xyz, wxyz=wxyz
                )
            case "box":
                edges = (first_m, body.size_m[len(body.size_m) // 2], last_m)
                return scene.add_box(name, dimensions=edges, color=colour, opacity=_OPACITY, position=xyz, wxyz=wxyz)
