"""Figures of a search as SVG."""

from __future__ import annotations

from html import escape

from engine.sweep.report.figures import BOTTOM, HEIGHT, LEFT, RIGHT, TOP, WIDTH, frame, limits, place_x, place_y, svg
from engine.sweep.report.words import value_text
from engine.sweep.search.search_summary import SearchSummary
from engine.sweep.search.target import is_failure

_MARK = 4


def margin_trace(summary: SearchSummary) -> str:
    """Return the number that is searched for in each run, the nearest of each batch as a line; crosses failed.

    Nearer to failure is lower, and failing runs are on the line below all others.
    """
    target, results = summary.target, summary.results
    total = max(len(results), 1)
    numbers = [value for each in results if each.success and (value := target.value(each)) is not None]
    least, most = limits(numbers)
    lowest, highest = (least, most) if target.sign > 0.0 else (most, least)

    def height(value: float) -> float:
        # The lowest tenth is where failing runs are.
        return place_y(0.12 + 0.84 * (value - lowest) / (highest - lowest))

    marks: list[str] = []
    for index, result in enumerate(results):
        x = place_x((index + 0.5) / total)
        run = f'data-run="{result.configuration.number}"'
        title = f"<title>#{result.configuration.number}: {escape(result.label)}</title>"
        value = target.value(result) if result.success else None
        if is_failure(result):
            y = place_y(0.04)
            marks.append(f'<path class="bad" {run} d="M{x - _MARK:.1f} {y - _MARK:.1f}l8 8m0 -8l-8 8">{title}</path>')
        elif value is not None:
            marks.append(f'<circle class="good" {run} cx="{x:.1f}" cy="{height(value):.1f}" r="3">{title}</circle>')
    line: list[str] = []
    done = 0
    for batch in summary.batches:
        if batch.nearest is not None:
            line += [f"{place_x(each / total):.1f},{height(batch.nearest):.1f}" for each in (done, done + batch.runs)]
        done += batch.runs
        x = place_x(done / total)
        marks.append(f'<line class="grid" x1="{x:.1f}" x2="{x:.1f}" y1="{TOP}" y2="{HEIGHT - BOTTOM}"/>')
    first = "nearest" if target.guides else "longest"
    caption = f"{escape(target.name)} of each run; the line is the {first} of a batch"
    texts = (
        f'<text x="{LEFT - 6}" y="{height(highest) + 4:.1f}" text-anchor="end">{value_text(highest)}</text>'
        f'<text x="{LEFT - 6}" y="{height(lowest) + 4:.1f}" text-anchor="end">{value_text(lowest)}</text>'
        f'<text x="{LEFT - 6}" y="{place_y(0.04) + 4:.1f}" text-anchor="end">failed</text>'
        f'<text x="{WIDTH - RIGHT}" y="{HEIGHT - 14}" text-anchor="end">{len(results)} runs</text>'
        f'<text x="{LEFT}" y="{HEIGHT - 14}">{caption}</text>'
    )
    body = f'{frame()}{"".join(marks)}<polyline class="rate" points="{" ".join(line)}"/>{texts}'
    label = f"{target.name} in each of {len(results)} runs, {len(summary.failing)} of which failed"
    return svg(body, HEIGHT, label)
