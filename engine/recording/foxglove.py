"""What a recording shows in Foxglove without an extension: transforms, joint states, log lines.

The names and fields are Foxglove's own schemas; see https://docs.foxglove.dev/docs/sdk/schemas.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import msgspec

from engine.cause import describe
from engine.event import Event, Exited, Logged, RunEnded, StopRequested, Transitioned
from engine.messages import FramePoses, JointState, SceneDescription
from engine.recording.foxglove_scene import SceneUpdate, scene_update
from engine.recording.foxglove_types import Quaternion, Time, Vector3, time_of

_LEVELS = {"debug": 1, "info": 2, "warning": 3, "error": 4}
ROOT_FRAME = "world"


class Log(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.Log`: one line of the log panel; level 1 debug to 4 error."""

    timestamp: Time
    level: int
    message: str
    name: str
    file: str = ""
    line: int = 0


class FrameTransform(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.FrameTransform`: the pose of a child frame in its parent."""

    timestamp: Time
    parent_frame_id: str
    child_frame_id: str
    translation: Vector3
    rotation: Quaternion


class FrameTransforms(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.FrameTransforms`."""

    transforms: tuple[FrameTransform, ...]


class Joint(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.JointState`: one joint."""

    name: str
    position: float
    velocity: float
    effort: float


class JointStates(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.JointStates`: the joints of one robot."""

    timestamp: Time
    joints: tuple[Joint, ...]


@dataclass(frozen=True, kw_only=True)
class View:
    """One way to show the messages of a topic: `show(message, at_ns)` is a struct of `kind`."""

    prefix: str
    schema_name: str
    kind: type[msgspec.Struct]
    show: Callable[[Any, int], msgspec.Struct]

    def topic(self, source: str) -> str:
        """Return the channel for the messages of the topic `source`."""
        return f"/foxglove/{self.prefix}/{source}"


def log_line(event: Event, at_ns: int) -> Log | None:
    """Return what the log panel shows of an event; None for most."""
    match event:
        case Logged():
            level, name, text = _LEVELS.get(event.level, 2), event.path, event.message
        case Transitioned():
            level, name, text = 2, event.path, f"{event.source}: {event.outcome or 'left'} → {event.target}"
        case Exited(cause=cause) if cause is not None:
            level, name, text = 3, event.path, describe(cause)
        case StopRequested():
            level, name, text = 3, "", f"stop: {event.reason}"
        case RunEnded():
            how = f"{event.status} {event.outcome or ''}".strip()
            level, name, text = (4 if event.status == "errored" else 2), "", how
        case _:
            return None
    return Log(timestamp=time_of(at_ns), level=level, message=text, name=name)


def _transforms(poses: FramePoses, at_ns: int) -> FrameTransforms:
    stamp = time_of(at_ns)
    return FrameTransforms(
        transforms=tuple(
            FrameTransform(
                timestamp=stamp,
                parent_frame_id=ROOT_FRAME,
                child_frame_id=name,
                translation=Vector3(*xyz),
                rotation=Quaternion(*xyzw),
            )
            for name, xyz, xyzw in zip(poses.names, poses.xyz, poses.xyzw, strict=True)
        )
    )


def _joints(state: JointState, at_ns: int) -> JointStates:
    rows = zip(state.names, state.position_rad, state.velocity_rad_s, state.effort_nm, strict=True)
    joints = tuple(Joint(name=name, position=p, velocity=v, effort=e) for name, p, v, e in rows)
    return JointStates(timestamp=time_of(at_ns), joints=joints)


VIEWS: Mapping[type, View] = {
    FramePoses: View(prefix="tf", schema_name="foxglove.FrameTransforms", kind=FrameTransforms, show=_transforms),
    JointState: View(prefix="joints", schema_name="foxglove.JointStates", kind=JointStates, show=_joints),
    SceneDescription: View(prefix="scene", schema_name="foxglove.SceneUpdate", kind=SceneUpdate, show=scene_update),
}
"""How the messages of a type are shown, besides being recorded as they are."""
