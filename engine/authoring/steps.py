"""Steps: nodes as plain data with their source location in Python."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypedDict, Unpack

from engine.authoring.plain_data import to_plain_data
from engine.authoring.source_location import calling_position
from engine.document.nodes.node_kind import AutonomyLevel, PostConditionsSpec
from engine.document.nodes.node_spec import GuardSpec, RetrySpec, TimeoutSpec
from engine.errors import Position


@dataclass(frozen=True, kw_only=True, eq=False)
class TreePart:
    """A node of a behavior tree; composites and decorators are allowed only there."""

    keys: Mapping[str, object] = field(repr=False)
    """Plain data by document key; nested nodes are objects of this class."""
    place: Position


class Step(TreePart):
    """A node that is allowed anywhere: in a machine, a concurrency container, a tree, or at the root."""


class NameKeys(TypedDict, total=False):
    """Additional keys of a guard in a tree."""

    name: str
    description: str
    post: PostConditionsSpec
    disabled: bool | str


class PartKeys(NameKeys, total=False):
    """Keys of every other part of a tree."""

    guard: GuardSpec


class StepKeys(PartKeys, total=False):
    """Common keys of steps, named as in documents."""

    transitions: Mapping[str, str]
    timeout: TimeoutSpec
    retry: RetrySpec
    on_error: str
    autonomy: Mapping[str, AutonomyLevel]
    resume: str
    success: Sequence[str]
    every: float | str


def new_step(kind: str, what: object, **keys: Unpack[StepKeys]) -> Step:
    """Return a step of a kind from the value of its key."""
    place = calling_position()
    return Step(keys={kind: what, **_plain_keys(keys, place)}, place=place)


def new_part(kind: str, what: object, **keys: Unpack[PartKeys]) -> TreePart:
    """Return a composite or decorator from the value of its key."""
    place = calling_position()
    return TreePart(keys={kind: what, **_plain_keys(keys, place)}, place=place)


def with_keys(step: Step, keys: Mapping[str, object]) -> Step:
    """Return the step with more document keys; keys with empty values are omitted."""
    return Step(keys={**step.keys, **{key: value for key, value in keys.items() if value}}, place=step.place)


def given_keys(**keys: object) -> dict[str, object]:
    """Return the keys with a value; None keeps the document default."""
    return {key: value for key, value in keys.items() if value is not None}


def _plain_keys(keys: Mapping[str, object], place: Position) -> dict[str, object]:
    return {key: to_plain_data(value, what=f"`{key}`", where=place) for key, value in keys.items()}
