"""Which measures a world has, and where each lies among its numbers."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from engine.measures import ARM_MEASURES
from engine.messages.measures import Measure
from robots.port import Array

_CELL = (
    Measure(name="contacts", unit="", reduction="sum"),
    Measure(name="contact_s", unit="s", reduction="sum"),
    Measure(name="contact_force_max_n", unit="N", reduction="largest"),
)
_CLEARANCE = Measure(name="clearance_min_m", unit="m", reduction="least")
_JUMPS = Measure(name="set_point_jumps", unit="", reduction="sum")
_TOOL = (
    Measure(name="force_max_n", unit="N", reduction="largest"),
    Measure(name="force_min_n", unit="N", reduction="least"),
    Measure(name="slip_max_m", unit="m", reduction="largest"),
)


class MeasureLayout:
    """The measures of a world in one array: those of the cell, then of each arm and of its tool.

    NaN is what a run has nothing of: the grip force where nothing was held, the clearance of what nothing can touch.

    Args:
        tools: The kind of tool of each arm, None for a bare flange.
    """

    def __init__(self, tools: Mapping[str, str | None]) -> None:
        measures: list[Measure] = []
        self.contacts = _add(measures, "cell", _CELL)
        self.cell_clearance = _add(measures, "cell", (_CLEARANCE,)).start
        self.arms: dict[str, slice] = {}
        self.clearances: dict[str, int] = {}
        self.jumps: dict[str, int] = {}
        self.tools: dict[str, slice] = {}
        for arm, kind in tools.items():
            self.arms[arm] = _add(measures, arm, ARM_MEASURES)
            self.clearances[arm] = _add(measures, arm, (_CLEARANCE,)).start
            self.jumps[arm] = _add(measures, arm, (_JUMPS,)).start
            if kind is not None:
                self.tools[arm] = _add(measures, f"{arm}.{kind}", _TOOL)
        self.measures = tuple(measures)
        self.size = len(measures)

    def new_values(self) -> Array:
        """Return the values of a world in which nothing has happened, (`size`,)."""
        values = np.zeros(self.size)
        for tool in self.tools.values():
            values[tool] = np.nan
        values[[self.cell_clearance, *self.clearances.values()]] = np.nan
        return values

    def read(self, values: Array) -> dict[str, float]:
        """Return the values by name, without those that a run has nothing of."""
        pairs = zip(self.measures, values.tolist(), strict=True)
        return {measure.name: value for measure, value in pairs if value == value}  # noqa: PLR0124 - NaN is not itself


def _add(measures: list[Measure], owner: str, kinds: tuple[Measure, ...]) -> slice:
    first = len(measures)
    measures.extend(Measure(name=f"{owner}.{kind.name}", unit=kind.unit, reduction=kind.reduction) for kind in kinds)
    return slice(first, len(measures))
