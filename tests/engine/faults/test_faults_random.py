"""Whatever goes wrong: the run ends, says how, and says the same twice."""

from __future__ import annotations

from hypothesis import given, settings
from hypothesis import strategies as st

from engine.document.faults import FAULT_KINDS
from engine.event import FaultInjected, GoalFinished, GoalSent, RunEnded
from engine.journal import encode_event_log
from tests.engine.faults.device import run_with_faults
from tests.tiers import examples

BEHAVIOR = """
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            grasp:
              {state: gripper.Grasp, timeout: {after: 7 s, to: late}, retry: {times: 1, outcomes: [aborted, rejected]}}
            listen:
              {state: gripper.Listen, timeout: {after: 6 s, to: late}, on_error: late}
          conditions:
            - {both: {grasp: succeeded, listen: heard}}
            - {one: {grasp: late}}
            - {one: {listen: late}}
          otherwise: one
        timeout: {after: 20 s, to: read}
        on_error: read
        transitions: {both: read, one: read}
      read: {state: gripper.Read, with: {times: 2}, timeout: {after: 4 s, to: bad}, transitions: {read: good, failed: bad}}
"""  # noqa: E501
KINDS = [
    "late: 0",
    "late: 500 ms",
    "late: 9 s",
    "hang: {}",
    "hang: {ignore_cancel: true}",
    "error: it broke",
    "error: {message: it broke, after: 1 s}",
    "error: {message: it broke, by: reject}",
    "error: {message: it broke, by: raise}",
    "duplicate: at_once",
    "duplicate: after_end",
    "lost: request",
    "lost: answer",
    "crash: {on_request: after}",
    "device: {air: false}",
]
PLACES = st.sampled_from(
    ["", "at: root/both/*, ", "at: root/read, ", "address: left/gripper/state, ", "address: left/**, "]
)
TURNS = st.sampled_from(["", "request: 1, ", "request: 2, ", "times: 1, ", "probability: 0.5, "])
FAULT = st.builds("- {{{}{}{}}}".format, PLACES, TURNS, st.sampled_from(KINDS))
FAULTS = st.lists(FAULT, min_size=1, max_size=4).map("\n".join)


def test_every_kind_of_fault_is_among_the_random_ones() -> None:
    assert {kind.partition(":")[0] for kind in KINDS} == set(FAULT_KINDS)


@settings(deadline=None, max_examples=examples(60, nightly=400))
@given(FAULTS, st.integers(0, 3), st.none() | st.sampled_from([0.0, 0.5, 2.0, 5.0]))
def test_any_faults_end_in_a_reported_end(faults: str, seed: int, stop_at_s: float | None) -> None:
    """Numbered without gaps, one end for each goal whose state was not abandoned, and byte for byte the same."""
    first, second = (run_with_faults(BEHAVIOR, faults, seed=seed, stop_at_s=stop_at_s, messages=30) for _ in range(2))
    events = first.events
    assert encode_event_log(events) == encode_event_log(second.events)
    assert [event.seq for event in events] == list(range(1, len(events) + 1))
    assert [type(event) for event in events].index(RunEnded) == len(events) - 1
    sent = [event.goal for event in events if isinstance(event, GoalSent)]
    ended = [event.goal for event in events if isinstance(event, GoalFinished)]
    assert sorted(sent) == sorted(ended) or first.result.abandoned
    assert sum(isinstance(event, FaultInjected) for event in events) >= len(first.killed_at)
