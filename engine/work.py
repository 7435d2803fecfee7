"""What a node does between entering and leaving, and what it is entered with."""

from __future__ import annotations

from collections.abc import Coroutine, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

from engine.execution import Execution
from engine.point import Point
from engine.state import Outcome, State
from engine.userdata import Scope

if TYPE_CHECKING:
    from engine.node import Node


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


class Work(Protocol):
    """What a node does between entering and leaving."""

    @property
    def kind(self) -> str:
        """The key of the node in documents."""
        ...

    @property
    def children(self) -> Mapping[str, Node]:
        """The nodes directly inside, by name, in document order."""
        ...

    @cached_property
    def nominal(self) -> frozenset[str]:
        """The outcomes that mean that nothing went wrong inside; asked at every transition."""
        ...

    @cached_property
    def outcomes(self) -> tuple[str, ...]:
        """All outcomes it can have."""
        ...

    def initial_values(self, inputs: Mapping[str, object]) -> Mapping[str, object]:
        """Return the values that its own scope begins with when it is entered with `inputs`."""
        ...

    @property
    def constant(self) -> Entry | None:
        """What it is entered with whatever the values of its scope; None where that depends on them."""
        ...

    def enter(self, scope: Scope) -> Entry:
        """Evaluate what it is entered with; raises FlexcellError when that cannot be had."""
        ...

    def run(
        self, entry: Entry, path: str, visit: int, scope: Scope, execution: Execution
    ) -> Coroutine[Any, Any, Outcome]:
        """Do it."""
        ...
