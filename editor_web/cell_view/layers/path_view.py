"""The planned path of each arm: the tool's path as a line, and a ghost of the arm that moves along it."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping

import numpy as np
import viser
from numpy.typing import NDArray

from editor_web.cell_view.layers.arm_ghost import ArmGhost
from editor_web.cell_view.rendering.canvas import TAUGHT, Canvas
from editor_web.cell_view.rendering.geometry import Rgb
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from engine.errors import FlexcellError
from engine.messages import RobotDescription, SceneDescription
from engine.skills.planning import PathPreview

_log = logging.getLogger("flexcell.cell_view")
_COLOURS: Mapping[str, Rgb] = {"proposed": (37, 99, 235), "moving": (22, 163, 74), "blocked": (220, 70, 38)}
# The same colours as the page's curves for the places of a comparison.
_PLACE_COLOURS: tuple[Rgb, ...] = ((37, 99, 235), (220, 70, 38), (22, 163, 74), (217, 119, 6), (107, 114, 128))
_LINE_PX = 4.0
_GOAL_M = 0.012
TRAVEL_S = 4.0
REST_S = 1.2
PERIOD_S = 1.0 / 15.0
GhostPreviews = Mapping[tuple[str, int], PathPreview]
"""Previews by the name of the arm and the place in a comparison."""


class PathLayer:
    """Draws the previews of all arms that plan."""

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._server = server
        self._root = root_of("paths", under=under)
        self._arms: dict[str, _ArmPathDrawing] = {}

    def draw(self, latest: LatestMessages, now_s: float, *, is_shown: bool) -> float | None:
        """Draw the changes; return the time of the next call if a ghost moves and is shown."""
        due: list[float] = []
        for name, preview in latest.paths.items():
            if name not in self._arms:
                self._arms[name] = _ArmPathDrawing(self._server, name, node=f"{self._root}/{name}", colours=_COLOURS)
            drawing = self._arms[name]
            drawing.draw(preview, latest, now_s)
            if is_shown and (next_s := drawing.animate(now_s)) is not None:
                due.append(next_s)
        return min(due, default=None)


class GhostLayer:
    """Draws the previews of a page, each place in its colour, even if planned paths are hidden."""

    def __init__(self, server: Canvas) -> None:
        self._server = server
        self._arms: dict[tuple[str, int], _ArmPathDrawing] = {}

    def draw(self, shown: GhostPreviews, latest: LatestMessages, now_s: float) -> float | None:
        """Draw the changes; return the time of the next call if a ghost moves."""
        due: list[float] = []
        for key, preview in shown.items():
            if key not in self._arms:
                name, place = key
                colours = {"proposed": _PLACE_COLOURS[place % len(_PLACE_COLOURS)]}
                self._arms[key] = _ArmPathDrawing(self._server, name, node=f"{TAUGHT}/{name}.{place}", colours=colours)
            self._arms[key].draw(preview, latest, now_s)
            if (next_s := self._arms[key].animate(now_s)) is not None:
                due.append(next_s)
        return min(due, default=None)


class _ArmPathDrawing:
    def __init__(self, server: Canvas, name: str, *, node: str, colours: Mapping[str, Rgb]) -> None:
        self._colours = colours
        self._server = server
        self._node = node
        self._name = name
        self._arm: tuple[SceneDescription | None, RobotDescription | None] | None = None
        self._preview: PathPreview | None = None
        self._started_s = 0.0
        self._next_s = 0.0
        self._line: tuple[viser.LineSegmentsHandle, viser.IcosphereHandle] | None = None
        self._ghost: ArmGhost | None = None

    def draw(self, preview: PathPreview, latest: LatestMessages, now_s: float) -> None:
        scene, description = latest.scene, latest.descriptions.get(self._name)
        is_another_arm = self._arm is None or self._arm[0] is not scene or self._arm[1] is not description
        if preview is self._preview and not is_another_arm:
            return
        is_another_path = self._preview is None or self._preview.joints != preview.joints
        self._preview, self._arm = preview, (scene, description)
        with self._server.atomic():
            self._draw_line(preview)
            if is_another_arm:
                self._drop_ghost()
            self._draw_ghost(preview, latest)
        if is_another_path:
            self._started_s = now_s
        self._next_s = now_s

    def animate(self, now_s: float) -> float | None:
        """Animate the ghost along a proposed path in a loop; return the time of the next call."""
        preview, ghost = self._preview, self._ghost
        if preview is None or ghost is None or preview.state != "proposed" or len(preview.joints) < 2:
            return None
        if now_s >= self._next_s:
            self._next_s = now_s + PERIOD_S
            share = ((now_s - self._started_s) % (TRAVEL_S + REST_S)) / TRAVEL_S
            with self._server.atomic():
                ghost.place(preview.joint_names, interpolate_joints(preview.joints, min(share, 1.0)))
        return self._next_s

    def _draw_line(self, preview: PathPreview) -> None:
        if self._line is not None:
            for handle in self._line:
                handle.remove()
            self._line = None
        colour = self._colours.get(preview.state)
        points = np.asarray(preview.tool_path, dtype=np.float32).reshape(-1, 3)
        if colour is None or len(points) < 2 or not np.isfinite(points).all():
            return
        x_m, y_m, z_m = (float(value) for value in points[-1])
        self._line = (
            self._server.scene.add_line_segments(
                f"{self._node}/line",
                points=np.stack([points[:-1], points[1:]], axis=1),
                colors=colour,
                thickness=_LINE_PX,
                thickness_units="screen",
            ),
            self._server.scene.add_icosphere(
                f"{self._node}/goal", radius=_GOAL_M, color=colour, position=(x_m, y_m, z_m), cast_shadow=False
            ),
        )

    def _draw_ghost(self, preview: PathPreview, latest: LatestMessages) -> None:
        colour = self._colours.get(preview.state)
        if colour is None or not preview.joints:
            if self._ghost is not None:
                self._ghost.root.visible = False
            return
        if self._ghost is None:
            self._ghost = self._new_ghost(latest)
        if self._ghost is not None:
            self._ghost.update_tool(latest)
            self._ghost.place(preview.joint_names, preview.joints[-1])
            self._ghost.paint(colour)
            self._ghost.root.visible = True

    def _new_ghost(self, latest: LatestMessages) -> ArmGhost | None:
        description = latest.descriptions.get(self._name)
        if latest.scene is None or description is None:
            return None
        try:
            return ArmGhost(self._server, f"{self._node}/ghost", latest.scene, description)
        except (FlexcellError, ValueError) as error:
            # The line alone still shows the path.
            _log.warning("the ghost of %s is not drawn: %s", self._name, error)
            return None

    def _drop_ghost(self) -> None:
        if self._ghost is not None:
            self._ghost.root.remove()
            self._ghost = None


def interpolate_joints(joints: tuple[tuple[float, ...], ...], share: float) -> tuple[float, ...]:
    """Return the configuration at a fraction, 0 to 1, of the path `joints`, measured by the joint that moves most.

    A path without motion gives its last configuration.
    """
    rows = np.asarray(joints, dtype=np.float64)
    distance = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(rows, axis=0)).max(axis=1))])
    if distance[-1] == 0.0 or not math.isfinite(distance[-1]):
        return joints[-1]
    at = share * float(distance[-1])
    columns: list[NDArray[np.float64]] = list(rows.T)
    return tuple(float(np.interp(at, distance, values)) for values in columns)
