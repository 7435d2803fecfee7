"""Coverage as an lcov trace file: nodes are functions, exits of nodes are branches."""

from __future__ import annotations

from engine.coverage.coverage_file import BehaviorCoverage
from engine.coverage.line_coverage import CoverageBranch, CoverageLine, FileCoverage, by_file


def lcov_report(coverages: tuple[BehaviorCoverage, ...]) -> str:
    """Return a trace file with one record for each document."""
    return "".join(_record(file) for file in by_file(coverages))


def _record(file: FileCoverage) -> str:
    nodes = [(line.number, node) for line in file.lines for node in line.nodes]
    rows = ["TN:", f"SF:{file.file}"]
    rows += [f"FN:{number},{node.path}" for number, node in nodes]
    rows += [f"FNDA:{node.count},{node.path}" for _, node in nodes]
    rows += [f"FNF:{len(nodes)}", f"FNH:{sum(node.count > 0 for _, node in nodes)}"]
    for line in file.lines:
        rows += [_branch(line, index, branch) for index, branch in enumerate(line.branches)]
    rows += [f"BRF:{file.branches}", f"BRH:{file.branches_taken}"]
    rows += [f"DA:{line.number},{line.hits}" for line in file.lines]
    rows += [f"LF:{len(file.lines)}", f"LH:{file.lines_covered}", "end_of_record"]
    return "\n".join(rows) + "\n"


def _branch(line: CoverageLine, index: int, branch: CoverageBranch) -> str:
    # `-` means that the branch was never evaluated, because its node was never entered.
    return f"BRDA:{line.number},0,{index},{branch.item.count if branch.reached else '-'}"
