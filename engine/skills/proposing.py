"""A behavior proposed from taught entries, served under `teach`: the entries in order, each with its role."""

from __future__ import annotations

from typing import Annotated, Literal

import msgspec

from engine.messages import Message
from engine.skill import Service

StepKind = Literal["joints", "pose", "trajectory", "dmp", "cart_dmp", "gripper", "action"]
"""The kind of an entry; the name of an `action` is `open` or `close`."""
Role = Literal["via", "approach", "grasp", "release", "depart", "follow", "open", "close"]
"""The role of a step: via point, approach, grasp, release, departure, a motion to follow, or a tool action."""
ToolName = Annotated[str, msgspec.Meta(min_length=1, max_length=64)]
"""The name of a kind of tool."""


class TaughtStep(Message, frozen=True, kw_only=True):
    """An entry or an action of the tool; an omitted `role` is inferred. `part` is the part of a grasp."""

    kind: StepKind
    name: Annotated[str, msgspec.Meta(min_length=1, max_length=128)]
    role: Role | None = None
    part: Annotated[str, msgspec.Meta(max_length=128)] | None = None


class ProposalOptions(Message, frozen=True, kw_only=True):
    """Options of the behavior; every number is the default of one of its parameters.

    `approach_m` is the length of the straight approach to a grasp without a taught approach; `width_m` the width of
    the grasped part, None when unknown: then any part between the fingers counts. `cell` is the path of the
    cell document to be written in the behavior, empty for none.
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
    """A behavior as YAML, with its description in `words`; `steps` have the selected roles and parts.

    `remarks` are notes to read before running it. `arms` and `parts` are the available choices.
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
    """Return the behavior that executes `steps`; nothing is written and nothing moves.

    Fails when an entry is missing, or the order of the steps is invalid.
    """

    steps: Annotated[tuple[TaughtStep, ...], msgspec.Meta(min_length=1, max_length=200)]
    options: ProposalOptions = ProposalOptions()
