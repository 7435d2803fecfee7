"""What is measured of devices behind their drivers, and the table of it."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from statistics import median

POLL_S = 0.0005


@dataclass(frozen=True, kw_only=True)
class Cycles:
    """The measurements of a control loop during a stream: their intervals, and those that it missed."""

    period_s: float
    p50_s: float
    p99_s: float
    max_s: float
    missed_share: float


@dataclass(kw_only=True)
class Figures:
    """Samples of one device, in seconds and radians; tools have times only."""

    arm: str
    start_s: list[float] = field(default_factory=list[float])
    deviation_rad: list[float] = field(default_factory=list[float])
    cancel_s: list[float] = field(default_factory=list[float])
    cancel_rad: list[float] = field(default_factory=list[float])
    cycles: Cycles | None = None
    cut_named_s: list[float] = field(default_factory=list[float])
    cut_rest_s: list[float] = field(default_factory=list[float])
    reading_again_s: list[float] = field(default_factory=list[float])


def table(measured: Sequence[Figures]) -> str:
    """Return the medians as Markdown, each with its ratio to the first arm."""
    first = measured[0]
    rows: list[tuple[str, Callable[[Figures], list[float]], float, str]] = [
        ("command → motion", lambda each: each.start_s, 1e3, "ms"),
        ("deviation on the path", lambda each: each.deviation_rad, 1e3, "mrad"),
        ("cancel → rest", lambda each: each.cancel_s, 1e3, "ms"),
        ("travel until rest", lambda each: each.cancel_rad, 1e3, "mrad"),
        ("link cut → named", lambda each: each.cut_named_s, 1e3, "ms"),
        ("link cut → rest", lambda each: each.cut_rest_s, 1e3, "ms"),
        ("link restored → reading", lambda each: each.reading_again_s, 1e3, "ms"),
    ]
    lines = [
        "| median (largest) | " + " | ".join(each.arm for each in measured) + " |",
        "|---|" + "---|" * len(measured),
    ]
    for title, values, scale, unit in rows:
        cells = [_cell(values(each), values(first), scale, unit) for each in measured]
        lines.append(f"| {title} | " + " | ".join(cells) + " |")
    cells = [_cycles_cell(each.cycles) for each in measured]
    lines.append("| period: median, 99 %, largest; missed | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def _cell(values: Sequence[float], reference: Sequence[float], scale: float, unit: str) -> str:
    if not values:
        return "–"
    text = f"{median(values) * scale:.1f} ({max(values) * scale:.1f}) {unit}"
    return f"{text}, {median(values) / median(reference):.2f} ×" if reference else text


def _cycles_cell(cycles: Cycles | None) -> str:
    if cycles is None:
        return "–"
    times = ", ".join(f"{value * 1e3:.2f}" for value in (cycles.p50_s, cycles.p99_s, cycles.max_s))
    return f"{times} ms of {cycles.period_s * 1e3:.0f}; {cycles.missed_share:.1%}"


async def until(condition: Callable[[], bool], *, limit_s: float = 60.0) -> None:
    """Return once a condition holds."""
    async with asyncio.timeout(limit_s):
        # What is measured tells nobody that it has changed: it can only be looked at.
        while not condition():  # noqa: ASYNC110
            await asyncio.sleep(POLL_S)
