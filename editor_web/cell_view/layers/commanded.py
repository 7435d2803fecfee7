"""Ghosts of arms at their set points: always where a real arm is measured elsewhere, else for pages that ask for it."""

from __future__ import annotations

import logging

from editor_web.cell_view.layers.arm_ghost import ArmGhost
from editor_web.cell_view.rendering.canvas import CELL, Canvas
from editor_web.cell_view.rendering.geometry import Rgb
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from engine.errors import FlexcellError
from engine.messages import JointSetPoint, RobotDescription, SceneDescription

DEVIATION_RAD = 0.05
"""From here on a ghost is shown on every page: nearly three degrees, more than an arm is behind in slow motion."""
_COLOUR: Rgb = (217, 119, 6)
_log = logging.getLogger("flexcell.cell_view")


class CommandedLayer:
    """Draws the set point of each real arm."""

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._server = server
        # Two nodes for each arm, of which one is visible: a client shows or hides only what is below a group.
        self._far = f"{under}{CELL}/commanded"
        self._near = f"{root_of('commanded', under=under)}"
        self._arms: dict[str, _CommandedArm] = {}

    def draw(self, latest: LatestMessages, *, is_shown: bool) -> None:
        """Draw the changes; `is_shown` says whether any page shows all set points."""
        for name, set_point in latest.set_points.items():
            scene, description = latest.scene, latest.descriptions.get(name)
            if scene is None or description is None:
                continue
            arm = self._arms.get(name)
            if arm is None or not arm.is_of(scene, description):
                if arm is not None:
                    arm.remove()
                arm = self._arms[name] = _CommandedArm(self._server, name, scene, description)
            with self._server.atomic():
                is_far = bool(set_point.names) and set_point.deviation_rad >= DEVIATION_RAD
                arm.draw(self._far, set_point, latest, is_visible=is_far)
                arm.draw(self._near, set_point, latest, is_visible=bool(set_point.names) and is_shown and not is_far)


class _CommandedArm:
    def __init__(self, server: Canvas, name: str, scene: SceneDescription, description: RobotDescription) -> None:
        self._server = server
        self._name = name
        self._scene = scene
        self._description = description
        self._ghosts: dict[str, ArmGhost | None] = {}
        self._drawn: dict[str, JointSetPoint] = {}

    def is_of(self, scene: SceneDescription, description: RobotDescription) -> bool:
        """Return whether it is drawn from these messages."""
        return self._scene is scene and self._description is description

    def remove(self) -> None:
        """Remove its ghosts."""
        for ghost in self._ghosts.values():
            if ghost is not None:
                ghost.root.remove()

    def draw(self, root: str, set_point: JointSetPoint, latest: LatestMessages, *, is_visible: bool) -> None:
        """Place or hide the ghost below a node; it is built when it is visible for the first time."""
        if root not in self._ghosts:
            if not is_visible:
                return
            self._ghosts[root] = self._new_ghost(f"{root}/{self._name}")
        ghost = self._ghosts[root]
        if ghost is None:
            return
        if ghost.root.visible != is_visible:
            ghost.root.visible = is_visible
        if is_visible and self._drawn.get(root) is not set_point:
            self._drawn[root] = set_point
            ghost.update_tool(latest)
            ghost.place(set_point.names, set_point.position_rad)

    def _new_ghost(self, node: str) -> ArmGhost | None:
        try:
            ghost = ArmGhost(self._server, node, self._scene, self._description)
        except (FlexcellError, ValueError) as error:
            # The measured arm is drawn all the same.
            _log.warning("the set point of %s is not drawn: %s", self._name, error)
            return None
        ghost.paint(_COLOUR)
        return ghost
