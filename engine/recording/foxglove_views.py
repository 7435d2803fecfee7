"""Foxglove views of a recording that need no extension: transforms, joint states, log lines.

The names and fields are Foxglove's own schemas; see https://docs.foxglove.dev/docs/sdk/schemas.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import msgspec

from engine.cause_chain import describe_cause
from engine.event import Event
from engine.messages import FramePoses, JointState, SceneDescription
from engine.recording.foxglove_scene import FoxgloveSceneUpdate, scene_update
from engine.recording.foxglove_types import FoxgloveQuaternion, FoxgloveTime, FoxgloveVector3, time_of
from engine.runtime.history.event_texts import event_text

_LEVELS = {"debug": 1, "info": 2, "warning": 3, "error": 4}
ROOT_FRAME = "world"
_EXITED = "exited"
_LOGGED = frozenset({"log", "transition", "stop", "run_ended", _EXITED})
"""The tags of the events with a line in the log panel; of nodes that exited, those with a cause."""


class FoxgloveLog(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.Log`: one line of the log panel; level 1 debug to 4 error."""

    timestamp: FoxgloveTime
    level: int
    message: str
    name: str
    file: str = ""
    line: int = 0


class FoxgloveFrameTransform(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.FoxgloveFrameTransform`: the pose of a child frame in its parent."""

    timestamp: FoxgloveTime
    parent_frame_id: str
    child_frame_id: str
    translation: FoxgloveVector3
    rotation: FoxgloveQuaternion


class FoxgloveFrameTransforms(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.FoxgloveFrameTransforms`."""

    transforms: tuple[FoxgloveFrameTransform, ...]


class FoxgloveJoint(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.JointState`: one joint."""

    name: str
    position: float
    velocity: float
    effort: float


class FoxgloveJointStates(msgspec.Struct, frozen=True, kw_only=True):
    """`foxglove.FoxgloveJointStates`: the joints of one robot."""

    timestamp: FoxgloveTime
    joints: tuple[FoxgloveJoint, ...]


@dataclass(frozen=True, kw_only=True)
class FoxgloveView:
    """One way to show the messages of a topic: `show(message, at_ns)` is a struct of `kind`."""

    prefix: str
    schema_name: str
    kind: type[msgspec.Struct]
    show: Callable[[Any, int], msgspec.Struct]

    def topic(self, source: str) -> str:
        """Return the channel for the messages of the topic `source`."""
        return f"/foxglove/{self.prefix}/{source}"


def log_line(event: Event, at_ns: int) -> FoxgloveLog | None:
    """Return the log line of an event; None for most events."""
    tag = event.__struct_config__.tag
    if tag not in _LOGGED:
        return None
    shown = event_text(event)
    if tag == _EXITED and shown.cause is None:
        return None
    why = f": {describe_cause(shown.cause)}" if shown.cause is not None else ""
    level = _LEVELS.get(shown.level, 2)
    return FoxgloveLog(timestamp=time_of(at_ns), level=level, message=f"{shown.text}{why}", name=shown.path)


def _transforms(poses: FramePoses, at_ns: int) -> FoxgloveFrameTransforms:
    stamp = time_of(at_ns)
    return FoxgloveFrameTransforms(
        transforms=tuple(
            FoxgloveFrameTransform(
                timestamp=stamp,
                parent_frame_id=ROOT_FRAME,
                child_frame_id=name,
                translation=FoxgloveVector3(*xyz),
                rotation=FoxgloveQuaternion(*xyzw),
            )
            for name, xyz, xyzw in zip(poses.names, poses.xyz, poses.xyzw, strict=True)
        )
    )


def _joints(state: JointState, at_ns: int) -> FoxgloveJointStates:
    rows = zip(state.names, state.position_rad, state.velocity_rad_s, state.effort_nm, strict=True)
    joints = tuple(FoxgloveJoint(name=name, position=p, velocity=v, effort=e) for name, p, v, e in rows)
    return FoxgloveJointStates(timestamp=time_of(at_ns), joints=joints)


VIEWS: Mapping[type, FoxgloveView] = {
    FramePoses: FoxgloveView(
        prefix="tf", schema_name="foxglove.FrameTransforms", kind=FoxgloveFrameTransforms, show=_transforms
    ),
    JointState: FoxgloveView(
        prefix="joints", schema_name="foxglove.JointStates", kind=FoxgloveJointStates, show=_joints
    ),
    SceneDescription: FoxgloveView(
        prefix="scene", schema_name="foxglove.SceneUpdate", kind=FoxgloveSceneUpdate, show=scene_update
    ),
}
"""Views of message types, in addition to the recorded messages themselves."""
