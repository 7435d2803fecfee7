"""Which requests a fault is applied to."""

from __future__ import annotations

from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from engine.document.faults import Fault
from engine.errors import Position
from engine.faults.fault_rule import FaultRule

HERE = Position(file="faults.yaml", line=1, column=1)
PATHS = ("root/a", "root/b", "root/box/a")


def _rule(*, seed: int = 0, **keys: Any) -> FaultRule:
    return FaultRule(Fault(late=1.0, **keys), number=1, seed=seed, position=HERE)


def test_requests_are_counted_for_each_state() -> None:
    """The second request of either state, however they interleave; other addresses do not count."""
    rule = _rule(address="left/*", request=2)
    asked = [
        ("root/a", "left/x"),
        ("root/b", "left/x"),
        ("root/a", "store/get"),
        ("root/b", "left/y"),
        ("root/a", "left/x"),
    ]
    assert [rule.wants(*one) for one in asked] == [False, False, False, True, True]


def test_times_counts_over_all_states() -> None:
    """Twice in the run, wherever."""
    rule = _rule(at="root/*", times=2)
    wanted: list[bool] = []
    for path in ("root/a", "root/b", "root/a"):
        wanted.append(rule.wants(path, "left/x"))
        rule.applied += wanted[-1]
    assert wanted == [True, True, False]


@given(st.lists(st.sampled_from(PATHS), max_size=30), st.randoms(), st.integers(0, 5))
def test_what_is_drawn_for_a_state_does_not_depend_on_the_others(requests: list[str], shuffle: Any, seed: int) -> None:
    """Branches may interleave in any way: the n-th request of a state has the same fate."""
    shuffled = list(requests)
    shuffle.shuffle(shuffled)
    fates: list[dict[str, list[bool]]] = []
    for order in (requests, shuffled):
        rule = _rule(probability=0.5, seed=seed)
        fate: dict[str, list[bool]] = {path: [] for path in PATHS}
        for path in order:
            fate[path].append(rule.wants(path, "left/x"))
        fates.append(fate)
    assert fates[0] == fates[1]


def test_a_probability_is_about_met() -> None:
    """A thousand draws of one seed."""
    rule = _rule(probability=0.25)
    assert 200 < sum(rule.wants("root/a", "left/x") for _ in range(1000)) < 300
