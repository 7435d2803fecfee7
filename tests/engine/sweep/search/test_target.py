"""What a search goes towards."""

from __future__ import annotations

import math

import pytest

from engine.errors import FlexcellError
from engine.sweep import Configuration, TrialResult
from engine.sweep.execution.trial_result import TrialStatus
from engine.sweep.search.target import SearchTarget, is_failure


def _result(*, success: bool = True, status: TrialStatus = "finished", **outputs: float) -> TrialResult:
    return TrialResult(
        configuration=Configuration(number=0, seed=0, values={}),
        status=status,
        success=success,
        duration_s=7.0,
        outputs=outputs,
    )


def test_a_failure_is_nearer_than_every_success_and_less_is_nearer() -> None:
    target = SearchTarget.parse("least gap_m")
    scores = [target.score(each) for each in (_result(success=False), _result(gap_m=0.1), _result(gap_m=0.3))]
    assert scores == [-math.inf, 0.1, 0.3]


def test_the_most_of_a_number_may_be_nearest() -> None:
    target = SearchTarget.parse("most duration_s")
    assert (target.text, target.score(_result())) == ("most duration_s", -7.0)


def test_without_a_number_all_successes_are_equally_near() -> None:
    target = SearchTarget.parse("failure")
    assert target.score(_result(gap_m=0.1)) == target.score(_result()) > target.score(_result(success=False))


def test_a_run_without_the_number_is_far_and_a_refused_one_is_no_failure() -> None:
    target = SearchTarget.parse("least gap_m")
    refused = _result(success=False, status="refused")
    assert [target.score(each) for each in (_result(), _result(gap_m=math.nan), refused)] == [math.inf] * 3
    assert not is_failure(refused)
    assert is_failure(_result(success=False, status="crashed"))


def test_a_number_that_no_run_has_is_refused_with_those_that_there_are() -> None:
    target = SearchTarget.parse("least gab_m")
    with pytest.raises(FlexcellError, match="no run has a number `gab_m`") as caught:
        target.require_known([_result(gap_m=0.1)], where="sweep.yaml")
    assert "gap_m" in str(caught.value.hint)
    target.require_known([_result(success=False)], where="sweep.yaml")
