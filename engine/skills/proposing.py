"""A behavior proposed from what was taught, answered under `teach`: entries in their order, and what each is for."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message
from engine.skill import Service

StepKind = Literal["joints", "pose", "trajectory", "dmp", "cart_dmp", "gripper", "action"]
"""The kind of an entry; of an `action` the name is `open` or `close`."""
Role = Literal["via", "approach", "grasp", "release", "depart", "follow", "open", "close"]
"""What a step is for: a place on the way, one in front of a grasp or release, that itself, one after it; a motion."""
ToolName = Literal["gripper", "hand", "magnet"]


class TaughtStep(Message, frozen=True, kw_only=True):
    """An entry, or an action of the tool; without a `role` it is guessed. `part` is what a grasp takes."""

    kind: StepKind
    name: Annotated[str, msgspec.Meta(min_length=1, max_length=128)]
    role: Role | None = None
    part: Annotated[str, msgspec.Meta(max_length=128)] | None = None


class ProposalOptions(Message, frozen=True, kw_only=True):
    """How the behavior is to work; every number is the default of one of its parameters.

    `approach_m` is the straight way in front of a grasp where no approach was taught; `width_m` the width of what
    is grasped, None where nobody knows it: then whatever is between the fingers counts. `cell` is the path of the
    cell document as the behavior is to name it, empty for none.
    """

    name: Annotated[str, msgspec.Meta(min_length=1, max_length=80)] = "from_demonstration"
    arm: Annotated[str, msgspec.Meta(max_length=64)] = ""
    tool: ToolName | None = None
    speed: Annotated[float, msgspec.Meta(gt=0.0, le=1.0)] = 0.3
    line_speed_m_s: Annotated[float, msgspec.Meta(gt=0.0, le=1.0)] = 0.1
    approach_m: Annotated[float, msgspec.Meta(gt=0.0, le=0.5)] = 0.1
    width_m: Annotated[float, msgspec.Meta(ge=0.0, le=1.0)] | None = None
    cell: Annotated[str, msgspec.Meta(max_length=400)] = ""


class Proposal(Message, frozen=True, kw_only=True):
    """A behavior as YAML, with what it does in `words`; `steps` have the roles and parts that were decided.

    `remarks` are what the reader should know before running it. `arms` and `parts` are what can be chosen from.
    """

    text: str
    steps: tuple[TaughtStep, ...]
    words: tuple[str, ...]
    remarks: tuple[str, ...]
    arm: str
    tool: ToolName
    arms: tuple[str, ...] = ()
    parts: tuple[str, ...] = ()


class ProposeBehavior(Service[Proposal], frozen=True, kw_only=True):
    """Return the behavior that goes through `steps`; nothing is written and nothing moves.

    Fails where an entry is missing, or the steps make no sense in this order.
    """

    steps: Annotated[tuple[TaughtStep, ...], msgspec.Meta(min_length=1, max_length=200)]
    options: ProposalOptions = ProposalOptions()
