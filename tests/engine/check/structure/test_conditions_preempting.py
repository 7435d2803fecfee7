"""Conditions that preempt some branches: what the check says of them is what runs do."""

from __future__ import annotations

import itertools
from collections.abc import Mapping

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.check import check_behavior
from engine.document import parse_behavior
from tests.engine.check.checking import code_paths
from tests.engine.fake_states import CATALOGUE
from tests.engine.run_document import HEAD, run_document

NAMES = ("p", "q", "r")
OPEN = "and no condition matches"


_ENDS = list(itertools.product("ab", repeat=3))
COVERED = [f"{{good: {{{', '.join(f'{n}: {e}' for n, e in zip(NAMES, ends, strict=True))}}}}}" for ends in _ENDS]
"""All combinations of outcomes in which nobody is preempted; with the third outcome any container ends."""
FAILED = [f"{{bad: {{{name}: c}}}}" for name in NAMES]


@st.composite
def _conditions(draw: st.DrawFn) -> list[str]:
    found: list[str] = []
    for _ in range(draw(st.integers(1, 4))):
        some = draw(st.lists(st.sampled_from(NAMES), min_size=1, max_size=2, unique=True))
        others = [name for name in NAMES if name not in some]
        when = ", ".join(f"{name}: {draw(st.sampled_from('ab'))}" for name in some)
        count = ", at_least: 1" if draw(st.booleans()) else ""
        whom = draw(st.lists(st.sampled_from(others), min_size=1, unique=True))
        deciding = f"{{good: {{{when}{count}}}}}"
        found.append(deciding if draw(st.booleans()) else f"{{preempt: {whom}, when: {{{when}{count}}}}}")
    return found


def _text(conditions: list[str], states: Mapping[str, str]) -> str:
    written = ", ".join(f"{name}: {state}" for name, state in states.items())
    every = ", ".join((*conditions, *COVERED, *FAILED))
    return f"{HEAD}root: {{concurrency: {{states: {{{written}}}, conditions: [{every}]}}}}\n"


def _is_open(conditions: list[str]) -> bool:
    """Tell whether in some order of ends, with some outcomes, all branches end and nothing is decided."""
    for outcomes, times in itertools.product(_ENDS, itertools.permutations((1.0, 2.0, 3.0))):
        states = {
            name: f"{{state: test.Give, with: {{outcome: {outcome}, after_s: {time_s}}}}}"
            for name, outcome, time_s in zip(NAMES, outcomes, times, strict=True)
        }
        cause = run_document(_text(conditions, states)).result.cause
        if cause is not None and "and no condition matches" in cause.message:
            return True
    return False


@settings(deadline=None, max_examples=25, suppress_health_check=[HealthCheck.too_slow])
@given(_conditions())
def test_a_combination_is_said_to_be_open_where_a_run_finds_it_so(conditions: list[str]) -> None:
    """Three branches that end in any order, some of them preempted meanwhile; and nowhere else."""
    text = _text(conditions, dict.fromkeys(NAMES, "{state: test.Give}"))
    findings = check_behavior(parse_behavior(text, file="t.yaml"), CATALOGUE)
    assert ("uncovered-combination" in {finding.code for finding in findings}) == _is_open(conditions)


def _hanging(conditions: str) -> str:
    return f"""
    root:
      concurrency:
        states:
          camera: {{state: flow.Wait, with: {{duration_s: 1}}}}
          mover:
            machine:
              initial: a
              states:
                a: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: b}}}}
                b: {{state: flow.Wait, with: {{duration_s: 1}}, transitions: {{done: a}}}}
        conditions: [{conditions}]
    """


def test_a_child_that_never_ends_may_be_preempted() -> None:
    """Then all have finished at last, which needs an answer; without that it is the condition that decides alone."""
    loop = "no-path-to-outcome root/mover/a"
    assert loop in code_paths(_hanging("{good: {camera: done}}"))
    assert "uncovered-combination root" not in code_paths(_hanging("{bad: {mover: never}}, {good: {camera: done}}"))
    assert "uncovered-combination root" in code_paths(_hanging("{preempt: [mover], when: {camera: done}}"))
    covered = "{preempt: [mover], when: {camera: done}}, {good: {camera: done}}"
    assert "uncovered-combination root" not in code_paths(_hanging(covered))


def test_what_a_preempted_branch_was_to_write_may_be_missing_behind_otherwise() -> None:
    """A time is to come in place of a text, and stays a text where its writer was preempted."""
    text = """
    userdata: {pause_s: soon}
    root:
      machine:
        initial: both
        states:
          both:
            concurrency:
              states:
                camera: {state: flow.Wait, with: {duration_s: 1}}
                writer: {state: flow.SetValue, with: {value: 1}, out: {value: pause_s}}
              conditions: [CONDITIONS]
              otherwise: all
            transitions: {all: use, some: bad}
          use: {state: flow.Wait, with: {duration_s: "${pause_s}"}, transitions: {done: good}}
    """
    deciding = "{some: {camera: done, writer: done}}"
    assert code_paths(text.replace("CONDITIONS", deciding)) == []
    preempting = f"{deciding}, {{preempt: [writer], when: {{camera: done}}}}"
    assert code_paths(text.replace("CONDITIONS", preempting)) == ["maybe-type-mismatch root/use"]
