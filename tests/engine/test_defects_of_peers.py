"""Known defects of other engines, each as a test that this one does not have it.

They were found in the public trackers and by measurement of SMACH, FlexBE, py_trees,
python-statemachine and RAFCON.
"""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest

import engine
from engine.bus import SkillBus
from engine.check import check_behavior
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.errors import DocumentError
from engine.runtime.run import Run
from tests.engine.fake_states import CATALOGUE
from tests.engine.run_document import HEAD, plan_of, run_document
from tests.house.source_file import source_file

ROOT = Path(engine.__file__).parent


def test_a_stop_asked_for_before_the_start_is_honoured() -> None:
    """SMACH forgets a preempt that comes before `execute`."""
    told = run_document("root: {state: test.Give}", stop_first=True)
    assert told.result.status == "stopped"
    assert told.lines == []


def test_the_stop_of_one_run_does_not_leak_into_the_next_of_the_same_plan() -> None:
    """SMACH keeps a stale preempt flag when a state is entered again."""
    text = """
    root:
      concurrency:
        states:
          long: {state: test.Hang}
          short: {state: test.Give, with: {after_s: 1}}
        conditions: [{good: {short: a}}]
    """
    plan = plan_of(text)

    async def main() -> list[str]:
        bus = SkillBus(new_clock())
        async with bus:
            first = Run(plan, run="r1", bus=bus)
            asyncio.get_running_loop().call_later(0.5, first.stop, "enough")
            ends = [(await first.execute()).status]
            ends.append((await Run(plan, run="r2", bus=bus).execute()).status)
        return ends

    assert run_virtual(main()) == ["stopped", "finished"]


def test_a_container_that_is_entered_again_after_a_preemption_starts_afresh() -> None:
    """The same defect inside one run: the branch was preempted, the second round must not be."""
    told = run_document(
        """
        userdata: {count: 0}
        root:
          machine:
            initial: both
            states:
              both:
                concurrency:
                  states:
                    long: {state: test.Give, with: {after_s: 5}}
                    short: {state: test.Count, with: {up_to: 2}}
                  conditions: [{again: {short: more}}, {over: {short: full, long: a}}]
                transitions: {again: both, over: good}
        """
    )
    assert told.result.outcome == "good"
    assert told.lines.count("-root/both/long preempted") == 1
    assert told.lines.count("-root/both/long a") == 1


def test_an_empty_container_is_an_error_of_loading() -> None:
    """An empty Concurrence of SMACH waits for ever."""
    with pytest.raises(DocumentError, match="states"):
        parse_behavior(HEAD + "root: {concurrency: {states: {}, conditions: []}}", file="x.yaml")


def test_a_key_that_is_written_and_not_declared_is_an_error_naming_state_and_key() -> None:
    """SMACH drops it silently."""
    told = run_document("root: {state: test.Write, with: {key: other, value: 1}}")
    assert told.result.status == "errored"
    assert "test.Write wrote 'other', which it does not declare" in str(told.result.cause)


def test_an_outcome_without_transition_is_found_before_and_an_error_at_run_time() -> None:
    """SMACH returns None."""
    text = """
    root:
      machine:
        initial: one
        states:
          one: {state: test.Give, transitions: {b: good, c: bad}}
    """
    codes = [finding.code for finding in check_behavior(parse_behavior(HEAD + _dedent(text), file="x.yaml"), CATALOGUE)]
    assert "unconnected-outcome" in codes
    told = run_document(text)
    assert told.result.status == "errored"
    assert "outcome 'a' has no transition" in str(told.result.cause)


def test_an_outcome_called_preempted_is_an_outcome_like_any_other() -> None:
    """In FlexBE it kills the root."""
    told = run_document(
        """
        root:
          machine:
            initial: inner
            states:
              inner:
                machine:
                  initial: one
                  states:
                    one: {state: test.Give, transitions: {a: preempted, b: preempted, c: preempted}}
                transitions: {preempted: good}
        """
    )
    assert told.result.outcome == "good"


def test_an_expression_of_a_document_cannot_reach_python() -> None:
    """python-statemachine evaluated guards of a document with `eval` (CVE-2026-47103)."""
    attack = "__import__('os').system('true')"
    text = f'root: {{state: test.Give, with: {{outcome: "${{{attack}}}"}}}}'
    with pytest.raises(DocumentError):
        run_document(text)
    codes = [finding.code for finding in check_behavior(parse_behavior(HEAD + text, file="x.yaml"), CATALOGUE)]
    assert "bad-expression" in codes


@pytest.mark.parametrize("package", ["engine", "states", "robots", "editor_web"])
def test_nothing_is_unpickled_or_evaluated(package: str) -> None:
    """RAFCON and SMACH unpickle what comes from files and topics."""
    forbidden = {"pickle", "marshal", "shelve", "dill", "cloudpickle"}
    for file in (ROOT.parent / package).rglob("*.py"):
        source = source_file(file)
        assert forbidden.isdisjoint(each.module.partition(".")[0] for each in source.imports), file
        assert source.called.isdisjoint({"eval", "exec"}), f"{file} evaluates text"


def _dedent(text: str) -> str:
    return "\n".join(line.removeprefix("    ") for line in text.splitlines())
