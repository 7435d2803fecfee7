"""Depth cameras in the 3D view: a frustum at each camera pose, with its latest image coloured by distance.

Detections are framed and labelled in the image.
"""

from __future__ import annotations

import logging
import math

import numpy as np
import viser
from numpy.typing import NDArray

from editor_web.cell_view.layers.detections import is_fresh
from editor_web.cell_view.layers.labelled_image import draw_labels
from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.colours import ramp
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from editor_web.cell_view.rendering.transforms import wxyz
from engine.messages.sensing import CameraInfo, CameraIntrinsics, DepthImage
from engine.skills.vision import Detections

_log = logging.getLogger("flexcell.cell_view")
PERIOD_S = 0.2
_WIDTH_PX = 240
_FRUSTUM_M = 0.1
_FRAME = (71, 85, 105)
_FRAME_PX = 1.5
_NEAR_TO_FAR = ((122, 4, 3), (239, 90, 17), (238, 207, 58), (110, 222, 110), (40, 146, 236), (48, 18, 59))
_UNMEASURED = (40, 40, 40)


def depth_picture(image: DepthImage) -> NDArray[np.uint8]:
    """Return the image in colours (rows x columns x 3), warm for near and cold for far, at most 240 pixels wide.

    Raises:
        ValueError: the number of distances is not the number of pixels.
    """
    width, height = image.intrinsics.width_px, image.intrinsics.height_px
    depth_m = np.frombuffer(image.depth_m, dtype=np.float32)
    if len(depth_m) != width * height or len(depth_m) == 0:
        raise ValueError(f"{len(depth_m)} distances do not match an image of {width} x {height}")
    step = math.ceil(width / _WIDTH_PX)
    small = depth_m.reshape(height, width)[::step, ::step]
    measured = np.isfinite(small) & (small > 0.0)
    if not measured.any():
        return np.full((*small.shape, 3), _UNMEASURED, dtype=np.uint8)
    near_m, far_m = float(small[measured].min()), float(small[measured].max())
    share = (np.where(measured, small, far_m) - near_m) / max(far_m - near_m, 1e-6)
    # A lookup table of 256 colours: interpolating each pixel costs ten times as much.
    table = ramp(_NEAR_TO_FAR, np.linspace(0.0, 1.0, 256))
    shades = table[(share * 255).astype(np.uint8)]
    shades[~measured] = _UNMEASURED
    return shades


class CameraLayer:
    """Draws a frustum with the latest image for each camera, at most five times a second."""

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._server = server
        self._root = root_of("cameras", under=under)
        self._cameras: dict[str, _Camera] = {}

    def draw(self, latest: LatestMessages, now_s: float) -> float | None:
        """Draw the changes; return the time of the next call if it is too early now."""
        due: list[float] = []
        for name in {**latest.cameras, **latest.depths}:
            camera = self._cameras.setdefault(name, _Camera(self._server, name, node=f"{self._root}/{name}"))
            detections = latest.detections.get(name)
            if detections is not None and not is_fresh(detections, latest.frames):
                detections = None
            next_s = camera.draw(latest.cameras.get(name), latest.depths.get(name), detections, now_s)
            if next_s is not None:
                due.append(next_s)
        return min(due, default=None)


class _Camera:
    def __init__(self, server: Canvas, name: str, *, node: str) -> None:
        self._server = server
        self._name = name
        self._node = node
        self._drawn: tuple[CameraInfo | None, DepthImage | None, Detections | None] = (None, None, None)
        self._lens: CameraIntrinsics | None = None
        self._handle: viser.CameraFrustumHandle | None = None
        self._next_s = 0.0

    def draw(
        self, info: CameraInfo | None, image: DepthImage | None, detections: Detections | None, now_s: float
    ) -> float | None:
        if all(new is drawn for new, drawn in zip((info, image, detections), self._drawn, strict=True)):
            return None
        if now_s < self._next_s:
            return self._next_s
        self._drawn, self._next_s = (info, image, detections), now_s + PERIOD_S
        source = image if image is not None else info
        if source is None:
            return None
        try:
            shades = depth_picture(image) if image is not None else None
        except ValueError as error:
            _log.warning("the image of %s is not drawn: %s", self._name, error)
            return None
        with self._server.atomic():
            handle = self._frustum(source.intrinsics)
            handle.position, handle.wxyz = source.pose.xyz, wxyz(source.pose.xyzw)
            if shades is not None:
                handle.image = draw_labels(shades, detections) if detections is not None else shades
        return None

    def _frustum(self, lens: CameraIntrinsics) -> viser.CameraFrustumHandle:
        if self._handle is not None and self._lens == lens:
            return self._handle
        if self._handle is not None:
            self._handle.remove()
        # The optical frame is viser's own: x to the right, y down, z into the scene.
        self._handle = self._server.scene.add_camera_frustum(
            self._node,
            fov=2 * math.atan2(lens.height_px / 2, lens.fy_px),
            aspect=lens.width_px / lens.height_px,
            scale=_FRUSTUM_M,
            color=_FRAME,
            thickness=_FRAME_PX,
            thickness_units="screen",
            format="jpeg",
            cast_shadow=False,
        )
        self._server.scene.add_label(f"{self._node}/name", self._name, anchor="bottom-center", font_screen_scale=0.8)
        self._lens = lens
        return self._handle
