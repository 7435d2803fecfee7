"""Figures of a sweep as SVG: the interval after each run, rates by level with intervals, runs over two factors."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.report.words import interval_text, percent, value_text
from engine.sweep.statistics import rate_interval
from engine.sweep.statistics.effects import FactorEffect
from engine.sweep.summary import MeasureSpread

WIDTH, HEIGHT = 640, 240
LEFT, RIGHT, TOP, BOTTOM = 52, 12, 12, 34
_POINTS = 200
_ROW = 22
_NAMES = 210
_BARS, _BAR_HEIGHT = 24, 110


def convergence(results: Sequence[TrialResult], *, confidence: float, required: float | None) -> str:
    """Return the success rate and its interval after each run, with the required rate as a line."""
    total = len(results)
    at = sorted({max(1, round(total * index / _POINTS)) for index in range(1, _POINTS + 1)})
    sums = _running([result.success for result in results])
    intervals = {n: rate_interval(sums[n - 1], n, confidence=confidence) for n in at}
    upper = " ".join(_point(n / total, intervals[n].high) for n in at)
    lower = " ".join(_point(n / total, intervals[n].low) for n in reversed(at))
    middle = " ".join(_point(n / total, sums[n - 1] / n) for n in at)
    line = _level_line(required) if required is not None else ""
    body = (
        f'{_axes("runs", total)}<polygon class="band" points="{upper} {lower}"/>'
        f'<polyline class="rate" points="{middle}"/>{line}'
    )
    last = intervals[at[-1]]
    return svg(body, HEIGHT, f"Success rate after each of {total} runs; at the end {interval_text(last)}")


def level_rates(effect: FactorEffect, *, rate: float) -> str:
    """Return the success rate of each level of a factor with its interval, beside the rate of all runs."""
    height = TOP + _ROW * len(effect.levels) + 8
    parts: list[str] = []
    span = WIDTH - _NAMES - RIGHT
    for index, level in enumerate(effect.levels):
        y = TOP + _ROW * index + _ROW / 2
        low, high = (_NAMES + span * each for each in level.interval)
        middle = _NAMES + span * level.successes / level.runs
        text = f"{level.successes}/{level.runs}"
        parts.append(
            f'<text x="{_NAMES - 10}" y="{y + 4:.1f}" text-anchor="end">{escape(level.label)} ({text})</text>'
            f'<line class="whisker" x1="{low:.1f}" x2="{high:.1f}" y1="{y:.1f}" y2="{y:.1f}"/>'
            f'<circle class="dot" cx="{middle:.1f}" cy="{y:.1f}" r="4"/>'
        )
    x = _NAMES + span * rate
    parts.append(f'<line class="required" x1="{x:.1f}" x2="{x:.1f}" y1="{TOP}" y2="{height - 8}"/>')
    label = f"Success rate by {effect.address}, with intervals; all runs {percent(rate)}"
    return svg("".join(parts), height, label)


def scatter(results: Sequence[TrialResult], first: str, second: str) -> str:
    """Return the runs over two factors of numbers: dots succeeded, crosses did not."""
    points = [(_number(each, first), _number(each, second), each) for each in results]
    known = [(x, y, each) for x, y, each in points if x is not None and y is not None]
    (least_x, most_x), (least_y, most_y) = limits([x for x, _, _ in known]), limits([y for _, y, _ in known])
    marks: list[str] = []
    # Failures last, so that no success hides one.
    for x, y, each in sorted(known, key=lambda item: not item[2].success):
        px = place_x((x - least_x) / (most_x - least_x))
        py = place_y((y - least_y) / (most_y - least_y))
        title = f"<title>#{each.configuration.number}: {escape(each.label)}</title>"
        if each.success:
            marks.append(f'<circle class="good" cx="{px:.1f}" cy="{py:.1f}" r="3">{title}</circle>')
        else:
            marks.append(f'<path class="bad" d="M{px - 4:.1f} {py - 4:.1f}l8 8m0 -8l-8 8">{title}</path>')
    ends = (
        f'<text x="{LEFT}" y="{HEIGHT - 18}">{value_text(least_x)}</text>'
        f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 18}" text-anchor="end">{value_text(most_x)}</text>'
        f'<text x="{WIDTH / 2}" y="{HEIGHT - 4}" text-anchor="middle">{escape(first)}</text>'
        f'<text x="{LEFT + 6}" y="{TOP + 14}">{escape(second)}</text>'
        f'<text x="{LEFT - 6}" y="{HEIGHT - BOTTOM}" text-anchor="end">{value_text(least_y)}</text>'
        f'<text x="{LEFT - 6}" y="{TOP + 10}" text-anchor="end">{value_text(most_y)}</text>'
    )
    return svg(frame() + ends + "".join(marks), HEIGHT, f"Runs by {first} and {second}: crosses did not succeed")


def histogram(results: Sequence[TrialResult], spread: MeasureSpread) -> str:
    """Return how often a measure has which values: runs that failed stand on those that succeeded."""
    least, most = spread.least, spread.most
    good, bad = [0] * _BARS, [0] * _BARS
    for each in results:
        value = each.measures.get(spread.name)
        if value is not None:
            bars = good if each.success else bad
            bars[min(int((value - least) / (most - least) * _BARS), _BARS - 1)] += 1
    highest = max(map(sum, zip(good, bad, strict=True)))
    width = (WIDTH - LEFT - RIGHT) / _BARS
    full, floor = _BAR_HEIGHT - TOP - BOTTOM, _BAR_HEIGHT - BOTTOM
    bars_drawn: list[str] = []
    for index, (successes, failures) in enumerate(zip(good, bad, strict=True)):
        x, foot = LEFT + width * index, float(floor)
        for kind, runs in (("good", successes), ("bad", failures)):
            height = full * runs / highest
            foot -= height
            if runs:
                bars_drawn.append(
                    f'<rect class="{kind}" x="{x + 1:.1f}" y="{foot:.1f}" width="{width - 2:.1f}" '
                    f'height="{height:.1f}"><title>{runs} runs</title></rect>'
                )
    ends = (
        f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{floor}" y2="{floor}"/>'
        f'<text x="{LEFT - 6}" y="{TOP + 10}" text-anchor="end">{highest}</text>'
        f'<text x="{LEFT}" y="{floor + 18}">{value_text(least)}</text>'
        f'<text x="{WIDTH - RIGHT}" y="{floor + 18}" text-anchor="end">{value_text(most)}</text>'
    )
    label = f"Runs by {spread.name}, from {value_text(least)} to {value_text(most)}; those that failed are on top"
    return svg("".join(bars_drawn) + ends, _BAR_HEIGHT, label)


def _running(successes: Sequence[bool]) -> list[int]:
    sums: list[int] = []
    total = 0
    for success in successes:
        total += success
        sums.append(total)
    return sums


def _number(result: TrialResult, address: str) -> float | None:
    value = result.configuration.values.get(address)
    return float(value) if isinstance(value, int | float) and not isinstance(value, bool) else None


def limits(numbers: Sequence[float]) -> tuple[float, float]:
    """Return the ends of an axis for some numbers, never equal."""
    least, most = (min(numbers), max(numbers)) if numbers else (0.0, 1.0)
    return (least, most) if least < most else (least - 0.5, most + 0.5)


def place_x(share: float) -> float:
    """Return where a share of the horizontal axis is."""
    return LEFT + (WIDTH - LEFT - RIGHT) * share


def place_y(share: float) -> float:
    """Return where a share of the vertical axis is."""
    return HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * share


def _point(x: float, y: float) -> str:
    return f"{place_x(x):.1f},{place_y(y):.1f}"


def frame() -> str:
    """Return the border of a figure."""
    return f'<rect class="frame" x="{LEFT}" y="{TOP}" width="{WIDTH - LEFT - RIGHT}" height="{HEIGHT - TOP - BOTTOM}"/>'


def _axes(name: str, most: int) -> str:
    ticks = "".join(
        f'<text x="{LEFT - 6}" y="{place_y(share) + 4:.1f}" text-anchor="end">{100 * share:g} %</text>'
        f'<line class="grid" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{place_y(share):.1f}" y2="{place_y(share):.1f}"/>'
        for share in (0.0, 0.25, 0.5, 0.75, 1.0)
    )
    end = f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 14}" text-anchor="end">{most} {escape(name)}</text>'
    return frame() + ticks + end


def _level_line(rate: float) -> str:
    y = place_y(rate)
    return f'<line class="required" x1="{LEFT}" x2="{WIDTH - RIGHT}" y1="{y:.1f}" y2="{y:.1f}"/>'


def svg(body: str, height: int, label: str) -> str:
    """Return a figure; `label` is its text for those who cannot see it."""
    return f'<svg viewBox="0 0 {WIDTH} {height}" role="img" aria-label="{escape(label, quote=True)}">{body}</svg>'
