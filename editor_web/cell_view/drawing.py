"""Everything that is drawn, each kind by itself: for everybody as it is now, or for one page as it was."""

from __future__ import annotations

import time

from editor_web.cell_view.bodies import Bodies
from editor_web.cell_view.cameras import Cameras
from editor_web.cell_view.canvas import Canvas
from editor_web.cell_view.detections import DetectionBoxes
from editor_web.cell_view.groups import Group
from editor_web.cell_view.newest import Newest
from editor_web.cell_view.obstacles import Obstacles
from editor_web.cell_view.occupancy import Voxels
from editor_web.cell_view.ways import Ways


class Drawing:
    """All kinds of things on one canvas, below the node `under`."""

    def __init__(self, canvas: Canvas, *, under: str = "") -> None:
        self._bodies = Bodies(canvas, under=under)
        self._ways = Ways(canvas, under=under)
        self._obstacles = Obstacles(canvas, under=under)
        self._voxels = Voxels(canvas, under=under)
        self._cameras = Cameras(canvas, under=under)
        self._detections = DetectionBoxes(canvas, under=under)

    def all(self, newest: Newest, shown: frozenset[Group]) -> float | None:
        """Draw what has changed; returns when, on the steady clock, to draw again without a new message."""
        now_s = time.monotonic()
        self._bodies.draw(newest)
        self._obstacles.draw(newest)
        self._detections.draw(newest)
        due = (
            self._ways.draw(newest, now_s, is_shown="ways" in shown),
            self._voxels.draw(newest, now_s),
            self._cameras.draw(newest, now_s),
        )
        return min((each for each in due if each is not None), default=None)
