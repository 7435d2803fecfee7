"""Keys that say how a node behaves when things go wrong: those that do nothing, and those that cannot be."""

from __future__ import annotations

import pytest

from tests.engine.check.checking import code_paths, message_of

WAIT = """
userdata: {ready: true, parts: []}
root:
  machine:
    initial: wait
    states:
      wait: {state: flow.Wait, with: {duration_s: 1}, %s, transitions: {done: good}}
"""
EACH = """
flexcell: 1
name: t
outcomes: [exhausted, broken]
root: {foreach: {%s, child: {state: flow.Wait, with: {duration_s: 1}}}}
"""


@pytest.mark.parametrize(
    ("extra", "expected"),
    [
        ("resume: rerun", None),
        ("resume: ask", None),
        ("resume: done", None),
        ("resume: good", "bad-resume"),
        ("autonomy: {done: high}", None),
        ("autonomy: {done: off}", None),
        ("autonomy: {done: full}", "autonomy-never-passes"),
        ("autonomy: {doen: low}", "unknown-outcome"),
        ("retry: {times: 2}", None),
        ("retry: {times: 2, errors: false, outcomes: [done]}", None),
        ("retry: {times: 2, errors: false}", "idle-retry"),
        ("retry: {times: 2, outcomes: [doen]}", "unknown-outcome"),
        ("guard: {when: '${ready}', to: bad}", None),
        ("guard: {when: '${1 < 2}', to: bad}", "constant-guard"),
        ("guard: {when: '${false}', to: bad}", "constant-guard"),
        ("guard: {when: 'ready', to: bad}", "type-mismatch"),
        ("guard: {when: '${1}', to: bad}", "type-mismatch"),
        ("guard: {when: '${redy}', to: bad}", "undeclared-name"),
        ("guard: {when: '${ready &}', to: bad}", "bad-expression"),
        ("guard: {when: '${ready}', to: bda}", "unknown-target"),
        ("timeout: {after: 1 s, to: bda}", "unknown-target"),
    ],
)
def test_a_setting_of_a_node(extra: str, expected: str | None) -> None:
    """What is wrong with it, if anything."""
    assert code_paths(WAIT % extra) == ([f"{expected} root/wait"] if expected else [])


def test_a_condition_without_braces_is_text() -> None:
    """The hint puts them around it."""
    assert message_of(WAIT % "guard: {when: 'ready', to: bad}") == "the guard expects true or false, but gets 'ready'"


@pytest.mark.parametrize(
    ("rounds", "expected"),
    [
        ("items: [1, 2]", None),
        ("times: 3", None),
        ("times: '${1 + 2}'", None),
        ("items: parts", "type-mismatch root"),
        ("items: '${3}'", "type-mismatch root"),
        ("times: -1", "type-mismatch root"),
        ("times: '${1.5}'", "type-mismatch root"),
        ("times: 3, next: [done]", None),
        ("times: 3, next: [gone]", "unknown-outcome root"),
    ],
)
def test_the_rounds_of_a_foreach(rounds: str, expected: str | None) -> None:
    """A list, or a whole number, and outcomes that the child has."""
    assert code_paths(EACH % rounds) == ([expected] if expected else [])


def test_an_outcome_may_come_from_a_guard_timeout_or_error() -> None:
    """In a concurrency container they are outcomes that a condition must cover, and in a foreach ones for `next`."""
    text = """
    root:
      concurrency:
        states:
          wait: {state: flow.Wait, with: {duration_s: 1}, %s}
        conditions: [{good: {wait: done}}]
    """
    for extra in ("timeout: {after: 1, to: late}", "on_error: late", "guard: {when: '${1 > 2}', to: late}"):
        assert "uncovered-combination root" in code_paths(text % extra)
    assert (
        code_paths(EACH.replace("{duration_s: 1}}", "{duration_s: 1}, on_error: late}") % "times: 1, next: [late]")
        == []
    )
