"""Two versions on the same configurations."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.errors import FlexcellError
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.results import SweepResults
from engine.sweep.verdict.comparison import Comparison, baseline_versions, compare_with_baseline


def _results(ends: str, *, first: int = 0) -> list[TrialResult]:
    """Return a result for each letter: `+` succeeded, `-` did not."""
    return [
        TrialResult(
            configuration=Configuration(number=number, seed=1000 + number, values={"parameters.luck": number / 7}),
            status="finished",
            success=end == "+",
        )
        for number, end in enumerate(ends, start=first)
    ]


def _compare(tmp_path: Path, before: dict[str, str], now: str, *, margin: float | None = None) -> Comparison:
    with SweepResults.open(tmp_path / "old.db") as old:
        for subject, ends in before.items():
            old.describe(subject, {"behavior": subject, "mujoco": "4"})
            for result in _results(ends):
                old.save(result.configuration.key(subject), subject, result)
        versions = {"behavior": "new", "mujoco": "4"}
        return compare_with_baseline(_results(now), "new", versions, old, confidence=0.95, margin=margin)


def test_runs_are_paired_by_configuration(tmp_path: Path) -> None:
    found = _compare(tmp_path, {"old": "++--+"}, "+-+-")
    pair = found.pair
    assert (pair.both, pair.only_first, pair.only_second, pair.neither, pair.runs) == (1, 1, 1, 1, 4)
    assert found.broken == [1]
    assert (found.baseline, found.changed) == ("old", ["behavior"])


def test_the_version_with_most_of_the_configurations_is_taken(tmp_path: Path) -> None:
    assert _compare(tmp_path, {"older": "+", "old": "+-+"}, "+-+").baseline == "old"


def test_another_version_can_be_chosen(tmp_path: Path) -> None:
    _compare(tmp_path, {"older": "--", "old": "+-+"}, "+-+")
    now = _results("+-+")
    with SweepResults.read(tmp_path / "old.db") as saved:
        known = baseline_versions(now, "new", {"mujoco": "5"}, saved)
        found = compare_with_baseline(now, "new", {}, saved, confidence=0.95, version="older")
    assert [(each.version, each.runs, each.successes) for each in known] == [("old", 3, 2), ("older", 2, 0)]
    assert known[0].changed == ["behavior", "mujoco"]
    assert (found.baseline, found.pair.only_second) == ("older", 1)


def test_the_same_version_is_no_baseline(tmp_path: Path) -> None:
    with pytest.raises(FlexcellError, match="no other version has executed the configurations"):
        _compare(tmp_path, {"new": "+++"}, "+++")


@pytest.mark.parametrize(
    ("before", "now", "margin", "verdict"),
    [
        ("+" * 300, "+" * 300, 0.05, "passed"),
        ("+" * 300, "-" * 60 + "+" * 240, 0.05, "failed"),
        ("+" * 30, "+" * 30, 0.01, "undecided"),
        ("+" * 30, "-" * 30, None, None),
    ],
)
def test_a_margin_decides(tmp_path: Path, before: str, now: str, margin: float | None, verdict: str | None) -> None:
    assert _compare(tmp_path, {"old": before}, now, margin=margin).verdict == verdict
