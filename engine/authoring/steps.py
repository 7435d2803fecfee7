"""What the functions of this package make: nodes as plain data with the place in Python that made them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypedDict, Unpack

from engine.authoring.plain_data import to_plain_data
from engine.authoring.source_location import calling_position
from engine.document.node_kind import PostConditionsSpec
from engine.document.node_spec import AutonomyLevel, GuardSpec, NodeKind, RetrySpec, TimeoutSpec
from engine.errors import Position


@dataclass(frozen=True, kw_only=True, eq=False)
class TreePart:
    """A node of a behavior tree; composites and decorators stand nowhere else."""

    keys: Mapping[str, object] = field(repr=False)
    """Document keys to plain data, in which nodes stand as objects of this class."""
    place: Position


class Step(TreePart):
    """A node that can stand anywhere: in a machine, side by side with others, in a tree, at the root."""


class NameKeys(TypedDict, total=False):
    """What a guard of a tree may be given beside its own."""

    name: str
    description: str
    post: PostConditionsSpec


class PartKeys(NameKeys, total=False):
    """What every other part of a tree may be given."""

    guard: GuardSpec


class StepKeys(PartKeys, total=False):
    """What every step may be given, named as in documents."""

    transitions: Mapping[str, str]
    timeout: TimeoutSpec
    retry: RetrySpec
    on_error: str
    autonomy: Mapping[str, AutonomyLevel]
    resume: str
    success: Sequence[str]
    every: float | str


def new_step(kind: NodeKind, what: object, **keys: Unpack[StepKeys]) -> Step:
    """Make a step of a kind from the value under its key."""
    place = calling_position()
    return Step(keys={kind: what, **_plain_keys(keys, place)}, place=place)


def new_part(kind: NodeKind, what: object, **keys: Unpack[PartKeys]) -> TreePart:
    """Make a composite or decorator from the value under its key."""
    place = calling_position()
    return TreePart(keys={kind: what, **_plain_keys(keys, place)}, place=place)


def with_keys(step: Step, keys: Mapping[str, object]) -> Step:
    """Return the step with more document keys, those with empty values left out."""
    return Step(keys={**step.keys, **{key: value for key, value in keys.items() if value}}, place=step.place)


def given_keys(**keys: object) -> dict[str, object]:
    """Return the keys that were given a value; what is None keeps the default of documents."""
    return {key: value for key, value in keys.items() if value is not None}


def _plain_keys(keys: Mapping[str, object], place: Position) -> dict[str, object]:
    return {key: to_plain_data(value, what=f"`{key}`", where=place) for key, value in keys.items()}
