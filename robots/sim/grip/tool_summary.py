"""Summary of the tool on an arm for its port: kind of tool, range, number of contacts."""

from __future__ import annotations

from typing import Protocol, cast

import msgspec

from robots.model.tool_model import ToolModel
from robots.tool_kinds import kind_of_mechanism, load_simulation


class ToolSummary(msgspec.Struct, frozen=True, kw_only=True):
    """A tool as its port sees it; values that a kind does not have are 0.

    `kind` is also the last word of its bus address: `left/gripper`. `contacts` is the number of places with a contact
    measurement, in the order that its kind says: the pads of a gripper are left, then right.
    """

    kind: str
    contacts: int
    max_width_m: float = 0.0
    max_speed_m_s: float = 0.0
    min_force_n: float = 0.0
    max_force_n: float = 0.0
    shortest_time_s: float = 0.0
    """Time to close fully."""


class ToolSummarizer(Protocol):
    """How a kind of tool describes one of its tools."""

    def summary(self, tool: ToolModel) -> ToolSummary:
        """Return the summary of a tool."""
        ...


def tool_summary(tool: ToolModel | None) -> ToolSummary | None:
    """Return the summary of a tool, None for a bare flange."""
    if tool is None:
        return None
    return cast("ToolSummarizer", load_simulation(kind_of_mechanism(tool.kind).name)).summary(tool)
