"""The unknown voxels of `cell/observed_space`, which no camera has seen lately, as small squares on their surface."""

from __future__ import annotations

import logging
import math

import numpy as np
import viser
from numpy.typing import NDArray

from editor_web.cell_view.layers.occupancy import surface
from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from engine.messages.sensing import LONG_UNSEEN, ObservedSpace

_log = logging.getLogger("flexcell.cell_view")
PERIOD_S = 0.5
# Much smaller than an occupied voxel: one looks through them.
_POINT_SHARE = 0.12
_COLOUR = (150, 90, 160)


def unknown(space: ObservedSpace) -> NDArray[np.bool_]:
    """Return whether each voxel is unknown, in the shape of the map.

    Raises:
        ValueError: the number of ages does not match the shape.
    """
    ages = np.frombuffer(space.ages, dtype=np.uint8)
    if min(space.shape) < 0 or len(ages) != math.prod(space.shape):
        raise ValueError(f"{len(ages)} bytes do not match a map of {space.shape} voxels")
    return (ages > min(round(10.0 * space.limit_s), LONG_UNSEEN - 1)).reshape(space.shape)


class UnknownSpaceLayer:
    """Draws the unknown voxels on changes, at most twice a second."""

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._server = server
        self._node = f"{root_of('voxels', under=under)}/unknown"
        self._drawn: ObservedSpace | None = None
        self._shown: NDArray[np.bool_] | None = None
        self._handle: viser.PointCloudHandle | None = None
        self._next_s = 0.0

    def draw(self, latest: LatestMessages, now_s: float) -> float | None:
        """Draw the changes; return the time of the next call if it is too early now."""
        space = latest.observed_space
        if space is None or space is self._drawn:
            return None
        if now_s < self._next_s:
            return self._next_s
        self._drawn, self._next_s = space, now_s + PERIOD_S
        try:
            places = unknown(space)
        except ValueError as error:
            _log.warning("the unknown space is not drawn: %s", error)
            return None
        if self._shown is None or not np.array_equal(places, self._shown):
            self._shown = places
            self._show(space, np.argwhere(surface(places)))
        return None

    def _show(self, space: ObservedSpace, places: NDArray[np.int64]) -> None:
        points = (places.astype(np.float32) + 0.5) * np.float32(space.voxel_m)
        shades = np.tile(np.array(_COLOUR, dtype=np.uint8), (len(points), 1))
        with self._server.atomic():
            if self._handle is None:
                self._handle = self._server.scene.add_point_cloud(
                    self._node, points=points, colors=shades, point_shape="square", precision="float16"
                )
            else:
                self._handle.points = points
                self._handle.colors = shades
            self._handle.point_size = space.voxel_m * _POINT_SHARE
            self._handle.position = space.corner_m
            self._handle.visible = len(points) > 0
