"""Depth cameras: a frustum where each stands, and its image in colours."""

from __future__ import annotations

import msgspec
import numpy as np
import pytest
import viser

from editor_web.cell_view.layers.cameras import PERIOD_S, CameraLayer, depth_picture
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from tests.editor_web.fake_sights import CAMERA_POSE, camera, depth


def frustum(server: viser.ViserServer) -> viser.CameraFrustumHandle:
    """The one that is drawn."""
    handle = server.scene.get_handle_by_name("/cameras/above")
    assert isinstance(handle, viser.CameraFrustumHandle)
    return handle


def test_near_is_warm_far_is_cold_and_what_was_not_measured_is_grey() -> None:
    shades = depth_picture(depth()).astype(int)
    assert shades.shape == (120, 160, 3)
    near, far, nothing = shades[60, 80], shades[21, 80], shades[5, 5]
    assert near[0] > near[2] + 50
    assert far[2] > far[0] + 20
    assert np.ptp(nothing) == 0


@pytest.mark.parametrize("value", [0.0, np.nan, np.inf, -1.0])
def test_an_image_of_nothing_is_grey_all_over(value: float) -> None:
    image = msgspec.structs.replace(depth(), depth_m=np.full((240, 320), value, dtype=np.float32).tobytes())
    assert len(np.unique(depth_picture(image).reshape(-1, 3), axis=0)) == 1


@pytest.mark.parametrize("content", [b"", b"1234" * 7])
def test_an_image_of_another_size_than_it_says_is_refused(content: bytes) -> None:
    with pytest.raises(ValueError, match="do not match an image"):
        depth_picture(msgspec.structs.replace(depth(), depth_m=content))


def test_a_camera_stands_there_before_it_has_an_image_and_shows_one_five_times_a_second(
    server: viser.ViserServer,
) -> None:
    cameras, newest = CameraLayer(server), LatestMessages()
    newest.put("above", camera())
    assert cameras.draw(newest, 0.0) is None
    assert frustum(server).position.tolist() == list(CAMERA_POSE.xyz)
    assert frustum(server).image is None
    newest.put("above", depth())
    assert cameras.draw(newest, 0.1) == PERIOD_S
    assert cameras.draw(newest, PERIOD_S) is None
    shown = frustum(server).image
    assert shown is not None
    newest.put("above", msgspec.structs.replace(depth(), depth_m=b""))
    cameras.draw(newest, 1.0)
    assert frustum(server).image is shown
