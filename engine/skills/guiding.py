"""Hand guiding of an arm and its recording, served under the arm's name (RCL 4.1.2, RCY 7.1)."""

from __future__ import annotations

from typing import Annotated, ClassVar

import msgspec

from engine.messages import Message, Pose
from engine.skill import Action, Capability, Service
from engine.skills.collision_options import CollisionOptions, PathCollisions

SamplePeriod = Annotated[
    float, msgspec.Meta(ge=0.002, le=1.0, description="Time between two samples", extra_json_schema={"unit": "s"})
]
GuideDuration = Annotated[float, msgspec.Meta(gt=0.0, description="Duration", extra_json_schema={"unit": "s"})]
DampingShare = Annotated[float, msgspec.Meta(ge=0.0, le=1.0, description="Fraction of the nominal joint damping")]


class GuideFeedback(Message, frozen=True, kw_only=True):
    """The present configuration and pose of the arm, and the number of recorded samples.

    `held_by` is the contact before which the arm was brought to rest; empty once it moves freely again.
    """

    joints: tuple[float, ...]
    pose: Pose
    samples: int
    held_by: str = ""


class GuideResult(Message, frozen=True, kw_only=True):
    """The final configuration; `samples` over `duration_s` are in the entry `entry` of kind `trajectory`.

    `entry` is empty without a recording, or when the goal was cancelled.
    """

    joints: tuple[float, ...]
    pose: Pose
    samples: int
    duration_s: float
    entry: str = ""


class GuideArm(Action[GuideResult, GuideFeedback], frozen=True, kw_only=True):
    """Put the arm into gravity compensation for hand guiding; afterwards it holds its final configuration.

    Ends by FinishGuiding, after `duration_s`, or when cancelled. With `record` the joints, the tool's
    poses and the wrench on the tool are sampled every `sample_s` and written to the store under that name,
    replacing an existing entry. Time in which the goal is held is not recorded. Before another arm, or a fixture or
    part that a link above the tool would touch, the arm is brought to rest and is then compliant again. The tool may
    touch fixtures and parts, and what the cameras see is no obstacle: it is the person at the arm.
    """

    capability: ClassVar[Capability] = "guide"

    damping: DampingShare = 0.1
    duration_s: GuideDuration | None = None
    record: str = ""
    sample_s: SamplePeriod = 0.01
    collisions: PathCollisions = CollisionOptions()


class FinishGuidingResult(Message, frozen=True, kw_only=True):
    """The arm holds its configuration again."""

    joints: tuple[float, ...]


class FinishGuiding(Service[FinishGuidingResult], frozen=True, kw_only=True):
    """End the active guiding of any sender, also a paused one; return when the arm holds its configuration."""

    capability: ClassVar[Capability] = "guide"
