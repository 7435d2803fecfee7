"""Detections in the 3D view: an oriented box for each, with label and score, coloured by label."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import msgspec
import numpy as np
import viser
from numpy.typing import NDArray

from editor_web.cell_view.layers.labelled_image import label_text
from editor_web.cell_view.rendering.canvas import Canvas
from editor_web.cell_view.rendering.colours import colour_of_name
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import root_of
from editor_web.cell_view.rendering.transforms import wxyz
from engine.messages import FramePoses, Vector3
from engine.skills.vision import Detection, Detections

_Anchor = Literal["bottom-center", "top-center"]
_OPACITY = 0.22
_LINE_PX = 2.5
# The box is drawn over the detected part and must not flicker against it.
_SWELL = 1.03
_ABOVE_M = 0.012
# Labels of two cameras for one object are above and below one point, which separates them at every zoom.
_ANCHORS: tuple[_Anchor, ...] = ("bottom-center", "top-center")
_BESIDE_M = 0.05
_LABEL_SCALE = 0.85
_AHEAD_S = 0.5


def is_fresh(detections: Detections, frames: FramePoses | None) -> bool:
    """Return whether detections are current at the time of the cell's frames; both have the world's clock."""
    return frames is None or -_AHEAD_S <= frames.time_s - detections.time_s <= detections.fresh_s


def box_edges(size_m: Vector3) -> NDArray[np.float32]:
    """Return the twelve edges of a box around the origin, (12, 2, 3)."""
    lines: list[list[list[float]]] = []
    for axis in range(3):
        for one in (-0.5, 0.5):
            for other in (-0.5, 0.5):
                ends = np.zeros((2, 3))
                ends[:, axis] = (-0.5, 0.5)
                ends[:, (axis + 1) % 3], ends[:, (axis + 2) % 3] = one, other
                lines.append((ends * size_m).tolist())
    return np.array(lines, dtype=np.float32)


class DetectionLayer:
    """Draws the latest detections of each camera, and removes them when they are out of date."""

    def __init__(self, server: Canvas, *, under: str = "") -> None:
        self._server = server
        self._root = root_of("detections", under=under)
        self._cameras: dict[str, _Boxes] = {}

    def draw(self, latest: LatestMessages) -> None:
        """Draw the changes."""
        several = len(latest.detections) > 1
        for row, (name, detections) in enumerate(latest.detections.items()):
            if name not in self._cameras:
                self._cameras[name] = _Boxes(self._server, f"{self._root}/{name}", row=row)
            by = f" · {name}" if several else ""
            self._cameras[name].draw(detections if is_fresh(detections, latest.frames) else None, by=by)


@dataclass(frozen=True)
class _Box:
    size_m: Vector3
    frame: viser.FrameHandle
    label: viser.LabelHandle

    def remove(self) -> None:
        self.frame.remove()
        self.label.remove()


class _Boxes:
    """The boxes of one camera."""

    def __init__(self, server: Canvas, node: str, *, row: int) -> None:
        self._server = server
        self._node = node
        self._anchor: _Anchor = _ANCHORS[row % len(_ANCHORS)]
        self._above_m = _ABOVE_M + row // len(_ANCHORS) * _BESIDE_M
        self._drawn: tuple[Detections | None, str] = (None, "")
        self._boxes: dict[str, _Box] = {}

    def draw(self, detections: Detections | None, *, by: str) -> None:
        """Draw exactly these detections; `by` is appended to each label."""
        if detections is self._drawn[0] and by == self._drawn[1]:
            return
        self._drawn = (detections, by)
        with self._server.atomic():
            drawn: set[str] = set()
            for detection in detections.detections if detections is not None else ():
                name = _free_name(detection.label, drawn)
                drawn.add(name)
                assert detections is not None
                self._place(name, detections, detection, by=by)
            for name in self._boxes.keys() - drawn:
                self._boxes.pop(name).remove()

    def _place(self, name: str, detections: Detections, detection: Detection, *, by: str) -> None:
        box = self._boxes.get(name)
        if box is None or box.size_m != detection.size_m:
            if box is not None:
                box.remove()
            box = self._boxes[name] = self._new(name, detection)
        pose = detections.in_world(detection)
        box.frame.position, box.frame.wxyz = pose.xyz, wxyz(pose.xyzw)
        x, y, _ = pose.xyz
        top_m = max(z for _, _, z in msgspec.structs.replace(detection, pose=pose).vertices_m)
        box.label.position = (x, y, top_m + self._above_m)
        if box.label.text != (text := label_text(detection.label, detection.score) + by):
            box.label.text = text

    def _new(self, name: str, detection: Detection) -> _Box:
        node, colour, scene = f"{self._node}/{name}", colour_of_name(detection.label), self._server.scene
        frame = scene.add_frame(node, show_axes=False)
        x, y, z = (edge * _SWELL for edge in detection.size_m)
        scene.add_box(
            f"{node}/body",
            dimensions=(x, y, z),
            color=colour,
            opacity=_OPACITY,
            cast_shadow=False,
            receive_shadow=False,
        )
        scene.add_line_segments(
            f"{node}/edges", points=box_edges((x, y, z)), colors=colour, thickness=_LINE_PX, thickness_units="screen"
        )
        label = scene.add_label(
            f"{node}.label",
            label_text(detection.label, detection.score),
            anchor=self._anchor,
            font_screen_scale=_LABEL_SCALE,
        )
        return _Box(detection.size_m, frame, label)


def _free_name(label: str, taken: set[str]) -> str:
    """Return a free node name for a label: the best detections keep their names from image to image."""
    start = "".join(each if each.isalnum() else "_" for each in label)
    return next(name for number in range(len(taken) + 1) if (name := f"{start}.{number}") not in taken)
