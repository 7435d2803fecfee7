"""All layers of the 3D view: the live scene for all pages, or a past scene for one page."""

from __future__ import annotations

import time

from editor_web.cell_view.layers.bodies import BodyLayer
from editor_web.cell_view.layers.cameras import CameraLayer
from editor_web.cell_view.layers.commanded import CommandedLayer
from editor_web.cell_view.layers.detections import DetectionLayer
from editor_web.cell_view.layers.obstacles import ObstacleLayer
from editor_web.cell_view.layers.occupancy import VoxelLayer
from editor_web.cell_view.layers.path_view import PathLayer
from editor_web.cell_view.layers.unknown_space import UnknownSpaceLayer
from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import LayerGroup


class SceneLayers:
    """All layers on one canvas, below the node `under`."""

    def __init__(self, canvas: Canvas, *, under: str = "") -> None:
        self._bodies = BodyLayer(canvas, under=under)
        self._paths = PathLayer(canvas, under=under)
        self._commanded = CommandedLayer(canvas, under=under)
        self._obstacles = ObstacleLayer(canvas, under=under)
        self._voxels = VoxelLayer(canvas, under=under)
        self._unknown = UnknownSpaceLayer(canvas, under=under)
        self._cameras = CameraLayer(canvas, under=under)
        self._detections = DetectionLayer(canvas, under=under)

    def all(self, latest: LatestMessages, shown: frozenset[LayerGroup]) -> float | None:
        """Draw the changes; return the monotonic time at which to draw again without a new message."""
        now_s = time.monotonic()
        self._bodies.draw(latest)
        self._obstacles.draw(latest)
        self._detections.draw(latest)
        self._commanded.draw(latest, is_shown="commanded" in shown)
        due = (
            self._paths.draw(latest, now_s, is_shown="paths" in shown),
            self._voxels.draw(latest, now_s),
            self._unknown.draw(latest, now_s),
            self._cameras.draw(latest, now_s),
        )
        return min((each for each in due if each is not None), default=None)
