"""What a node is entered with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from engine.point import Point
from engine.state import State


@dataclass(frozen=True)
class Entry:
    """What a node was entered with: the state to run, its input values, and both as plain data.

    `point` says where to go on inside a container that was entered before.
    """

    state: State | None = None
    inputs: Mapping[str, object] = field(default_factory=dict[str, object])
    shown: dict[str, object] = field(default_factory=dict[str, object])
    point: Point | None = None


NOTHING = Entry()
