"""The ideal detector: parts in view are found where they are, hidden ones with lower scores and then not at all."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest

from engine.document.cell_perception import DepthCamera, ObjectDetector
from engine.document.placement import Placement
from engine.errors import CellError
from engine.messages import Pose, Vector3
from engine.messages.pose_algebra import angle_between_rad
from engine.skills.vision import Detections
from robots.scene.sim_scene import FixtureBody, PartBody, SimScene
from robots.vision.camera_rig import CameraRig
from robots.vision.perception_messages import PerceptionRequest, PerceptionSetup
from tests.robots.vision.watched_cell import block, cameras, look, scene

TURN = (0.0, 0.0, 0.3826834323650898, 0.9238795325112867)
PART = PartBody(name="device", shape="box", size_m=(0.12, 0.04, 0.03), mass_kg=0.1, pose=Pose(xyz=(0.5, 0.1, 0.015)))
TURNED = msgspec.structs.replace(PART, pose=Pose(xyz=(0.5, 0.1, 0.015), xyzw=TURN))
_IDEAL = ObjectDetector()
CELL = PartBody(
    name="battery", shape="cylinder", size_m=(0.017, 0.0335), mass_kg=0.02, pose=Pose(xyz=(0.4, -0.1, 0.02))
)


def camera(detect: ObjectDetector | None = _IDEAL, **changes: object) -> DepthCamera:
    """Return a camera above the parts."""
    above = DepthCamera(at=(0.5, 0.0, 1.2), look_at=(0.5, 0.0, 0.0), detect=detect)
    return msgspec.structs.replace(above, **changes)


def found(
    what: SimScene, seen_by: DepthCamera | None = None, *, seed: int = 0, time_s: float = 0.0, name: str = "top"
) -> Detections:
    """Return what a camera finds in a scene as it begins."""
    eye = CameraRig(
        PerceptionSetup(scene=what, cameras=cameras(**{name: seen_by or camera()}), box=None, seed=seed),
        repeatable=True,
    )
    seen = eye.look(PerceptionRequest(time_s=time_s, state=look(what).state, cameras=(), detecting=(name,)))
    (detections,) = seen.detections
    return detections


def plate(x: float) -> FixtureBody:
    """Return a plate between camera and device that begins at `x`, to the left of which all is hidden."""
    return block((x - 0.5, 0.1, 0.06), (1.0, 0.4, 0.01), name="plate")


def test_parts_in_view_are_found_where_they_are_with_their_boxes() -> None:
    detections = found(scene(parts=(TURNED, CELL)))
    assert {each.label for each in detections.detections} == {"device", "battery"}
    device = next(each for each in detections.detections if each.label == "device")
    assert device.pose.xyz == pytest.approx(TURNED.pose.xyz, abs=1e-3)
    assert angle_between_rad(device.pose.xyzw, TURN) < 1e-3
    assert device.size_m == (0.12, 0.04, 0.03)
    battery = next(each for each in detections.detections if each.label == "battery")
    assert battery.size_m == (0.017, 0.017, 0.0335)
    assert (device.score, battery.score) == (1.0, 1.0)
    assert (detections.camera, detections.frame, detections.image_px) == ("top", "world", (640, 480))


def test_the_rectangle_frames_the_part_in_the_image() -> None:
    (device,) = found(scene(parts=(PART,))).detections
    assert device.rectangle_px is not None
    # 1.17 m away, 439 pixels a metre at 1 m: up in this image is +y in the world.
    focal = 240 / np.tan(0.5) / 1.17
    left, top, right, bottom = device.rectangle_px
    assert (right - left, bottom - top) == pytest.approx((0.12 * focal, 0.04 * focal), abs=2.0)
    assert ((left + right) / 2, (top + bottom) / 2) == pytest.approx((319.5, 239.5 - 0.1 * focal), abs=1.0)


def test_what_hides_a_part_lowers_its_score_until_it_is_not_found() -> None:
    scores = [[each.score for each in found(scene(plate(x), parts=(PART,))).detections] for x in (0.3, 0.5, 0.6)]
    (full,), (half,), none = scores
    assert full == 1.0
    assert half == pytest.approx(0.5, abs=0.06)
    assert none == []


def test_parts_hide_one_another() -> None:
    lid = PartBody(name="lid", shape="box", size_m=(0.06, 0.2, 0.01), mass_kg=0.1, pose=Pose(xyz=(0.47, 0.1, 0.05)))
    detections = found(scene(parts=(PART, lid))).detections
    assert [each.label for each in detections] == ["lid", "device"]
    assert detections[1].score == pytest.approx(0.5, abs=0.06)


@pytest.mark.parametrize(
    ("at", "score"), [((0.5, 0.1, 0.015), 1.0), ((1.364, 0.0, 0.015), 0.5), ((0.5, 0.9, 0.015), None)]
)
def test_the_edge_of_the_image_cuts_off_what_is_beyond(at: Vector3, score: float | None) -> None:
    detections = found(scene(parts=(msgspec.structs.replace(PART, pose=Pose(xyz=at)),))).detections
    assert [each.score for each in detections] == pytest.approx([score] if score is not None else [], abs=0.12)


def test_what_is_out_of_range_or_too_small_is_not_found() -> None:
    what = scene(parts=(PART,))
    assert not found(what, camera(range_m=(0.2, 1.0))).detections
    assert not found(what, camera(range_m=(1.3, 3.0))).detections
    assert not found(what, camera(ObjectDetector(min_pixels=20_000))).detections


def test_labels_are_those_of_the_cell_and_boxes_are_in_its_frame() -> None:
    corner = Placement(xyz=(0.2, -0.3, 0.0), rpy=(0.0, 0.0, 1.5))
    detector = ObjectDetector(labels={"device": "front"}, frame="table_corner", frame_at=corner)
    detections = found(scene(parts=(TURNED,)), camera(detector))
    (device,) = detections.detections
    assert (device.label, device.pose.frame, detections.frame) == ("front", "table_corner", "table_corner")
    assert device.pose.xyz != pytest.approx(TURNED.pose.xyz, abs=0.05)
    world = detections.in_world(device)
    assert world.frame == "world"
    assert world.xyz == pytest.approx(TURNED.pose.xyz, abs=1e-9)
    assert angle_between_rad(world.xyzw, TURN) < 1e-6


def test_noise_has_its_size_and_depends_on_camera_part_frame_and_seed_alone() -> None:
    noisy = camera(ObjectDetector(noise_m=0.002, noise_rad=0.05))
    what = scene(parts=(TURNED,))

    def pose(*, seed: int = 1, frame: int = 0, name: str = "top") -> Pose:
        return found(what, noisy, seed=seed, time_s=frame / noisy.rate_hz, name=name).detections[0].pose

    assert pose() == pose()
    others = [pose(), pose(seed=2), pose(frame=3), pose(name="side")]
    assert len({each.xyz for each in others}) == 4
    off = [np.subtract(pose(frame=frame).xyz, TURNED.pose.xyz) for frame in range(40)]
    assert float(np.std(off)) == pytest.approx(0.002, rel=0.3)
    turns = [angle_between_rad(pose(frame=frame).xyzw, TURN) for frame in range(10)]
    assert 0.02 < float(np.mean(turns)) < 0.2


def test_a_camera_without_a_detector_says_so() -> None:
    with pytest.raises(CellError, match="top has no detector"):
        found(scene(parts=(PART,)), camera(detect=None))
