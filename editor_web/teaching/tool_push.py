"""Pushes at the tool of a simulated arm, as a hand would."""

from __future__ import annotations

import math

from editor_web.contracts.backend import Backend
from editor_web.teaching.teaching_messages import PushToolBody
from engine.errors import FlexcellError
from engine.messages import FramePoses, SceneDescription
from engine.skills.arm_control import ArmStatus

MOST_N = 60.0


async def push(backend: Backend, request: PushToolBody) -> str:
    """Push at the last link of an arm that floats, and return its name.

    Raises:
        FlexcellError: it does not float, there is no simulated world, or nobody pushes so hard.
    """
    status = backend.latest(f"{request.arm}/status")
    if not isinstance(status, ArmStatus) or status.mode != "guiding":
        raise FlexcellError("the arm holds itself", where=request.arm, hint="let it float first")
    if math.hypot(*request.force_n) > MOST_N:
        raise FlexcellError(f"a push is {MOST_N:g} N at most", where=request.arm)
    body = _last_link(backend, request.arm)
    await backend.bus.call(
        "cell/push_body", {"body": body, "force_n": request.force_n, "duration_s": request.duration_s}
    )
    return body


def _last_link(backend: Backend, arm: str) -> str:
    """Return the moving body of the arm that is drawn last: its hand, or the fingers' holder."""
    scene, poses = backend.latest("cell/scene"), backend.latest("cell/frames")
    if not isinstance(scene, SceneDescription) or not isinstance(poses, FramePoses):
        raise FlexcellError("nobody can push here", where=arm, hint="this is for simulated cells")
    drawn = {geometry.frame for geometry in scene.geometries}
    moving = [name for name in poses.names if name.startswith(f"{arm}/") and name in drawn]
    links = [name for name in moving if "finger" not in name and "pad" not in name]
    if not links:
        raise FlexcellError("this arm has no body to push at", where=arm)
    return links[-1]
