"""Skills of a gripper with two fingers, served under `<arm>/gripper` (RCY 4.1, LUT 4.4, WLK)."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec
from msgspec import UNSET, UnsetType

from engine.messages import GripperState, HoldEvidence, Message
from engine.skill import Action, Capability, Service

Width = Annotated[float, msgspec.Meta(ge=0.0, description="Opening between the pads", extra_json_schema={"unit": "m"})]
FingerSpeed = Annotated[
    float, msgspec.Meta(gt=0.0, description="Speed of the opening", extra_json_schema={"unit": "m/s"})
]


class GripperSetting(Message, frozen=True, kw_only=True):
    """The taught setting of a gripper: `held` a part `width_m` wide, or was open by that width.

    `force_n` is the grasp force, 0 when unknown.
    """

    width_m: Annotated[float, msgspec.Meta(ge=0.0, le=10.0)]
    held: bool
    force_n: Annotated[float, msgspec.Meta(ge=0.0, le=1000.0)] = 0.0


class GripperFeedback(Message, frozen=True, kw_only=True):
    """The measured opening during the motion."""

    width_m: float


class GraspResult(Message, frozen=True, kw_only=True):
    """Whether the fingers hold a part, judged from pad contact and their final opening.

    `reason` is why nothing is held; it is empty when `held`. `start` is the setting of the gripper before,
    when known. `part` is the name of the held part, `?` when unknown, and `by` what tells it, where the tool says so.
    """

    held: bool
    width_m: float
    force_n: float
    reason: str = ""
    start: GripperSetting | UnsetType = UNSET
    part: str | UnsetType = UNSET
    by: HoldEvidence | UnsetType = UNSET


class GripperOpen(Action[GraspResult, GripperFeedback], frozen=True, kw_only=True):
    """Open fully."""

    capability: ClassVar[Capability] = "gripper"

    speed_m_s: FingerSpeed = 0.1


class GripperMove(Action[GraspResult, GripperFeedback], frozen=True, kw_only=True):
    """Move the fingers to an opening without a part."""

    capability: ClassVar[Capability] = "gripper"

    width_m: Width
    speed_m_s: FingerSpeed = 0.1


class GripperGrasp(Action[GraspResult, GripperFeedback], frozen=True, kw_only=True):
    """Close until the fingers stop and press with `force_n`.

    Succeeds as an action whether or not a part is held, see `GraspResult.held`. Held means
    that both pads touch and the final opening is within `width_m` -/+ the tolerances.
    """

    capability: ClassVar[Capability] = "gripper"

    width_m: Width
    force_n: Annotated[float, msgspec.Meta(gt=0.0, le=1000.0, description="Grasp force in newton")] = 20.0
    speed_m_s: FingerSpeed = 0.05
    tolerance_inner_m: float = 0.01
    tolerance_outer_m: float = 0.01


class ReadGripper(Service[GripperState], frozen=True, kw_only=True):
    """Return the measured state of the gripper."""

    capability: ClassVar[Capability] = "gripper"
