"""Coverage as a table for terminals and logs: one line per node, with its missing items below."""

from __future__ import annotations

from engine.coverage.coverage_file import BehaviorCoverage
from engine.coverage.coverage_item import CoverageItem


def text_report(coverages: tuple[BehaviorCoverage, ...]) -> str:
    """Return the table of each behavior, and the total of several behaviors."""
    parts = [_behavior(coverage) for coverage in coverages]
    if len(coverages) > 1:
        rows = [f"{coverage.percent:6.1f} %  {coverage.file}" for coverage in coverages]
        parts.append("\n".join(rows) + "\n")
    return "\n".join(parts)


def _behavior(coverage: BehaviorCoverage) -> str:
    runs = "1 run" if coverage.runs == 1 else f"{coverage.runs} runs"
    lines = [f"{coverage.behavior} ({coverage.file}), {runs}", ""]
    nodes = [item for item in coverage.items if item.kind == "node"]
    of_node: dict[str, list[CoverageItem]] = {node.path: [] for node in nodes}
    for item in coverage.items:
        if item.kind != "node":
            of_node[item.path].append(item)
    width = max(len("node"), *(len(node.path) for node in nodes))
    lines.append(f"{'node':<{width}}  {'entered':>7}  {'exits':>7}")
    for node in nodes:
        out = of_node[node.path]
        taken = sum(item.count > 0 for item in out)
        lines.append(f"{node.path:<{width}}  {node.count:>7}  {f'{taken}/{len(out)}':>7}")
        lines += [f"    {item.place}: {item.label}" for item in _missing(node, out)]
    lines += ["", *_totals(coverage), ""]
    return "\n".join(lines)


def _missing(node: CoverageItem, items: list[CoverageItem]) -> list[CoverageItem]:
    """Return the missing items; for a node that was never entered, only the node."""
    return [item for item in items if not item.count] if node.count else [node]


def _totals(coverage: BehaviorCoverage) -> list[str]:
    seen: dict[str, list[bool]] = {}
    for item in coverage.items:
        seen.setdefault(item.kind, []).append(item.count > 0)
    kinds = ", ".join(f"{sum(counts)} of {len(counts)} {_plural(kind)}" for kind, counts in seen.items())
    return [f"{coverage.percent:.1f} % covered: {kinds}"]


def _plural(kind: str) -> str:
    names = {"status": "statuses", "on_error": "on_error"}
    return names.get(kind, f"{kind}s")
