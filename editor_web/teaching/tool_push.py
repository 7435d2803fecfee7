"""Pushes the tool of a simulated arm, as a hand would."""

from __future__ import annotations

import math

from editor_web.teaching.teaching_messages import PushToolBody
from engine.errors import FlexcellError
from engine.messages import FramePoses, SceneDescription
from engine.project import Session
from engine.skills.arm_control import ArmStatus

MOST_N = 60.0


async def push(backend: Session, request: PushToolBody) -> str:
    """Push the last link of an arm in hand guiding, and return its name.

    Raises:
        FlexcellError: the arm is not in hand guiding, there is no simulated world, or the force exceeds the limit.
    """
    status = backend.latest(f"{request.arm}/status")
    if not isinstance(status, ArmStatus) or status.mode != "guiding":
        raise FlexcellError("the arm is not in hand guiding", where=request.arm, hint="start hand guiding first")
    if math.hypot(*request.force_n) > MOST_N:
        raise FlexcellError(f"the force of a push exceeds the limit of {MOST_N:g} N", where=request.arm)
    body = _last_link(backend, request.arm)
    await backend.bus.call(
        "cell/push_body", {"body": body, "force_n": request.force_n, "duration_s": request.duration_s}
    )
    return body


def _last_link(backend: Session, arm: str) -> str:
    """Return the last moving link of the arm that is drawn, without fingers and pads."""
    scene, poses = backend.latest("cell/scene"), backend.latest("cell/frames")
    if not isinstance(scene, SceneDescription) or not isinstance(poses, FramePoses):
        raise FlexcellError("this cell cannot push bodies", where=arm, hint="use a simulated cell")
    drawn = {geometry.frame for geometry in scene.geometries}
    moving = [name for name in poses.names if name.startswith(f"{arm}/") and name in drawn]
    links = [name for name in moving if "finger" not in name and "pad" not in name]
    if not links:
        raise FlexcellError("this arm has no link to push", where=arm)
    return links[-1]
