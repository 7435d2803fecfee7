"""What the tool of one arm does in a run: how hard it grips, and how far what it holds has slipped."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from robots.port import Array
from robots.sim.grip.mechanics import ToolMechanics
from robots.sim.grip.tool_reading import ToolReading, state_publisher
from robots.sim.grip.tool_summary import ToolSummary
from robots.sim.physics.physics import Physics

_FORCE_MAX_N, _FORCE_MIN_N, _SLIP_M = range(3)
# Progress and the three values of a reading come before the touched bodies.
_VALUES = slice(1, 4)


class ToolMeasures:
    """Looks at the grip of a tool in some steps.

    A part is held where the state of the tool says so; it slips where it moves in the frame of the tool from the end
    of the tool's motion until its next one.

    Args:
        values: Where the measures are kept, in the order of `MeasureLayout`.
        mechanics: The tool in the loop.
        summary: Its summary.
        body: The body of the world in whose frame a held part rests.
        names: The names of all bodies.
        parts: Those of free parts.
        physics: The physics of the world.
    """

    def __init__(
        self,
        values: Array,
        *,
        mechanics: ToolMechanics,
        summary: ToolSummary,
        body: int,
        names: tuple[str, ...],
        parts: Collection[str],
        physics: Physics,
    ) -> None:
        self._values = values
        self._mechanics = mechanics
        self._summary = summary
        self._body = body
        self._names = names
        self._parts = frozenset(parts)
        self._physics = physics
        self._publisher = state_publisher(summary.kind)
        self._held: tuple[int, Array] | None = None
        """The held part, and where it was in the frame of the tool when it was taken."""

    def look(self, time_s: float) -> None:
        """Look at the grip after the step just done."""
        measured = self._mechanics.measured()
        touched = [int(body) for body in measured[_VALUES.stop :]]
        contacts = tuple(self._names[body] if body >= 0 else "" for body in touched)
        first, second, third = measured[_VALUES]
        reading = ToolReading(time_s=time_s, values=(first, second, third), contacts=contacts)
        state = self._publisher.state(reading, self._summary, parts=self._parts)
        held: object = getattr(state, "held", False)
        force_n: object = getattr(state, "force_n", None)
        resting = held is True and not self._mechanics.drive.number
        values = self._values
        if isinstance(force_n, float):
            values[_FORCE_MAX_N] = np.fmax(values[_FORCE_MAX_N], force_n)
            if resting:
                values[_FORCE_MIN_N] = np.fmin(values[_FORCE_MIN_N], force_n)
        part = next((body for body in touched if body >= 0 and self._names[body] in self._parts), None)
        if resting and part is not None:
            self._follow(part)
        else:
            self._held = None

    def let_go(self) -> None:
        """Take note that the tool touches no part."""
        self._held = None

    def _follow(self, part: int) -> None:
        now = self._physics.seen_from(self._body, part)
        if self._held is None or self._held[0] != part:
            self._held = (part, now)
        slip_m = float(np.linalg.norm(now - self._held[1]))
        self._values[_SLIP_M] = np.fmax(self._values[_SLIP_M], slip_m)
