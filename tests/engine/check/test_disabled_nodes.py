"""The check sees a disabled node as a run does, and says what passing it over breaks."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.check import check_behavior
from engine.document import parse_behavior
from engine.event import Event, NodeExited
from engine.runtime.plan import new_plan
from tests.engine.check.checking import code_paths, findings_in
from tests.engine.check.data_runs import events_of
from tests.engine.check.data_states import CATALOGUE
from tests.engine.check.random_behaviors import Plain, behaviors
from tests.tiers import examples

SLOW = [HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.large_base_example, HealthCheck.filter_too_much]
MACHINE = """
    root:
      machine:
        initial: one
        states:
          one: <one>
          two: {state: flow.Log, with: {message: hello}, transitions: {done: good}}
          three: {state: flow.Log, with: {message: hello}, transitions: {done: bad}}
"""


@pytest.mark.parametrize(
    ("one", "found"),
    [
        ("{state: flow.Wait, with: {duration_s: 1}, disabled: done, transitions: {done: two}}", []),
        ("{state: no.Such, with: {x: 1}, disabled: any, transitions: {any: two}}", []),
        ("{state: flow.Wait, disabled: dnoe, transitions: {dnoe: two}}", ["unknown-outcome root/one"]),
        ("{state: flow.Wait, disabled: done}", ["unconnected-outcome root/one", "unreachable-node root/two"]),
        ("{state: flow.Wait, disabled: done, transitions: {done: tow}}", ["unknown-target root/one"]),
    ],
)
def test_the_outcome_must_exist_and_lead_somewhere(one: str, found: list[str]) -> None:
    """Nothing else of a disabled node is looked at."""
    others = ["unreachable-node root/three", *(["unreachable-node root/two"] if "tow" in one else [])]
    assert [each for each in code_paths(MACHINE.replace("<one>", one)) if each not in others] == found


def test_a_key_that_only_a_disabled_node_writes_is_found_where_it_is_read() -> None:
    """With the node that would write it."""
    (finding,) = findings_in("""
        root:
          machine:
            initial: write
            states:
              write:
                state: flow.SetValue
                with: {value: 3}
                out: {value: k}
                disabled: done
                transitions: {done: read}
              read: {state: flow.Log, with: {message: "${string(k)}"}, transitions: {done: good}}
    """)
    assert (finding.code, finding.path) == ("undefined-key", "root/read")
    assert finding.message == "`read` reads `k`, which only the disabled node `root/write` writes"


@pytest.mark.parametrize(
    "container",
    [
        "{tree: {sequence: [<off>, <off>]}}",
        "{tree: {inverter: {child: <off>}}}",
        "{tree: <off>}",
        "{concurrency: {states: {a: <on>}, conditions: [{good: {a: done}}]}}",
        "{machine: {initial: a, states: {a: {state: flow.Log, disabled: done, transitions: {done: good}}}}}",
    ],
)
def test_a_container_of_which_nothing_is_left_is_found(container: str) -> None:
    """It should be disabled itself."""
    container = container.replace("<off>", "{state: flow.Log, disabled: true}")
    container = container.replace("<on>", "{state: flow.Log, disabled: done}")
    codes = [each.partition(" ")[0] for each in code_paths(f"root: {container}")]
    assert codes.count("all-disabled") == 1


def test_two_branches_that_command_one_arm_conflict_only_while_both_are_enabled() -> None:
    """What is disabled commands nothing; its conditions stay as they are."""
    text = """
        root:
          concurrency:
            states:
              a: {state: motion.Recover, with: {robot: left}}
              b: {state: motion.Recover, with: {robot: left}<more>}
            conditions: [{good: {a: recovered, b: recovered}}, {bad: {a: failed}}, {bad: {b: failed}}]
    """
    enabled, disabled = (code_paths(text.replace("<more>", more)) for more in ("", ", disabled: recovered"))
    assert "shared-resource root/b" in enabled
    assert [each for each in disabled if "shared-resource" in each or "outcome" in each] == []


@given(behaviors(), st.data())
@settings(max_examples=examples(30, nightly=300), deadline=None, suppress_health_check=SLOW)
def test_a_key_that_a_run_misses_was_found_before(document: Plain, data: st.DataObject) -> None:
    """With any nodes disabled."""
    nodes = dict(parse_behavior(json.dumps(document), file="random.json").nodes())
    plan = new_plan(parse_behavior(json.dumps(document), file="random.json"), CATALOGUE)
    for path in list(nodes)[1:]:
        if data.draw(st.integers(0, 3)):
            continue
        above = nodes[path.rpartition("/")[0]]
        outcomes = plan.outcomes_of(path) or ("done",)
        outside = above.kind in ("machine", "priority", "concurrency", "foreach")
        node = _at(document, plan.source.data_path(path) if plan.source is not None else ())
        node["disabled"] = data.draw(st.sampled_from(outcomes)) if outside else True
    disabled = parse_behavior(json.dumps(document), file="random.json")
    findings = check_behavior(disabled, CATALOGUE)
    reported = {each.path for each in findings if each.code.endswith(("undefined-key", "undeclared-name"))}
    for seed in range(2):
        assert _missed(events_of(document, seed)) <= reported


def _at(data: Plain, keys: Sequence[str | int]) -> Plain:
    found: Any = data
    for key in keys:
        found = found[key]
    return found


def _missed(events: list[Event]) -> set[str]:
    found: set[str] = set()
    for event in events:
        cause = event.cause if isinstance(event, NodeExited) else None
        while cause is not None:
            if "is read but not defined" in cause.message:
                found.add(cause.nodes[0].partition(" at ")[0])
            cause = cause.because
    return found
