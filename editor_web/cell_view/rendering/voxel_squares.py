"""Voxels of a map as squares of one point cloud."""

from __future__ import annotations

import numpy as np
import viser
from numpy.typing import NDArray

from editor_web.cell_view.rendering.canvas import Canvas
from engine.messages import Vector3


class VoxelSquares:
    """One square at the centre of each voxel, of a share of its edge; viser's size is half an edge."""

    def __init__(self, server: Canvas, node: str, *, share: float) -> None:
        self._server = server
        self._node = node
        self._share = share
        self._handle: viser.PointCloudHandle | None = None

    def show(self, places: NDArray[np.int64], shades: NDArray[np.uint8], *, voxel_m: float, corner_m: Vector3) -> None:
        """Draw these voxels, indices (n, 3), in their colours (n, 3), instead of the former ones."""
        points = (places.astype(np.float32) + 0.5) * np.float32(voxel_m)
        with self._server.atomic():
            if self._handle is None:
                # Squares, not cubes: with software rendering, a browser draws six times as many.
                self._handle = self._server.scene.add_point_cloud(
                    self._node, points=points, colors=shades, point_shape="square", precision="float16"
                )
            else:
                self._handle.points = points
                self._handle.colors = shades
            self._handle.point_size = voxel_m * self._share
            self._handle.position = corner_m
            self._handle.visible = len(points) > 0
