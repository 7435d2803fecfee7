"""What the tool on an arm measures, and how its kind reports that as a message."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from typing import Protocol, cast

from engine.messages import Message
from robots.sim.grip.tool_summary import ToolSummary
from robots.tool_kinds import load_simulation


@dataclass(frozen=True, kw_only=True)
class ToolReading:
    """The measurement of a tool: three numbers as its kind says, and the names of the touched bodies, "" for none."""

    time_s: float
    values: tuple[float, float, float]
    contacts: tuple[str, ...]


class StatePublisher(Protocol):
    """How a kind of tool reports its measurements on the bus."""

    def state(self, reading: ToolReading, tool: ToolSummary, *, parts: Collection[str]) -> Message:
        """Return the state of a tool, of the type that its kind declares; `parts` are the free parts of the world."""
        ...


def state_publisher(kind: str) -> StatePublisher:
    """Return how a kind of tool reports its measurements."""
    return cast("StatePublisher", load_simulation(kind))
