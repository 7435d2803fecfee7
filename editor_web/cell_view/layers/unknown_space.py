"""The unknown voxels of `cell/observed_space`, which no camera has seen lately, as small squares on their surface."""

from __future__ import annotations

import logging
import math

import numpy as np
from numpy.typing import NDArray

from editor_web.cell_view.layers.occupancy import surface
from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from editor_web.cell_view.rendering.voxel_squares import VoxelSquares
from engine.messages.sensing import ObservedSpace

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
    return (ages > space.greatest_known_age).reshape(space.shape)


class UnknownSpaceLayer:
    """Draws the unknown voxels on changes, at most twice a second."""

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._squares = VoxelSquares(server, f"{root_of('voxels', under=under)}/unknown", share=_POINT_SHARE)
        self._drawn: ObservedSpace | None = None
        self._shown: NDArray[np.bool_] | None = None
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
            surfaces = np.argwhere(surface(places))
            shades = np.tile(np.array(_COLOUR, dtype=np.uint8), (len(surfaces), 1))
            self._squares.show(surfaces, shades, voxel_m=space.voxel_m, corner_m=space.corner_m)
        return None
