"""Leading an arm by hand, and recording where it is led; answered under the arm's name (RCL 4.1.2, RCY 7.1)."""

from __future__ import annotations

from typing import Annotated

import msgspec

from engine.messages import Message, Pose
from engine.skill import Action, Service

SamplePeriod = Annotated[
    float, msgspec.Meta(ge=0.002, le=1.0, description="Time between two samples", extra_json_schema={"unit": "s"})
]
GuideDuration = Annotated[float, msgspec.Meta(gt=0.0, description="End after so long", extra_json_schema={"unit": "s"})]
DampingShare = Annotated[
    float, msgspec.Meta(ge=0.0, le=1.0, description="Share of the nominal damping that is left in the joints")
]


class GuideFeedback(Message, frozen=True, kw_only=True):
    """Where the arm is led, and how many samples are recorded."""

    joints: tuple[float, ...]
    pose: Pose
    samples: int


class GuideResult(Message, frozen=True, kw_only=True):
    """Where the arm was left; `samples` over `duration_s` are in the entry of kind `trajectory` named `entry`.

    `entry` is empty when nothing was to be recorded, or when the goal was cancelled.
    """

    joints: tuple[float, ...]
    pose: Pose
    samples: int
    duration_s: float
    entry: str = ""


class GuideArm(Action[GuideResult, GuideFeedback], frozen=True, kw_only=True):
    """Let the arm float in gravity compensation so that it can be led by hand; it then holds where it was left.

    Ends by FinishGuiding, after `duration_s`, or when cancelled. With `record` the joints, the tool's
    poses and the wrench on it are sampled every `sample_s` and written to the store under that name,
    replacing what is there. Time in which the goal is held is left out.
    """

    damping: DampingShare = 0.1
    duration_s: GuideDuration | None = None
    record: str = ""
    sample_s: SamplePeriod = 0.01


class FinishGuidingResult(Message, frozen=True, kw_only=True):
    """The arm holds itself again."""

    joints: tuple[float, ...]


class FinishGuiding(Service[FinishGuidingResult], frozen=True, kw_only=True):
    """End the guiding under way, whoever began it, also a paused one; return when the arm holds itself."""
