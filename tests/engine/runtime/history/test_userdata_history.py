"""The book of a run's userdata: what stands in every scope, and who wrote it when."""

from __future__ import annotations

import pytest

from engine.runtime.history.userdata_history import UserdataHistory
from tests.engine.run_document import plan_of, run_document

NESTED = """
userdata: {count: 0, sum: 1}
root:
  machine:
    initial: set
    states:
      set: {state: test.Write, with: {value: 7}, out: {value: count}, transitions: {done: inner}}
      inner:
        machine:
          initial: own
          userdata: {local: [1, 2]}
          states:
            own: {state: test.Write, with: {value: x}, out: {value: local}, transitions: {done: ended}}
        transitions: {ended: good}
"""
LOOP = """
userdata: {seen: []}
root:
  machine:
    initial: rounds
    states:
      rounds:
        foreach:
          items: [a, b, c]
          as: letter
          index: place
          next: [done]
          child: {state: test.Write, with: {value: "${letter}"}, out: {value: seen}}
        transitions: {exhausted: good, broken: bad}
"""


def values(book: UserdataHistory, scope: str) -> dict[str, tuple[object, str, int]]:
    """Value, writer and number of writes by key."""
    return {key: (entry.value, entry.by, entry.writes) for key, entry in book.scopes[scope].values.items()}


def test_a_write_is_reported_with_its_writer_and_values_stay_when_a_container_is_left() -> None:
    """What nobody has written is there with its first value."""
    told = run_document(NESTED)
    book = UserdataHistory(lambda: plan_of(NESTED))
    book.read(told.events)
    assert values(book, "") == {"count": (7, "root/set", 1), "sum": (1, "", 0)}
    assert values(book, "root/inner") == {"local": ("x", "root/inner/own", 1)}
    assert not any(scope.is_open for scope in book.scopes.values())
    assert book.seq == told.events[-1].seq


def test_changes_are_reported_once_and_by_scope() -> None:
    """So that a screen gets no more than what is new."""
    told = run_document(NESTED)
    book = UserdataHistory(lambda: plan_of(NESTED))
    assert set(book.changes()) == {""}
    assert book.changes() == {}
    for event in told.events:
        book.read([event])
        if getattr(event, "key", "") == "local":
            assert set(book.changes()) == {"root/inner"}
            break
        book.changes()
    else:
        pytest.fail("nothing was written")


def test_a_loop_shows_its_present_round() -> None:
    """The round before is gone."""
    told = run_document(LOOP)
    book = UserdataHistory(lambda: plan_of(LOOP))
    book.read(told.events)
    rounds = [path for path in book.scopes if "#" in path]
    assert rounds == ["root/rounds#2"]
    assert values(book, "root/rounds#2") == {"letter": ("c", "", 0), "place": (2, "", 0)}
