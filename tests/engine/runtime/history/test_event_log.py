"""Events of a run in the words of the page."""

from __future__ import annotations

import pytest

from engine.event import BranchesPreempted
from engine.runtime.history.event_log import log_line


@pytest.mark.parametrize(
    ("branches", "said"),
    [
        (("mover", "light"), "preempt mover, light when camera=lost: mover, light"),
        ((), "preempt mover, light when camera=lost: all branches had ended"),
    ],
)
def test_a_condition_that_preempts_is_reported_with_the_branches_that_it_found_at_work(
    branches: tuple[str, ...], said: str
) -> None:
    condition = "preempt mover, light when camera=lost"
    line = log_line(BranchesPreempted(seq=1, time_s=0.0, path="root", condition=condition, branches=branches))
    assert (line.path, line.kind, line.level, line.text) == ("root", "branches_preempted", "info", said)
