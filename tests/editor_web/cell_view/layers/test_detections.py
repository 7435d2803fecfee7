"""Detections: an oriented box with label and score for each, until they are of another moment; labelled images."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
import viser
from numpy.typing import NDArray

from editor_web.cell_view.layers.cameras import PERIOD_S, CameraLayer
from editor_web.cell_view.layers.detections import DetectionLayer, box_edges
from editor_web.cell_view.layers.labelled_image import draw_labels
from editor_web.cell_view.rendering.colours import colour_of_name
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from engine.messages import FramePoses, Pose
from engine.skills.vision import Detection
from tests.editor_web.fake_sights import LENS, camera, depth, detections

NODE = "/detections/above/cup.0"


def frames(time_s: float) -> FramePoses:
    """Return the cell's frames at a time of its clock."""
    return FramePoses(time_s=time_s, names=(), xyz=(), xyzw=())


def drawn(server: viser.ViserServer, name: str) -> viser.SceneNodeHandle | None:
    """Return what is drawn under a name."""
    return server.scene.get_handle_by_name(name)


def label(server: viser.ViserServer, node: str = NODE) -> viser.LabelHandle:
    """Return what is written at a detection."""
    handle = drawn(server, f"{node}.label")
    assert isinstance(handle, viser.LabelHandle)
    return handle


def test_each_detection_is_a_box_in_the_colour_of_its_label_with_words_above(server: viser.ViserServer) -> None:
    boxes, newest = DetectionLayer(server), LatestMessages()
    found = detections()
    newest.put("above", found)
    boxes.draw(newest)
    frame, body = drawn(server, NODE), drawn(server, f"{NODE}/body")
    assert frame is not None
    assert isinstance(body, viser.BoxHandle)
    cup = found.detections[0]
    assert frame.position.tolist() == list(cup.pose.xyz)
    assert frame.wxyz.tolist() == [cup.pose.xyzw[3], *cup.pose.xyzw[:3]]
    assert body.color == colour_of_name("cup")
    assert label(server).text == "cup 0.92"
    assert label(server).position[2] > max(corner[2] for corner in cup.vertices_m)
    assert drawn(server, "/detections/above/plate.0") is not None


