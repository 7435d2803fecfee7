"""The last runs of a behavior are counted once each, and their durations are those of the good ones."""

from __future__ import annotations

from collections import Counter

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.archive import PastRun
from engine.archive.run_trend import run_trend
from tests.engine.archive.test_run_comparison import past_run

ENDS: dict[str, dict[str, object]] = {
    "good": {},
    "failed": {"success": False, "outcome": "bad"},
    "errored": {"success": False, "status": "errored", "outcome": None},
    "stopped": {"success": False, "status": "stopped", "outcome": None},
    "running": {"success": False, "status": "running", "outcome": None},
}


def runs_of(ends: list[str]) -> list[PastRun]:
    """Runs that ended so, the newest first; each took as many seconds as its number."""
    return [past_run(f"r{index}", duration_s=float(index), **ENDS[end]) for index, end in enumerate(ends)]


@given(ends=st.lists(st.sampled_from(tuple(ENDS)), max_size=12), last=st.integers(1, 12))
def test_each_run_is_counted_once(ends: list[str], last: int) -> None:
    """Also among others."""
    runs = [run for each in runs_of(ends) for run in (past_run("other", behavior="place"), each)]
    found = run_trend("pick", runs, lambda run: {"root": run.duration_s}, last=last)
    shown = Counter(ends[:last])
    assert (found.succeeded, found.failed, found.stopped, found.not_ended) == (
        shown["good"],
        shown["failed"] + shown["errored"],
        shown["stopped"],
        shown["running"],
    )
    assert found.known == len(ends)
    assert len(found.runs) == min(last, len(ends))
    assert (found.duration is not None) == (shown["good"] > 0)
    assert {each.count for each in found.nodes} <= {shown["good"]}


def test_durations_have_a_median_and_a_spread_of_the_good_runs() -> None:
    """And that of the latest run, which failed."""
    table = {"r0": {"root": 9.0}, "r1": {"root": 1.0, "root/a": 0.5}, "r2": {"root": 2.0}, "r3": {"root": 4.0}}
    found = run_trend("pick", runs_of(["failed", "good", "good", "good"]), lambda run: table[run.id], last=4)
    assert found.duration is not None
    assert (found.duration.median_s, found.duration.last_s) == (2.0, 0.0)
    root, inner = found.nodes
    assert (root.path, root.count, root.median_s, root.least_s, root.most_s) == ("root", 3, 2.0, 1.0, 4.0)
    assert (root.lower_s, root.upper_s, root.last_s) == (1.5, 3.0, 9.0)
    assert (inner.path, inner.count, inner.median_s, inner.last_s) == ("root/a", 1, 0.5, None)


@pytest.mark.parametrize("ends", [[], ["failed"], ["running"]])
def test_without_a_good_run_there_are_no_durations(ends: list[str]) -> None:
    """And nothing is made up."""
    found = run_trend("pick", runs_of(ends), lambda _run: {"root": 1.0}, last=5)
    assert (found.duration, found.nodes) == (None, ())
