"""Coverage of behaviors: nodes, outcomes, transitions and conditions that a set of runs has executed.

`Coverage(behavior, catalogue)` counts: give `follow()` to `Run.watch`, or a whole event log to `add`.
`missing` and `percent` are the result, `accumulate(file)` adds it to a file, and `engine.coverage.report`
formats files as text, HTML, Cobertura XML, lcov or JSON.
"""

from engine.coverage.coverage_collector import CoverageCollector
from engine.coverage.coverage_file import BehaviorCoverage, merge, read_coverage, write_coverage
from engine.coverage.coverage_item import CoverageItem, ItemKind
from engine.coverage.covered_items import CoverageRuns, CoveredItems

__all__ = [
    "BehaviorCoverage",
    "CoverageCollector",
    "CoverageItem",
    "CoverageRuns",
    "CoveredItems",
    "ItemKind",
    "merge",
    "read_coverage",
    "write_coverage",
]
