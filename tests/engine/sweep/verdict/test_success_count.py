"""What results prove as they arrive."""

from __future__ import annotations

import random

import pytest

from engine.document.sweep import SweepDocument
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.verdict.success_count import SuccessCount


def _document(**keys: object) -> SweepDocument:
    return SweepDocument(flexcell=1, behavior="b.yaml", **keys)  # pyright: ignore[reportArgumentType]


def _result(number: int, *, success: bool) -> TrialResult:
    configuration = Configuration(number=number, seed=number, values={})
    outcome = "done" if success else "missed"
    return TrialResult(configuration=configuration, status="finished", outcome=outcome, success=success)


def _counted(document: SweepDocument, ends: list[bool], *, planned: int | None = None) -> SuccessCount:
    count = SuccessCount(document, planned if planned is not None else len(ends))
    for number, success in enumerate(ends):
        count.add(_result(number, success=success))
    return count


def test_only_results_without_a_gap_before_them_are_looked_at() -> None:
    count = SuccessCount(_document(), 5)
    for number in (3, 1, 2):
        count.add(_result(number, success=True))
    assert (count.done, count.looked_at, count.rate) == (3, 0, None)
    count.add(_result(0, success=False))
    assert (count.done, count.looked_at, count.successes) == (4, 4, 3)


def test_short_runs_that_arrive_first_do_not_bias_the_rate() -> None:
    """Failures take longer here: in order of arrival the first half of the runs would all succeed."""
    source = random.Random(4)
    ends = [source.random() < 0.5 for _ in range(200)]
    count = SuccessCount(_document(), len(ends))
    arrived = sorted(range(len(ends)), key=lambda number: (not ends[number], number))
    for number in arrived[:100]:
        count.add(_result(number, success=ends[number]))
    assert count.looked_at < 100
    assert count.successes == count.looked_at == next(n for n, end in enumerate(ends) if not end)


@pytest.mark.parametrize(
    ("ends", "verdict"),
    [([True] * 400, "passed"), ([False] * 20, "failed"), ([True] * 20, "undecided"), ([], "undecided")],
)
def test_a_required_rate_is_reached_or_not_or_open(ends: list[bool], verdict: str) -> None:
    count = _counted(_document(require="success >= 0.98"), ends, planned=1000)
    assert count.verdict == verdict
    assert count.is_decided == (verdict != "undecided")


def test_nothing_required_has_no_verdict() -> None:
    assert _counted(_document(), [True]).verdict is None


def test_a_narrow_interval_ends_a_sweep() -> None:
    document = _document(width=0.2)
    assert not _counted(document, [True, False] * 10, planned=1000).is_decided
    assert _counted(document, [True, False] * 200, planned=1000).is_decided


def test_an_exact_interval_waits_for_all_runs() -> None:
    document = _document(interval="exact", require="success >= 0.9")
    part = _counted(document, [True] * 60, planned=61)
    assert (part.interval, part.verdict, part.is_decided) == (None, "undecided", False)
    whole = _counted(document, [True] * 61)
    assert whole.interval is not None
    assert whole.interval.low > 0.9
    assert whole.verdict == "passed"


@pytest.mark.parametrize("design", ["grid", "latin_hypercube", "sobol"])
class TestOtherDesigns:
    def test_a_design_that_is_not_random_has_no_interval(self, design: str) -> None:
        assert _counted(_document(design=design), [True] * 100).interval is None

    def test_its_share_is_compared_when_all_is_done(self, design: str) -> None:
        document = _document(design=design, require="success >= 0.9")
        assert _counted(document, [True] * 9, planned=10).verdict == "undecided"
        assert _counted(document, [False, *[True] * 9]).verdict == "passed"

    def test_it_has_failed_as_soon_as_the_share_cannot_be_reached(self, design: str) -> None:
        document = _document(design=design, require="success >= 0.9")
        assert _counted(document, [False, False], planned=10).verdict == "failed"


@pytest.mark.parametrize(
    ("rate", "expected", "least", "most"),
    # Of 40 sweeps; a rate far from the required one is decided after few runs.
    [(0.5, "failed", 2, 40), (0.9, "failed", 20, 400), (0.9999, "passed", 200, 500)],
)
def test_gates_end_early_where_the_rate_is_far_from_what_is_required(
    rate: float, expected: str, least: int, most: int
) -> None:
    lengths: list[int] = []
    for sweep in range(40):
        source = random.Random(f"{rate} {sweep}")
        count = SuccessCount(_document(require="success >= 0.98"), 5000)
        while not count.is_decided and count.done < 5000:
            count.add(_result(count.done, success=source.random() < rate))
        lengths.append(count.done)
        assert count.verdict == expected
    assert least <= sorted(lengths)[20] <= most