def test_boxes_of_another_frame_are_where_that_frame_is(server: viser.ViserServer) -> None:
    boxes, newest = DetectionLayer(server), LatestMessages()
    corner = Pose(xyz=(1.0, 2.0, 0.5), xyzw=(0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    cup = Detection(label="cup", score=1.0, pose=Pose(xyz=(0.1, 0.0, 0.0), frame="corner"), size_m=(0.1, 0.1, 0.1))
    newest.put("above", msgspec.structs.replace(detections(), frame="corner", frame_pose=corner, detections=(cup,)))
    boxes.draw(newest)
    frame = drawn(server, NODE)
    assert frame is not None
    assert frame.position.tolist() == pytest.approx([1.0, 2.1, 0.5])


def test_a_thing_that_moves_keeps_its_box_and_one_that_is_gone_loses_it(server: viser.ViserServer) -> None:
    boxes, newest = DetectionLayer(server), LatestMessages()
    newest.put("above", detections())
    boxes.draw(newest)
    frame = drawn(server, NODE)
    newest.put("above", detections(at=(0.3, 0.3, 0.1), score=0.5, only="cup"))
    boxes.draw(newest)
    moved = drawn(server, NODE)
    assert moved is frame
    assert moved is not None
    assert moved.position.tolist() == [0.3, 0.3, 0.1]
    assert label(server).text == "cup 0.50"
    assert drawn(server, "/detections/above/plate.0") is None
    assert drawn(server, "/detections/above/plate.0.label") is None


def test_two_of_one_label_have_a_box_each(server: viser.ViserServer) -> None:
    boxes, newest = DetectionLayer(server), LatestMessages()
    one = detections(only="cup")
    newest.put("above", msgspec.structs.replace(one, detections=one.detections * 2))
    boxes.draw(newest)
    assert drawn(server, NODE) is not None
    assert drawn(server, "/detections/above/cup.1") is not None


def test_cameras_have_their_own_boxes_and_words_above_and_below_one_point(server: viser.ViserServer) -> None:
    boxes, newest = DetectionLayer(server), LatestMessages()
    newest.put("above", detections())
    boxes.draw(newest)
    newest.put("beside", detections("beside", score=0.3))
    boxes.draw(newest)
    one, other = label(server), label(server, "/detections/beside/cup.0")
    assert (one.text, other.text) == ("cup 0.92 · above", "cup 0.30 · beside")
    assert (one.anchor, other.anchor) == ("bottom-center", "top-center")


@pytest.mark.parametrize(
    ("now_s", "is_there"), [(1.0, True), (1.9, True), (2.1, False), (0.9, True), (0.3, False), (600.0, False)]
)
def test_boxes_are_gone_once_the_cell_is_at_another_time(
    server: viser.ViserServer, now_s: float, is_there: bool
) -> None:
    boxes, newest = DetectionLayer(server), LatestMessages()
    newest.put("above", detections(time_s=1.0))
    boxes.draw(newest)
    newest.put("cell", frames(now_s))
    boxes.draw(newest)
    assert (drawn(server, NODE) is not None) is is_there


def test_a_box_has_twelve_edges_as_long_as_it_is() -> None:
    lines = box_edges((0.1, 0.2, 0.3))
    assert lines.shape == (12, 2, 3)
    lengths = sorted(np.linalg.norm(lines[:, 1] - lines[:, 0], axis=1).round(6).tolist())
    assert lengths == pytest.approx([0.1] * 4 + [0.2] * 4 + [0.3] * 4)
    assert len({tuple(corner) for corner in lines.reshape(-1, 3).tolist()}) == 8


def test_the_image_frames_what_was_found_in_its_colour() -> None:
    grey = np.full((120, 160, 3), 40, dtype=np.uint8)
    image = draw_labels(grey, detections(only="cup"))
    assert image.shape == (240, 320, 3)
    # The cup's rectangle in the camera's image of 320 x 240 pixels, which this one is as large as.
    left, top, right, bottom = (int(value) for value in (100, 80, 180, 160))
    colour = list(colour_of_name("cup"))
    for place in ((top, left + 9), (bottom, left + 9), (top + 9, left), (top + 9, right)):
        assert image[place].tolist() == colour
    assert image[top + 9, left + 9].tolist() == [40, 40, 40]
    assert image[top - 6, left + 1].tolist() == colour


def test_what_was_found_without_a_rectangle_leaves_the_image_as_it_is() -> None:
    grey = np.full((240, 320, 3), 40, dtype=np.uint8)
    found = detections(only="cup")
    bare = tuple(msgspec.structs.replace(each, rectangle_px=None) for each in found.detections)
    assert (draw_labels(grey, msgspec.structs.replace(found, detections=bare)) == grey).all()


@pytest.mark.parametrize(
    "rectangle", [(-50.0, -20.0, 30.0, 30.0), (300.0, 230.0, 500.0, 400.0), (0.0, 0.0, 319.0, 239.0)]
)
def test_rectangles_over_the_edge_are_drawn_as_far_as_they_go(rectangle: tuple[float, float, float, float]) -> None:
    grey = np.full((LENS.height_px, LENS.width_px, 3), 40, dtype=np.uint8)
    found = detections(only="cup")
    (cup,) = found.detections
    over = msgspec.structs.replace(found, detections=(msgspec.structs.replace(cup, rectangle_px=rectangle),))
    assert (draw_labels(grey, over) != grey).any()


def test_the_image_in_the_frustum_is_labelled_while_the_detections_are_fresh(server: viser.ViserServer) -> None:
    cameras, newest = CameraLayer(server), LatestMessages()

    def image() -> NDArray[np.uint8]:
        handle = drawn(server, "/cameras/above")
        assert isinstance(handle, viser.CameraFrustumHandle)
        assert handle.image is not None
        return handle.image

    newest.put("above", camera())
    newest.put("above", depth())
    cameras.draw(newest, 0.0)
    bare = image()
    newest.put("above", detections(time_s=1.0))
    assert cameras.draw(newest, PERIOD_S / 2) == PERIOD_S
    cameras.draw(newest, PERIOD_S)
    marked = image()
    newest.put("cell", frames(9.0))
    cameras.draw(newest, 2 * PERIOD_S)
    assert marked.shape == (240, 320, 3)
    assert (image() == bare).all()
