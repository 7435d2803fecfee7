"""A translucent copy of an arm at any joints, with its tool as it is measured."""

from __future__ import annotations

import viser

from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.geometry import GeometryHandle, Rgb, add_geometry
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.transforms import Matrix, matrix_of_pose, pose_of_matrix, poses_by_frame
from editor_web.cell_view.rendering.urdf_tree import UrdfTree
from engine.messages import RobotDescription, SceneDescription

OPACITY = 0.4


class ArmGhost:
    """A translucent copy of an arm."""

    def __init__(self, server: Canvas, node: str, scene: SceneDescription, description: RobotDescription) -> None:
        self._linkage = UrdfTree(description.urdf)
        self._base = matrix_of_pose(description.base)
        self._arm = description.name
        self._seen: dict[str, Matrix] = {}
        self.root = server.scene.add_frame(node, show_axes=False)
        self._frames: dict[str, viser.FrameHandle] = {}
        self._bodies: list[GeometryHandle] = []
        # Links that do not move are drawn already; copies of them would flicker.
        moved = self._linkage.moved_by(description.joint_names)
        for index, geometry in enumerate(scene.geometries):
            owner, _, link = geometry.frame.partition("/")
            if owner != description.name or link not in moved:
                continue
            below = f"{node}/{link.replace('/', '.')}"
            if link not in self._frames:
                self._frames[link] = server.scene.add_frame(below, show_axes=False)
            self._bodies.append(add_geometry(server, f"{below}/{index}", geometry, opacity=OPACITY))

    def update_tool(self, latest: LatestMessages) -> None:
        """Take over the current pose of the tool's fingers."""
        prefix = f"{self._arm}/"
        poses = poses_by_frame(latest.frames).items()
        self._seen = {
            name.removeprefix(prefix): matrix_of_pose(pose) for name, pose in poses if name.startswith(prefix)
        }

    def place(self, names: tuple[str, ...], joints: tuple[float, ...]) -> None:
        """Move to these joints."""
        links = self._linkage.links(self._base, dict(zip(names, joints, strict=False)), seen=self._seen)
        for link, handle in self._frames.items():
            if link in links:
                pose = pose_of_matrix(links[link])
                handle.position, handle.wxyz = pose.xyz, pose.wxyz

    def paint(self, colour: Rgb) -> None:
        """Set the colour."""
        for body in self._bodies:
            body.color = colour
