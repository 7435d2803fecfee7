"""What results prove about one or several requirements."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.document.sweep import Sweep, SweepDocument, parse_sweep
from engine.errors import FlexcellError
from engine.sweep.design.configuration import Configuration
from engine.sweep.execution.trial_result import TrialResult
from engine.sweep.statistics import rate_interval
from engine.sweep.verdict.judged_requirement import require_known_numbers, share_interval
from engine.sweep.verdict.success_count import SuccessCount

FORCE = "share(cell.contact_force_max_n <= 30) >= 0.9"


def _sweep(*required: str, **keys: object) -> Sweep:
    written = "".join(f"{name}: {value}\n" for name, value in keys.items())
    text = f"flexcell: 1\nbehavior: b.yaml\nrequire: {list(required)}\n{written}"
    return parse_sweep(text, file="s.yaml")


def _document(*required: str, **keys: object) -> SweepDocument:
    return _sweep(*required, **keys).document


def _result(number: int, force_n: float | None, *, success: bool = True) -> TrialResult:
    return TrialResult(
        configuration=Configuration(number=number, seed=number, values={}),
        status="finished",
        outcome="done" if success else "missed",
        success=success,
        measures={"cell.contact_force_max_n": force_n} if force_n is not None else {},
    )


def _counted(document: SweepDocument, forces_n: Sequence[float | None], *, planned: int = 1000) -> SuccessCount:
    count = SuccessCount(document, planned)
    for number, force_n in enumerate(forces_n):
        count.add(_result(number, force_n))
    return count


@pytest.mark.parametrize(
    ("forces_n", "verdict"), [([30.0] * 100, "passed"), ([30.1] * 10, "failed"), ([1.0] * 10, "undecided")]
)
def test_a_share_of_runs_is_judged_by_the_interval_of_a_success_rate(
    forces_n: list[float | None], verdict: str
) -> None:
    count = _counted(_document(FORCE), forces_n)
    (judged,) = count.requirements
    assert (count.verdict, judged.verdict, count.is_decided) == (verdict, verdict, verdict != "undecided")
    assert judged.interval == rate_interval(judged.kept, len(forces_n))


def test_a_run_without_the_number_does_not_keep_the_limit() -> None:
    """Its process may have crashed before the force was read."""
    (judged,) = _counted(_document(FORCE), [None] * 10 + [1.0] * 2).requirements
    assert (judged.kept, judged.missing, judged.runs, judged.verdict) == (2, 10, 12, "failed")


def test_a_run_whose_process_ended_keeps_no_limit_of_time() -> None:
    count = SuccessCount(_document("share(duration_s <= 30) >= 0.5"), 2)
    count.add(TrialResult(configuration=Configuration(number=0, seed=0, values={}), status="crashed"))
    count.add(_result(1, None))
    (judged,) = count.requirements
    assert (judged.kept, judged.missing) == (1, 1)


def test_a_fast_failure_keeps_a_limit_that_is_no_success() -> None:
    count = SuccessCount(_document(FORCE, "success >= 0.9"), 1000)
    for number in range(100):
        count.add(_result(number, 1.0, success=False))
    assert [each.verdict for each in count.requirements] == ["passed", "failed"]
    assert count.verdict == "failed"


def test_several_fail_if_one_fails_and_pass_if_all_do() -> None:
    def verdict(force_n: float, *required: str) -> str | None:
        return _counted(_document(*required), [force_n] * 100).verdict

    assert verdict(1.0, "success >= 0.9", FORCE) == "passed"
    assert verdict(99.0, "success >= 0.9", FORCE) == "failed"
    assert verdict(1.0, "success >= 0.99", FORCE) == "undecided"
    assert verdict(99.0, "success >= 0.99", FORCE) == "failed"


@given(
    kept=st.lists(st.booleans(), max_size=60),
    rates=st.lists(st.integers(1, 99), min_size=1, max_size=4, unique=True),
)
def test_several_pass_like_each_alone_and_fail_only_if_one_alone_does(kept: list[bool], rates: list[int]) -> None:
    """With one look at the same runs: the error of failing is divided, that of passing need not be."""
    forces_n = [1.0 if each else 99.0 for each in kept]
    texts = [f"share(cell.contact_force_max_n <= 30) >= 0.{rate:02}" for rate in rates]
    alone = [_counted(_document(text), forces_n).verdict for text in texts]
    together = _counted(_document(*texts), forces_n)
    assert (together.verdict == "passed") == all(each == "passed" for each in alone)
    if together.verdict == "failed":
        assert "failed" in alone
    for judged in together.requirements:
        assert judged.interval is not None
        assert judged.interval.low == rate_interval(sum(kept), len(kept)).low
        shared = 1.0 - 0.05 / len(texts)
        assert judged.interval.high == rate_interval(sum(kept), len(kept), confidence=shared).high


def test_an_exact_interval_waits_for_all_runs() -> None:
    document = _document(FORCE, interval="exact")
    assert share_interval(60, 60, document, planned=61) is None
    assert _counted(document, [1.0] * 60, planned=61).verdict == "undecided"
    assert _counted(document, [1.0] * 61, planned=61).verdict == "passed"


@pytest.mark.parametrize("design", ["grid", "sobol"])
def test_a_design_without_an_interval_compares_all_its_runs(design: str) -> None:
    document = _document(FORCE, design=design)
    assert _counted(document, [1.0] * 9, planned=10).verdict == "undecided"
    assert _counted(document, [1.0] * 9 + [99.0], planned=10).verdict == "passed"
    assert _counted(document, [99.0] * 2, planned=10).verdict == "failed"


def test_a_number_that_no_run_has_is_an_error_with_similar_names() -> None:
    sweep = _sweep("share(cell.contact_force_n <= 30) >= 0.9")
    expected = r"s.yaml:3:10: no run has a number `cell.contact_force_n` \(did you mean cell.contact_force_max_n\?\)"
    with pytest.raises(FlexcellError, match=expected):
        require_known_numbers(sweep, [_result(0, 1.0)])
    # A number that some runs have is known, and where no run succeeds nothing is.
    require_known_numbers(_sweep(FORCE), [_result(0, None), _result(1, 1.0)])
    require_known_numbers(sweep, [_result(0, 1.0, success=False)])
