"""Tests of the simulated depth camera: true to the millimetre, the same twice, by rays and with OpenGL."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from ctypes.util import find_library
from pathlib import Path

import numpy as np
import pytest

from engine.document.cell_perception import DepthCamera
from engine.errors import CellError
from engine.messages.sensing import DepthImage
from robots.vision.camera_rig import CameraRig
from robots.vision.cameras.camera import camera_of, depths
from robots.vision.cameras.depth_image import frame_number, measured_image
from tests.robots.vision.watched_cell import FRONT, PANDA, block, cameras, look, perception_setup, points_seen, scene

_ROOT = Path(__file__).parents[4]
# A camera above a block whose top is at 0.4 m: everything that it measures there is 1.6 m away.
ABOVE = DepthCamera(at=(0.5, 0.0, 2.0), look_at=(0.5, 0.0, 0.0), size_px=(160, 120))
BLOCK = block((0.5, 0.0, 0.2), (0.4, 0.3, 0.4))


def seen_by(camera: DepthCamera, *blocks: object) -> DepthImage:
    """Return the image of a camera above the block."""
    what = scene(BLOCK)
    rig = CameraRig(perception_setup(what, *cameras(front=camera)), repeatable=True)
    return rig.look(look(what)).images[0]


def test_a_block_at_a_known_place_is_measured_to_a_millimetre() -> None:
    points = points_seen(seen_by(ABOVE))
    top = points[points[:, 2] > 0.2]
    assert len(top) > 50
    assert np.abs(top[:, 2] - 0.4).max() < 1e-3
    # Its edges are where they are to a pixel, which is a centimetre here at most.
    assert top[:, :2].max(axis=0) == pytest.approx((0.7, 0.15), abs=0.03)
    assert top[:, :2].min(axis=0) == pytest.approx((0.3, -0.15), abs=0.03)
    floor = points[(np.abs(points[:, 0] - 0.5) > 0.45) | (np.abs(points[:, 1]) > 0.4)]
    assert np.abs(floor[:, 2]).max() < 1e-3


def test_what_is_out_of_range_is_not_measured() -> None:
    image = seen_by(DepthCamera(at=ABOVE.at, look_at=ABOVE.look_at, size_px=ABOVE.size_px, range_m=(0.2, 1.8)))
    depth = depths(image)
    assert {round(d, 2) for d in np.unique(depth).tolist()} == {1.6, math.inf}
    near = depths(seen_by(DepthCamera(at=ABOVE.at, look_at=ABOVE.look_at, size_px=ABOVE.size_px, range_m=(1.8, 3.0))))
    assert {round(d, 2) for d in np.unique(near).tolist()} == {0.0, 2.0}


def test_noise_depends_on_camera_frame_and_seed_alone() -> None:
    camera = camera_of("top", DepthCamera(at=ABOVE.at, look_at=ABOVE.look_at, noise_m=0.002))
    exact = np.full((480, 640), 2.0, dtype=np.float32)

    def image(name: str = "top", frame: int = 3, seed: int = 1) -> bytes:
        named = camera_of(name, DepthCamera(at=ABOVE.at, look_at=ABOVE.look_at, noise_m=0.002))
        one = measured_image(named, exact, intrinsics=camera.intrinsics, time_s=0.3, frame=frame, seed=seed)
        return one.depth_m

    assert image() == image()
    assert len({image(), image(name="left"), image(frame=4), image(seed=2)}) == 4
    depth = np.frombuffer(image(), dtype=np.float32)
    # 2 mm at 1 m are 8 mm at 2 m.
    assert float(depth.std()) == pytest.approx(0.008, rel=0.05)
    assert float(depth.mean()) == pytest.approx(2.0, abs=1e-3)
    assert frame_number(camera, 0.3) == 3


def test_an_unknown_way_to_make_images_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("FLEXCELL_DEPTH", "magic")
    with pytest.raises(CellError, match=r"FLEXCELL_DEPTH is magic \(set it to egl, osmesa or rays\)"):
        CameraRig(perception_setup(scene()), repeatable=True)


def test_an_arm_is_seen_where_the_physics_has_it() -> None:
    what = scene(arms=(PANDA,))
    rig = CameraRig(perception_setup(what, *cameras(front=FRONT)), repeatable=True)
    points = points_seen(rig.look(look(what)).images[0])
    arm = points[points[:, 2] > 0.02]
    # The Panda at home reaches 0.31 m ahead with its flange, and its elbow is below 0.9 m.
    assert len(arm) > 100
    assert arm[:, 2].max() < 0.9
    assert arm[:, 0].max() < 0.7
    assert np.abs(arm[:, 1]).max() < 0.25


@pytest.mark.skipif(find_library("EGL") is None, reason="this machine has no EGL; rays are tested above")
def test_opengl_and_rays_measure_the_same() -> None:
    # In a process of its own: graphics libraries stay out of the process that runs the tests.
    script = """
import json
import numpy as np
from tests.robots.vision.cameras.test_depth_renderer import ABOVE, BLOCK
from tests.robots.vision.watched_cell import PANDA, cameras, look, scene, perception_setup
from robots.vision.cameras.camera import depths
from robots.vision.camera_rig import CameraRig
import robots.vision.cameras.depth_rays as rays, os
rays._STEPS = ()
what = scene(BLOCK, arms=(PANDA,))
seen = []
for kind in ("egl", "rays"):
    os.environ["FLEXCELL_DEPTH"] = kind
    rig = CameraRig(perception_setup(what, *cameras(front=ABOVE)), repeatable=True)
    seen.append(depths(rig.look(look(what)).images[0]))
    rig.close()
both = np.isfinite(seen[0]) & np.isfinite(seen[1])
error = np.abs(seen[0] - seen[1])[both]
print(json.dumps([float(both.mean()), float(np.quantile(error, 0.95)), float((error > 0.01).mean())]))
"""
    environment = {**os.environ, "PYTHONPATH": str(_ROOT), "LP_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, "-P", "-c", script],
        cwd=_ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    share, error_m, edges = json.loads(done.stdout)
    assert share > 0.99
    assert error_m < 1e-3
    # Only pixels on edges may fall to one side or the other.
    assert edges < 0.02
