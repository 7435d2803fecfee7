"""The simulated cameras as a driver delivers their images, with the faults that a test or a demonstration sets."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import msgspec
import numpy as np

from engine.messages import Pose
from engine.messages.sensing import DepthImage
from engine.skills.simulated_world import CameraFault
from robots.model.transform import RigidTransform
from robots.vision.cameras.camera import CameraSpec, Image
from robots.vision.cameras.depth_image import frame_number, measured_image
from robots.vision.cameras.depth_renderer import DepthRenderer

_BRIGHTNESS, _OVEREXPOSED = 0.5, 1.0
_NO_FAULT = CameraFault()


class SimulatedCameras:
    """Delivers one image of a camera at a time.

    Args:
        depth: Renders the present state.
        seed: That of the noise.
    """

    def __init__(self, depth: DepthRenderer, *, seed: int) -> None:
        self._depth = depth
        self._seed = seed
        self._delivered: dict[str, DepthImage] = {}
        self._delayed: dict[str, deque[DepthImage]] = {}

    def image(self, camera: CameraSpec, *, time_s: float, faults: Mapping[str, CameraFault]) -> DepthImage | None:
        """Return the image that a camera delivers now, None if it has none yet."""
        fault = faults.get(camera.name, _NO_FAULT)
        last = self._delivered.get(camera.name)
        if fault.kind == "frozen" and last is not None:
            return msgspec.structs.replace(last, time_s=time_s)
        image = self._taken(camera, fault, time_s)
        if fault.kind == "late":
            queue = self._delayed.setdefault(camera.name, deque())
            queue.append(image)
            while len(queue) > 1 and queue[1].time_s <= time_s - fault.delay_s:
                queue.popleft()
            image = queue[0] if queue[0].time_s <= time_s - fault.delay_s else last
        else:
            self._delayed.pop(camera.name, None)
        if image is not None:
            self._delivered[camera.name] = image
        return image

    def _taken(self, camera: CameraSpec, fault: CameraFault, time_s: float) -> DepthImage:
        image = measured_image(
            camera,
            self._exact(camera, fault),
            intrinsics=self._depth.intrinsics(camera),
            time_s=time_s,
            frame=frame_number(camera, time_s),
            seed=self._seed,
        )
        if fault.kind == "dark":
            nothing = np.zeros(len(image.depth_m) // 4, dtype=np.float32)
            return msgspec.structs.replace(image, depth_m=nothing.tobytes(), brightness=0.0)
        # The light of a depth camera comes back from what covers it.
        brightness = _OVEREXPOSED if fault.kind == "covered" else _BRIGHTNESS
        return msgspec.structs.replace(image, brightness=brightness)

    def _exact(self, camera: CameraSpec, fault: CameraFault) -> Image:
        match fault.kind:
            case "covered":
                lens = self._depth.intrinsics(camera)
                return np.full((lens.height_px, lens.width_px), fault.cover_m, dtype=np.float32)
            case "displaced":
                return self._depth.exact(msgspec.structs.replace(camera, pose=_displaced(camera.pose, fault)))
            case "miscalibrated":
                lens, scale = camera.intrinsics, fault.focal_scale
                real = msgspec.structs.replace(lens, fx_px=scale * lens.fx_px, fy_px=scale * lens.fy_px)
                return self._depth.exact(msgspec.structs.replace(camera, intrinsics=real))
            case _:
                return self._depth.exact(camera)


def _displaced(pose: Pose, fault: CameraFault) -> Pose:
    nominal = RigidTransform.from_pose(pose)
    half = np.array(fault.turn_rad) / 2.0
    angle = float(np.linalg.norm(half))
    axis = half / angle if angle > 0.0 else half
    turn = RigidTransform.of((0.0, 0.0, 0.0), (*(np.sin(angle) * axis), np.cos(angle)))
    turned = nominal.then(turn)
    return RigidTransform(xyz=turned.xyz + np.array(fault.offset_m), xyzw=turned.xyzw).to_pose("world")
