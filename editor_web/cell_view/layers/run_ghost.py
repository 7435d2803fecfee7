"""The arms of another run as translucent ghosts, where that run had them at its own time."""

from __future__ import annotations

import logging

import viser

from editor_web.cell_view.rendering.canvas import PAST, Canvas
from editor_web.cell_view.rendering.geometry import Rgb, add_geometry
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.transforms import poses_by_frame
from editor_web.cell_view.rendering.urdf_tree import UrdfTree
from engine.errors import FlexcellError
from engine.messages import FramePoses, RobotDescription, SceneDescription

_log = logging.getLogger("flexcell.cell_view")
GHOST = f"{PAST}/ghost"
_COLOUR: Rgb = (37, 99, 235)
_OPACITY = 0.4


class RunGhost:
    """Draws the links that the joints of each arm move; what stands is the same in both runs, and is drawn already.

    Its node is below that of the past scene, and is shown and removed with it.
    """

    def __init__(self, server: Canvas) -> None:
        self._server = server
        self._root: viser.FrameHandle | None = None
        self._scene: SceneDescription | None = None
        self._arms: dict[str, RobotDescription] = {}
        self._poses: FramePoses | None = None
        self._frames: dict[str, viser.FrameHandle] = {}

    def draw(self, latest: LatestMessages) -> None:
        """Draw the changes."""
        scene, poses, arms = latest.scene, latest.frames, latest.descriptions
        if scene is not None and arms and (scene is not self._scene or arms != self._arms):
            self.clear()
            self._scene, self._arms = scene, arms
            with self._server.atomic():
                self._build(scene)
        if poses is not None and poses is not self._poses:
            self._poses = poses
            with self._server.atomic():
                for name, pose in poses_by_frame(poses).items():
                    if name in self._frames:
                        self._frames[name].position, self._frames[name].wxyz = pose.xyz, pose.wxyz

    def clear(self) -> None:
        """Remove it."""
        if self._root is not None:
            self._root.remove()
        self._root = self._scene = self._poses = None
        self._arms, self._frames = {}, {}

    def _build(self, scene: SceneDescription) -> None:
        self._root = self._server.scene.add_frame(GHOST, show_axes=False)
        moved = {f"{name}/{link}" for name, arm in self._arms.items() for link in _moved(arm)}
        for index, geometry in enumerate(scene.geometries):
            if geometry.frame not in moved:
                continue
            node = f"{GHOST}/{geometry.frame.replace('/', '.')}"
            if geometry.frame not in self._frames:
                self._frames[geometry.frame] = self._server.scene.add_frame(node, show_axes=False)
            try:
                add_geometry(self._server, f"{node}/{index}", geometry, tint=_COLOUR, opacity=_OPACITY)
            except (FlexcellError, ValueError) as error:
                # One invalid shape must not hide the rest of the arm.
                _log.warning("the ghost of %s is not drawn: %s", geometry.name, error)


def _moved(arm: RobotDescription) -> frozenset[str]:
    try:
        return UrdfTree(arm.urdf).moved_by(arm.joint_names)
    except FlexcellError as error:
        _log.warning("the ghost of %s is not drawn: %s", arm.name, error)
        return frozenset()
