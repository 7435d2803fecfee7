"""A copy of the state of a run has all of it, and what comes later changes only one of both."""

from __future__ import annotations

from copy import deepcopy

from engine.event import RunEnded
from engine.runtime.history.run_state import NodeLive, RunState


def _all_different() -> RunState:
    """Return a state in which nothing is as it begins, so that what a copy leaves out is seen."""
    state = RunState("run")
    state.seq, state.time_s, state.real_time, state.seed = 7, 2.5, True, 3
    state.document = "hash"
    state.parameters = {"speed": 0.2}
    state.end = RunEnded(seq=7, time_s=2.5, outcome="done", status="finished")
    state.paused, state.autonomy, state.stepping_back = True, "low", "root/back"
    state.locks, state.active = {"root/a": "reason"}, {"root/a": None}
    state.nodes = {"root/a": NodeLive(status="active")}
    state.exits, state.containers = {"root": {"a": "done"}}, frozenset({"root"})
    return state


def test_a_copy_has_all_of_a_state() -> None:
    state = _all_different()
    begins = vars(RunState("run"))
    assert not [name for name, value in vars(state).items() if name != "run" and value == begins[name]]
    assert vars(state.copy()) == vars(state)


def test_what_changes_in_a_state_does_not_change_its_copy() -> None:
    state = _all_different()
    copied = state.copy()
    kept = deepcopy(vars(copied))
    state.locks["root/b"] = "another"
    state.nodes["root/a"] = NodeLive(status="done")
    state.active.clear()
    state.exits["root"]["b"] = "done"
    state.seq, state.paused, state.end = 8, False, None
    assert vars(copied) == kept
