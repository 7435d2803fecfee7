"""Prints what differs between two runs, and the trend of a behavior."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from datetime import UTC, datetime

from rich.console import Console
from rich.table import Column, Table

from engine.archive import PastRun, RunComparison, RunTrend, Visit, is_different

_PIPE_WIDTH = 200
_ROUNDED_S = 0.0005
"""Durations that differ by less are printed as equal."""


def print_comparison(comparison: RunComparison) -> None:
    """Print a comparison for people."""
    console = _console()
    for side, run in (("left ", comparison.left), ("right", comparison.right)):
        console.print(f"{side} {_run_text(run)}")
    divergence = comparison.divergence
    if divergence is None:
        console.print("no divergence: the same nodes ended in the same way")
    else:
        times = [
            f"{side} at {at_s:.3f} s"
            for side, at_s in (("left", divergence.left_s), ("right", divergence.right_s))
            if at_s is not None
        ]
        console.print(f"first divergence: {divergence.text} ({', '.join(times)})")
    _print_lines(console, "settings:", [f"{each.at}: {_values(each.left, each.right)}" for each in comparison.settings])
    for document in comparison.documents:
        _print_lines(console, f"document {document.name}:", document.lines)
    _print_durations(console, comparison)
    _print_lines(console, "visits that differ:", list(_different(comparison)))
    data = [f"{each.path} {each.kind} {each.at}: {_values(each.left, each.right)}" for each in comparison.data]
    more = [f"and {comparison.data_left_out} more"] if comparison.data_left_out else []
    _print_lines(console, "values that differ:", [*data, *more])


def print_trend(trend: RunTrend) -> None:
    """Print a trend for people."""
    console = _console()
    console.print(f"{trend.behavior}: {trend_text(trend)}")
    if trend.duration is None:
        return
    table = Table(
        Column("node", no_wrap=True),
        *(
            Column(name, justify="right")
            for name in ("runs", "median s", "quartiles s", "least s", "most s", "latest s")
        ),
        box=None,
    )
    for name, spread in (("run", trend.duration), *((each.path, each) for each in trend.nodes)):
        table.add_row(
            name,
            str(spread.count),
            f"{spread.median_s:.3f}",
            f"{spread.lower_s:.3f} to {spread.upper_s:.3f}",
            f"{spread.least_s:.3f}",
            f"{spread.most_s:.3f}",
            "" if spread.last_s is None else f"{spread.last_s:.3f}",
        )
    console.print(table)


def trend_text(trend: RunTrend) -> str:
    """Return the counts of a trend as one line."""
    others = [
        f"{count} {text}"
        for count, text in ((trend.failed, "failed"), (trend.stopped, "stopped"), (trend.not_ended, "not ended"))
        if count
    ]
    shown = len(trend.runs)
    of = f", the latest of {trend.known}" if trend.known > shown else ""
    return ", ".join([f"{trend.succeeded} of {shown} runs succeeded", *others]) + of


def _console() -> Console:
    # In a pipe no text is wrapped or truncated: the reader searches for whole words.
    width = None if sys.stdout.isatty() else _PIPE_WIDTH
    return Console(width=width, soft_wrap=True, highlight=False, markup=False)


def _run_text(run: PastRun) -> str:
    started = datetime.fromtimestamp(run.started_at_s, UTC).strftime("%Y-%m-%d %H:%M:%S")
    ended = f" with {run.outcome}" if run.outcome else ""
    cause = f": {run.cause}" if run.cause else ""
    return f"{run.id}: {run.behavior}, started {started} UTC, {run.status}{ended} after {run.duration_s:.3f} s{cause}"


def _values(left: str | None, right: str | None) -> str:
    return f"{left or 'nothing'} → {right or 'nothing'}"


def _print_lines(console: Console, title: str, lines: Sequence[str]) -> None:
    if lines:
        console.print(title)
    for line in lines:
        console.print(f"  {line}")


def _print_durations(console: Console, comparison: RunComparison) -> None:
    table = Table(
        Column("node", no_wrap=True),
        *(Column(name, justify="right") for name in ("visits", "left s", "right s", "difference s")),
        box=None,
    )
    for each in comparison.nodes:
        same = each.visits_left == each.visits_right
        difference_s = each.duration_right_s - each.duration_left_s
        table.add_row(
            each.path,
            str(each.visits_left) if same else f"{each.visits_left} → {each.visits_right}",
            f"{each.duration_left_s:.3f}" if each.visits_left else "",
            f"{each.duration_right_s:.3f}" if each.visits_right else "",
            f"{difference_s:+.3f}" if abs(difference_s) >= _ROUNDED_S else "",
        )
    console.print("durations:")
    console.print(table)


def _different(comparison: RunComparison) -> Iterable[str]:
    for each in comparison.visits:
        if is_different(each):
            yield f"{each.path}: {_visit_text(each.left)} → {_visit_text(each.right)}"
    if comparison.left_out:
        yield f"{comparison.left_out} visits are not listed"


def _visit_text(visit: Visit | None) -> str:
    if visit is None:
        return "nothing"
    how = visit.outcome or visit.status
    return f"visit {visit.visit} {how}" + (f" ({visit.cause})" if visit.cause else "")
