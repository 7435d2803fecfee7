"""The bodies of the cell in viser: meshes are sent once, afterwards only the poses of frames that moved."""

from __future__ import annotations

import logging
from collections.abc import Mapping

import numpy as np
import viser

from editor_web.cell_view.geometry import add_geometry, corners
from editor_web.cell_view.groups import root_of
from editor_web.cell_view.newest import Newest
from editor_web.cell_view.placement import Placed, by_name
from engine.errors import FlexcellError
from engine.messages import FramePoses, SceneDescription

_log = logging.getLogger("flexcell.cell_view")
_VIEW_DIRECTION = np.array([0.42, -0.8, 0.5])
_FIELD_OF_VIEW_RAD = float(np.radians(45.0))
_AXES_M = 0.12
CELL = "/cell"


def body_node(frame: str, arms: frozenset[str]) -> str:
    """Return the node of a frame. Bodies of neither an arm nor the cell itself are those of people."""
    owner, slash, _ = frame.partition("/")
    is_person = bool(arms and slash) and owner not in arms
    # A slash would nest the frame below another one, and poses are all in the world.
    return f"{root_of('people') if is_person else CELL}/{frame.replace('/', '.')}"


class Bodies:
    """Draws `cell/scene` and moves it by `cell/frames`."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server = server
        self._scene: SceneDescription | None = None
        self._arms: frozenset[str] = frozenset()
        self._poses: FramePoses | None = None
        self._frames: dict[str, list[viser.FrameHandle]] = {}
        self._drawn: dict[str, Placed] = {}

    def draw(self, newest: Newest) -> None:
        """Draw what has changed."""
        scene, poses, arms = newest.scene, newest.frames, frozenset(newest.descriptions)
        if scene is not None and (scene is not self._scene or arms != self._arms):
            self._scene, self._arms, self._poses = scene, arms, None
            with self._server.atomic():
                self._build(scene, newest)
        if poses is not None and poses is not self._poses:
            self._poses = poses
            self._move(by_name(poses))

    def _build(self, scene: SceneDescription, newest: Newest) -> None:
        known = by_name(newest.frames)
        for root in ("/floor", CELL, root_of("people"), root_of("frames")):
            self._server.scene.remove_by_name(root)
        self._drawn = {}
        self._server.scene.add_grid(
            "/floor", infinite_grid=True, cell_size=0.1, section_size=1.0, position=(0.0, 0.0, _lowest(scene, known))
        )
        self._frames = {}
        for name in sorted({g.frame for g in scene.geometries}):
            self._frames[name] = [self._server.scene.add_frame(body_node(name, self._arms), show_axes=False)]
        for index, geometry in enumerate(scene.geometries):
            try:
                add_geometry(self._server, f"{body_node(geometry.frame, self._arms)}/{index}", geometry)
            except (FlexcellError, ValueError) as error:
                # One shape that cannot be drawn must not hide the rest of the cell.
                _log.warning("%s is not drawn: %s", geometry.name, error)
        self._add_axes(newest, known)
        self._look(scene, known)

    def _add_axes(self, newest: Newest, known: Mapping[str, Placed]) -> None:
        """Show the frames that people speak of: the world's, the tools' and the parts'."""
        tools = {each.tool_frame for each in newest.descriptions.values()}
        for name in ("world", *(n for n in known if n in tools or "/" not in n)):
            node = f"{root_of('frames')}/{name.replace('/', '.')}"
            handle = self._server.scene.add_frame(node, axes_length=_AXES_M, axes_radius=_AXES_M / 25)
            self._server.scene.add_label(f"{node}/name", name, anchor="bottom-left", font_screen_scale=0.75)
            self._frames.setdefault(name, []).append(handle)

    def _move(self, poses: Mapping[str, Placed]) -> None:
        moved = [(n, pose) for n, pose in poses.items() if n in self._frames and self._drawn.get(n) != pose]
        if not moved:
            return
        with self._server.atomic():
            for name, pose in moved:
                before = self._drawn.get(name)
                for handle in self._frames[name]:
                    if before is None or before.xyz != pose.xyz:
                        handle.position = pose.xyz
                    if before is None or before.xyzw != pose.xyzw:
                        handle.wxyz = pose.wxyz
                self._drawn[name] = pose

    def _look(self, scene: SceneDescription, known: Mapping[str, Placed]) -> None:
        boxes = [corners(g, known.get(g.frame)) for g in scene.geometries]
        if not boxes:
            return
        points = np.concatenate(boxes)
        low, high = points.min(axis=0), points.max(axis=0)
        centre = (low + high) / 2
        distance_m = float(np.linalg.norm(high - low)) / 2 / np.tan(_FIELD_OF_VIEW_RAD / 2)
        camera = self._server.initial_camera
        camera.fov = _FIELD_OF_VIEW_RAD
        camera.look_at = centre
        camera.position = centre + _VIEW_DIRECTION / np.linalg.norm(_VIEW_DIRECTION) * distance_m


def _lowest(scene: SceneDescription, known: Mapping[str, Placed]) -> float:
    heights = [float(c[:, 2].min()) for g in scene.geometries if len(c := corners(g, known.get(g.frame)))]
    return min(heights, default=0.0)
