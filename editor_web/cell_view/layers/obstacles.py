"""The planning scene in the 3D view: added obstacles and held parts, translucent."""

from __future__ import annotations

import logging
from collections.abc import Mapping
from dataclasses import dataclass

import viser

from editor_web.cell_view.layers.contact_highlight import bodies_in_contact
from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.convex_shapes import add_convex_shape
from editor_web.cell_view.rendering.geometry import Rgb, body_name
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from editor_web.cell_view.rendering.transforms import (
    WorldPose,
    is_visible_change,
    matrix_of_pose,
    pose_of_matrix,
    poses_by_frame,
)
from engine.messages import FramePoses, Pose, SceneDescription
from engine.messages.shapes import Obstacle, Solid
from engine.skills.jogging import JogBlock
from engine.skills.planning import PathPreview
from engine.skills.planning_scene import HeldPart, PlanningSceneState

_log = logging.getLogger("flexcell.cell_view")
_OBSTACLE: Rgb = (217, 119, 6)
_HELD: Rgb = (124, 58, 237)
_BLOCKING: Rgb = (220, 38, 38)
_OPACITY = 0.35


_Read = tuple[PlanningSceneState, SceneDescription | None, Mapping[str, PathPreview], Mapping[str, JogBlock]]


@dataclass(frozen=True, kw_only=True)
class _Shown:
    """Objects to draw: obstacles, held parts, and the names of those that block a path or a jog."""

    obstacles: tuple[Obstacle, ...]
    held: tuple[HeldPart, ...]
    blocking: frozenset[str]


class ObstacleLayer:
    """Draws `cell/planning_scene`, except bodies that `cell/scene` has under the same name."""

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._server = server
        self._root = root_of("obstacles", under=under)
        self._read: _Read | None = None
        self._drawn: _Shown | None = None
        self._roots: list[viser.FrameHandle] = []
        self._held: list[tuple[HeldPart, viser.FrameHandle]] = []
        self._carried: dict[str, WorldPose] = {}
        self._poses: FramePoses | None = None

    def draw(self, latest: LatestMessages) -> None:
        """Draw the changes."""
        state, scene, paths, blocks = latest.planning_scene, latest.scene, latest.paths, latest.blocks
        if state is None:
            return
        now: _Read = (state, scene, paths, blocks)
        if self._read is None or any(one is not other for one, other in zip(self._read, now, strict=True)):
            self._read = now
            shown = _shown(*now)
            # A moving part changes the scene, but is drawn by the body layer.
            if shown != self._drawn:
                self._drawn, self._poses = shown, None
                with self._server.atomic():
                    self._build(shown)
        if self._held and latest.frames is not None and latest.frames is not self._poses:
            self._poses = latest.frames
            self._carry(latest.frames)

    def _build(self, shown: _Shown) -> None:
        for root in self._roots:
            root.remove()
        self._roots, self._carried = [], {}
        for each in shown.obstacles:
            colour = _BLOCKING if each.name in shown.blocking else _OBSTACLE
            self._add(each.name, each.solids, each.pose, colour)
        self._held = [
            (part, self._add(part.name, part.solids, part.pose, _BLOCKING if part.name in shown.blocking else _HELD))
            for part in shown.held
        ]

    def _add(self, name: str, solids: tuple[Solid, ...], pose: Pose, colour: Rgb) -> viser.FrameHandle:
        node = f"{self._root}/{name.replace('/', '.')}"
        at = WorldPose(xyz=pose.xyz, xyzw=pose.xyzw)
        root = self._server.scene.add_frame(node, show_axes=False, position=at.xyz, wxyz=at.wxyz)
        self._roots.append(root)
        for index, solid in enumerate(solids):
            try:
                add_convex_shape(self._server, f"{node}/{index}", solid, colour=colour, opacity=_OPACITY)
            except ValueError as error:
                # One invalid shape must not hide the others.
                _log.warning("%s is not drawn: %s", name, error)
        return root

    def _carry(self, frames: FramePoses) -> None:
        poses = poses_by_frame(frames)
        with self._server.atomic():
            for part, root in self._held:
                link = poses.get(f"{part.robot}/{part.link}", poses.get(part.link))
                root.visible = link is not None
                if link is None:
                    continue
                now = pose_of_matrix(matrix_of_pose(link) @ matrix_of_pose(part.pose))
                if is_visible_change(self._carried.get(part.name), now):
                    root.position, root.wxyz = now.xyz, now.wxyz
                    self._carried[part.name] = now


def _shown(
    state: PlanningSceneState,
    scene: SceneDescription | None,
    paths: Mapping[str, PathPreview],
    blocks: Mapping[str, JogBlock],
) -> _Shown:
    known = {body_name(g) for g in scene.geometries} if scene is not None else set[str]()
    held = {part.name for part in state.held}
    blocking = bodies_in_contact(paths, blocks, [each.name for each in (*state.obstacles, *state.held)])
    return _Shown(
        obstacles=tuple(
            each
            for each in state.obstacles
            if each.name in blocking or (each.name not in known and each.name not in held)
        ),
        held=state.held,
        blocking=blocking,
    )
