"""The benchmark of planning measures what it says, small."""

from __future__ import annotations

from benchmarks.planning import measure, peers, random_lines, table
from benchmarks.planning_costs import costs_table, other_costs
from benchmarks.planning_scenes import cases


def test_a_small_run_has_a_line_for_every_planner_and_confirms_what_was_found() -> None:
    case = cases()[0]
    lines = [measure(case, planner, runs=2) for planner in ("fast", "RRTConnect", *peers())]
    assert [line.found for line in lines] == [2] * len(lines)
    assert lines[0].exact == 2
    assert lines[1].document_ms == 33.4
    printed = table(lines)
    assert printed.startswith("### IRB4600, free")
    assert all(f"| {line.planner} | 2/2 |" in printed for line in lines)
    assert [line.found for line in random_lines(2, ("fast",))] == [2]
    costs = other_costs(2)
    assert all(0.0 < p50 <= p95 for p50, p95 in costs.values())
    assert all(f"| {what} |" in costs_table(costs) for what in costs)
