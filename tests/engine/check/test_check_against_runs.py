"""What the check says of userdata is what runs of random behaviors do."""

from __future__ import annotations

import json
from collections.abc import Iterable

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from engine.check import Finding, check_behavior
from engine.document import parse_behavior
from engine.errors import Cause
from engine.event import Event, NodeEntered, NodeExited, RunEnded
from tests.engine.check.data_runs import events_of
from tests.engine.check.data_states import CATALOGUE
from tests.engine.check.random_behaviors import Plain, behaviors
from tests.tiers import examples

UNDEFINED = {"undefined-key", "undeclared-name"}
MAYBE = {"maybe-undefined-key"}
SEEDS = range(3)
SETTINGS = settings(
    max_examples=examples(30, nightly=240),
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.large_base_example],
)


def checked(document: Plain) -> tuple[Finding, ...]:
    """Check a document given as plain data."""
    return check_behavior(parse_behavior(json.dumps(document), file="random.json"), CATALOGUE)


def causes(events: Iterable[Event]) -> list[Cause]:
    """Return everything that made a node fail, down to the first cause."""
    found: list[Cause] = []
    for event in events:
        cause = event.cause if isinstance(event, NodeExited) else None
        while cause is not None:
            found.append(cause)
            cause = cause.because
    return found


@SETTINGS
@given(behaviors())
def test_a_key_that_a_run_misses_was_found_before(document: Plain) -> None:
    """Every read of an undefined key in a run stands at a node for which the check has said so."""
    findings = checked(document)
    reported = {finding.path for finding in findings if finding.code in UNDEFINED | MAYBE}
    for seed in SEEDS:
        missed = [cause for cause in causes(events_of(document, seed)) if "is read but not defined" in cause.message]
        assert {cause.nodes[0].partition(" at ")[0] for cause in missed} <= reported


@SETTINGS
@given(behaviors())
def test_what_is_said_for_certain_never_goes_well(document: Plain) -> None:
    """A node with a finding that leaves no doubt never ends with an outcome."""
    certain = {f.path for f in checked(document) if f.code in {*UNDEFINED, "type-mismatch"}}
    for seed in SEEDS:
        events = events_of(document, seed)
        # A foreach that collects reads only at the end of a round that others follow.
        rounds = {event.path for event in events if isinstance(event, NodeEntered) and event.kind == "foreach"}
        went_well = {event.path for event in events if isinstance(event, NodeExited) and event.outcome}
        assert not (certain - rounds) & went_well


@SETTINGS
@given(behaviors(safe=True), st.integers(0, 5))
def test_a_behavior_in_order_has_no_error_and_runs(document: Plain, seed: int) -> None:
    """No error is found in it, it can be planned, and no run of it ends with an error."""
    errors = [finding for finding in checked(document) if finding.severity == "error"]
    assert errors == []
    ended = [event for event in events_of(document, seed) if isinstance(event, RunEnded)]
    assert [event.status for event in ended] != ["errored"], ended


@SETTINGS
@given(behaviors())
def test_a_value_that_does_not_fit_in_a_run_was_found_before(document: Plain) -> None:
    """Every value that a node does not take stands at a node for which the check has said so."""
    # Nothing as an initial value means that a run is to give one, of whatever kind.
    document["userdata"] = {key: value for key, value in document["userdata"].items() if value is not None}
    reported = {
        finding.path for finding in checked(document) if finding.code in {"type-mismatch", "maybe-type-mismatch"}
    }
    for seed in SEEDS:
        wrong = [cause for cause in causes(events_of(document, seed)) if " fit" in cause.message]
        assert {cause.nodes[0].partition(" at ")[0] for cause in wrong} <= reported


def test_a_condition_may_read_what_a_branch_has_just_written() -> None:
    """The condition of a loop is ticked again before the end of the branch is seen."""
    read: Plain = {"state": "data.Put", "with": {"value": "${m}"}, "out": {"value": "k"}}
    write: Plain = {"state": "data.Put", "with": {"value": 1}, "out": {"value": "m"}}
    choose: Plain = {"state": "data.Choose"}
    condition: Plain = {"if_then_else": {"if": choose, "then": read, "else": choose}}
    document: Plain = {
        "flexcell": 1,
        "name": "loop",
        "outcomes": ["x", "y"],
        "success": ["x"],
        "root": {
            "machine": {
                "initial": "s",
                "states": {
                    "s": {
                        "tree": {"while_do_else": {"while": condition, "do": choose, "else": write}},
                        "transitions": {"success": "x", "failure": "y"},
                    }
                },
            }
        },
    }
    reader = "root/s/while_do_else/if_then_else/Put"
    assert {f.code for f in checked(document) if f.path == reader} == {"maybe-undefined-key"}
    ended = [isinstance(event, NodeExited) and event.path == reader for event in events_of(document, SEEDS[0])]
    assert any(ended)
