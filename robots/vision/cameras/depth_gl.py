"""Depth images by OpenGL on the CPU: loads the graphics libraries, so only in processes that render."""

from __future__ import annotations

from importlib import import_module
from typing import Any, Literal

import numpy as np

from engine.messages.sensing import CameraIntrinsics
from robots.model.transform import RigidTransform
from robots.sim.physics.physics import mujoco
from robots.vision.cameras.camera import CameraSpec, Image
from robots.vision.cameras.depth_rays import SEEN_GROUPS
from robots.vision.cameras.physics_copy import PhysicsCopy

GlKind = Literal["egl", "osmesa"]
# Nearer objects are not rendered and do not occlude.
_NEAR_M = 0.05
_BEYOND = 1.2
_MORE_GEOMS = 100


class GraphicsUnavailable(Exception):
    """OpenGL is unavailable; the text states why."""


class GlDepthRenderer:
    """Renders with MuJoCo's classic renderer, on this thread only.

    The context is created directly: `MUJOCO_GL` would have to be set before anything loads MuJoCo.

    Raises:
        GraphicsUnavailable: this machine has no such OpenGL.
    """

    def __init__(self, cell: PhysicsCopy, cameras: tuple[CameraSpec, ...], *, kind: GlKind) -> None:
        self._cell = cell
        model = cell.model
        width = max((camera.intrinsics.width_px for camera in cameras), default=16)
        height = max((camera.intrinsics.height_px for camera in cameras), default=16)
        model.vis.global_.offwidth, model.vis.global_.offheight = width, height
        model.vis.quality.offsamples, model.vis.quality.shadowsize = 0, 0
        try:
            self._gl: Any = import_module(f"mujoco.{kind}").GLContext(width, height)
            self._gl.make_current()
            self._context: Any = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        except Exception as error:
            # Missing libraries and drivers raise anything from ImportError to AttributeError.
            raise GraphicsUnavailable(f"{type(error).__name__}: {error}") from error
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._context.readDepthMap = mujoco.mjtDepthMap.mjDEPTH_ZEROFAR
        self._scene: Any = mujoco.MjvScene(model, maxgeom=int(model.ngeom) + _MORE_GEOMS)
        self._options = _bodies_only()
        self._view: Any = mujoco.MjvCamera()
        self.words = f"with OpenGL ({kind})"

    def intrinsics(self, camera: CameraSpec) -> CameraIntrinsics:
        """Return the camera's own intrinsics."""
        return camera.intrinsics

    def exact(self, camera: CameraSpec) -> Image:
        """Return the exact depths, (height, width), infinite where nothing is hit."""
        scene, lens = self._scene, camera.intrinsics
        far = _BEYOND * camera.range_m[1]
        self._gl.make_current()
        mujoco.mjv_updateScene(
            self._cell.model,
            self._cell.data,
            self._options,
            None,
            self._view,
            mujoco.mjtCatBit.mjCAT_ALL.value,
            scene,
        )
        for flag in range(len(scene.flags)):
            scene.flags[flag] = False
        # Without shading, and without haze, which would change far depths.
        scene.flags[mujoco.mjtRndFlag.mjRND_SEGMENT] = True
        scene.flags[mujoco.mjtRndFlag.mjRND_IDCOLOR] = True
        self._look(camera, far)
        image = np.empty((lens.height_px, lens.width_px), dtype=np.float32)
        window = mujoco.MjrRect(0, 0, lens.width_px, lens.height_px)
        mujoco.mjr_render(window, scene, self._context)
        mujoco.mjr_readPixels(None, image, window, self._context)
        # The depth buffer holds 1 at the near plane and 0 at the far one; rows come from below.
        buffer = image[::-1].astype(np.float64)
        depth = _NEAR_M * far / (_NEAR_M + buffer * (far - _NEAR_M))
        return np.where(buffer > 0.0, depth, np.inf).astype(np.float32)

    def close(self) -> None:
        """Release the graphics context."""
        self._gl.make_current()
        self._context.free()
        self._gl.free()

    def _look(self, camera: CameraSpec, far: float) -> None:
        lens, pose = camera.intrinsics, RigidTransform.from_pose(camera.pose)
        up = _NEAR_M * lens.height_px / 2.0 / lens.fy_px
        for eye in self._scene.camera:
            eye.pos[:] = pose.xyz
            eye.forward[:] = pose.rotation[:, 2]
            eye.up[:] = -pose.rotation[:, 1]
            eye.orthographic = 0
            eye.frustum_center = 0.0
            eye.frustum_width = _NEAR_M * lens.width_px / 2.0 / lens.fx_px
            eye.frustum_bottom, eye.frustum_top = -up, up
            eye.frustum_near, eye.frustum_far = _NEAR_M, far


def _bodies_only() -> Any:
    """Return options that show bodies without MuJoCo's annotations."""
    options = mujoco.MjvOption()
    options.flags[:] = 0
    options.flags[mujoco.mjtVisFlag.mjVIS_STATIC] = 1
    for group in range(6):
        options.geomgroup[group] = group < SEEN_GROUPS
    for groups in (options.sitegroup, options.jointgroup, options.tendongroup, options.actuatorgroup):
        groups[:] = 0
    return options
