"""Skills of a simulated world, served under `cell`; a real cell does not have them."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message, Vector3
from engine.skill import Service

LONGEST_PUSH_S = 60.0


class ResetPartsResult(Message, frozen=True, kw_only=True):
    """The parts that were reset; unknown bodies are without names here too."""

    parts: tuple[str, ...]


class ResetParts(Service[ResetPartsResult], frozen=True, kw_only=True):
    """Reset all parts, and the free ones of the unknown bodies, to their initial poses, for the next trial.

    Refused while a run holds a robot or anything moves, so that no behavior can move parts by it.
    """


class PushBodyResult(Message, frozen=True, kw_only=True):
    """The pushed body."""

    body: str


class PushBody(Service[PushBodyResult], frozen=True, kw_only=True):
    """Apply a force to a body for a time, as a hand would: along the world's axes, at a point of the body's frame.

    `body` is `<arm>/<link>` or the name of a part. It replaces the last push at that body. Needs no lease:
    a robot reacts to it as to any external force.
    """

    body: str
    force_n: Vector3
    duration_s: Annotated[float, msgspec.Meta(gt=0.0, le=LONGEST_PUSH_S)]
    at_m: Vector3 = (0.0, 0.0, 0.0)


CameraFaultKind = Literal["none", "covered", "dark", "frozen", "late", "displaced", "miscalibrated"]


class CameraFault(Message, frozen=True, kw_only=True):
    """A fault of a simulated camera.

    `covered`: something is before the lens, at `cover_m`. `dark`: no light. `frozen`: the last image again, with new
    stamps. `late`: images come `delay_s` after their stamps. `displaced`: it stands at `offset_m` (world) from where it
    is calibrated, and is turned by `turn_rad`, a rotation vector in its optical frame. `miscalibrated`: its real
    focal length is `focal_scale` times that of its calibration.
    """

    kind: CameraFaultKind = "none"
    cover_m: Annotated[float, msgspec.Meta(gt=0.0)] = 0.05
    delay_s: Annotated[float, msgspec.Meta(gt=0.0)] = 1.0
    offset_m: Vector3 = (0.0, 0.0, 0.0)
    turn_rad: Vector3 = (0.0, 0.0, 0.0)
    focal_scale: Annotated[float, msgspec.Meta(gt=0.0)] = 1.0


class SetCameraFaultResult(Message, frozen=True, kw_only=True):
    """The camera and the kind of its fault."""

    camera: str
    kind: CameraFaultKind


class SetCameraFault(Service[SetCameraFaultResult], frozen=True, kw_only=True):
    """Give a camera a fault from its next image on; one of the kind `none` ends it. For tests and demonstrations."""

    camera: str
    fault: CameraFault
