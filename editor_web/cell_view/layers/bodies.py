"""The bodies of the cell in viser: meshes are sent once, afterwards only the poses of frames that moved."""

from __future__ import annotations

import logging
from collections.abc import Mapping

import numpy as np
import viser

from editor_web.cell_view.layers.contact_highlight import bodies_in_contact
from editor_web.cell_view.rendering.canvas import CELL, Canvas
from editor_web.cell_view.rendering.geometry import GeometryHandle, Rgb, add_geometry, body_name, colour_of, corners
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from editor_web.cell_view.rendering.transforms import WorldPose, is_visible_change, poses_by_frame
from engine.errors import FlexcellError
from engine.messages import FramePoses, SceneDescription
from engine.skills.jogging import JogBlock
from engine.skills.planning import PathPreview

_log = logging.getLogger("flexcell.cell_view")
_VIEW_DIRECTION = np.array([0.42, -0.8, 0.5])
_FIELD_OF_VIEW_RAD = float(np.radians(45.0))
_AXES_M = 0.12
_TOUCHING: Rgb = (220, 38, 38)


def body_node(frame: str, arms: frozenset[str], *, parts: frozenset[str] = frozenset(), under: str = "") -> str:
    """Return the scene node of a frame. Bodies that belong to no arm, and are no `parts` of a module, are people."""
    owner, slash, _ = frame.partition("/")
    is_person = bool(arms and slash) and owner not in arms and frame not in parts
    # A slash would nest the frame below another one, but all poses are in the world frame.
    return f"{root_of('people', under=under) if is_person else under + CELL}/{frame.replace('/', '.')}"


class BodyLayer:
    """Draws `cell/scene` and moves it by `cell/frames`; on the canvas of one page, floor and camera stay unchanged.

    Bodies that would collide on a blocked path, or that a jog stands before, are red.
    """

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._server = server
        self._under = under
        self._scene: SceneDescription | None = None
        self._arms: frozenset[str] = frozenset()
        self._parts: frozenset[str] = frozenset()
        self._poses: FramePoses | None = None
        self._frames: dict[str, list[viser.FrameHandle]] = {}
        self._drawn: dict[str, WorldPose] = {}
        self._shapes: list[tuple[str, GeometryHandle, Rgb]] = []
        self._paths: Mapping[str, PathPreview] = {}
        self._blocks: Mapping[str, JogBlock] = {}
        self._marked: frozenset[str] = frozenset()

    def draw(self, latest: LatestMessages) -> None:
        """Draw the changes."""
        scene, poses, arms = latest.scene, latest.frames, frozenset(latest.descriptions)
        if scene is not None and (scene is not self._scene or arms != self._arms):
            self._scene, self._arms, self._poses = scene, arms, None
            self._paths, self._blocks, self._marked = {}, {}, frozenset()
            with self._server.atomic():
                self._build(scene, latest)
        if poses is not None and poses is not self._poses:
            self._poses = poses
            self._move(poses_by_frame(poses))
        if latest.paths is not self._paths or latest.blocks is not self._blocks:
            self._paths, self._blocks = latest.paths, latest.blocks
            self._mark(bodies_in_contact(self._paths, self._blocks, {name for name, _, _ in self._shapes}))

    def _build(self, scene: SceneDescription, latest: LatestMessages) -> None:
        known = poses_by_frame(latest.frames)
        # The one body of a part has the name of its frame.
        self._parts = frozenset(each.frame for each in scene.geometries if each.name == each.frame)
        for handle in (each for of_name in self._frames.values() for each in of_name):
            handle.remove()
        self._frames, self._drawn, self._shapes = {}, {}, []
        if isinstance(self._server, viser.ViserServer):
            _add_floor(self._server, scene, known)
            _look(self._server, scene, known)
        for name in sorted({g.frame for g in scene.geometries}):
            self._frames[name] = [self._server.scene.add_frame(self._node(name), show_axes=False)]
        for index, geometry in enumerate(scene.geometries):
            try:
                shape = add_geometry(self._server, f"{self._node(geometry.frame)}/{index}", geometry)
            except (FlexcellError, ValueError) as error:
                # One invalid shape must not hide the rest of the cell.
                _log.warning("%s is not drawn: %s", geometry.name, error)
                continue
            # A link of an arm is identified by its frame.
            is_link = geometry.frame.partition("/")[0] in self._arms
            name = geometry.frame if is_link else body_name(geometry)
            self._shapes.append((name, shape, colour_of(geometry)))
        self._add_axes(latest, known)

    def _mark(self, names: frozenset[str]) -> None:
        """Colour the bodies that would collide on a blocked path, and restore the colours of the others."""
        changed, self._marked = self._marked ^ names, names
        if not changed:
            return
        with self._server.atomic():
            for name, shape, own in self._shapes:
                if name in changed:
                    shape.color = _TOUCHING if name in names else own

    def _node(self, frame: str) -> str:
        return body_node(frame, self._arms, parts=self._parts, under=self._under)

    def _add_axes(self, latest: LatestMessages, known: Mapping[str, WorldPose]) -> None:
        """Show the frames of the world, the tools and the parts."""
        tools = {each.tool_frame for each in latest.descriptions.values()}
        for name in ("world", *(n for n in known if n in tools or "/" not in n)):
            node = f"{root_of('frames', under=self._under)}/{name.replace('/', '.')}"
            handle = self._server.scene.add_frame(node, axes_length=_AXES_M, axes_radius=_AXES_M / 25)
            self._server.scene.add_label(f"{node}/name", name, anchor="bottom-left", font_screen_scale=0.75)
            self._frames.setdefault(name, []).append(handle)

    def _move(self, poses: Mapping[str, WorldPose]) -> None:
        # Compared with what was drawn last, not with the last message: a slow motion arrives too.
        moved = [
            (n, pose) for n, pose in poses.items() if n in self._frames and is_visible_change(self._drawn.get(n), pose)
        ]
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


def _add_floor(server: viser.ViserServer, scene: SceneDescription, known: Mapping[str, WorldPose]) -> None:
    server.scene.add_grid(
        "/floor", infinite_grid=True, cell_size=0.1, section_size=1.0, position=(0.0, 0.0, _lowest(scene, known))
    )


def _look(server: viser.ViserServer, scene: SceneDescription, known: Mapping[str, WorldPose]) -> None:
    boxes = [corners(g, known.get(g.frame)) for g in scene.geometries]
    if not boxes:
        return
    points = np.concatenate(boxes)
    low, high = points.min(axis=0), points.max(axis=0)
    centre = (low + high) / 2
    distance_m = float(np.linalg.norm(high - low)) / 2 / np.tan(_FIELD_OF_VIEW_RAD / 2)
    camera = server.initial_camera
    camera.fov = _FIELD_OF_VIEW_RAD
    camera.look_at = centre
    camera.position = centre + _VIEW_DIRECTION / np.linalg.norm(_VIEW_DIRECTION) * distance_m


def _lowest(scene: SceneDescription, known: Mapping[str, WorldPose]) -> float:
    heights = [float(c[:, 2].min()) for g in scene.geometries if len(c := corners(g, known.get(g.frame)))]
    return min(heights, default=0.0)
