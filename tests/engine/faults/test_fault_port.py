"""Faults applied to the goals, services and topics of a run: what the state, the device and the log see."""

from __future__ import annotations

import pytest

from engine.journal import encode_event_log
from tests.engine.faults.device import run_with_faults

ENDS = "{succeeded: good, aborted: bad, rejected: bad, canceled: bad}"
GRASP = f"""
root:
  machine:
    initial: grasp
    states:
      grasp: {{state: gripper.Grasp, transitions: {ENDS}}}
"""
GRASP_WITHIN_5_S = GRASP.replace("transitions:", "timeout: {after: 5 s, to: bad}, transitions:")
READ_TWICE = """
root:
  machine:
    initial: read
    states:
      read:
        {state: gripper.Read, with: {times: 2}, timeout: {after: 9 s, to: bad}, transitions: {read: good, failed: bad}}
"""
LISTEN = """
root:
  machine:
    initial: listen
    states:
      listen: {state: gripper.Listen, timeout: {after: 9 s, to: bad}, transitions: {heard: good}}
"""
SENT = "grasp root/grasp#1.1"


def test_a_late_goal_is_done_in_time_and_reported_late() -> None:
    """The device takes its two seconds, the state learns of it three later."""
    told = run_with_faults(GRASP, "- {at: root/grasp, late: 3 s}")
    assert (told.result.outcome, told.result.duration_s, told.ends) == ("good", 5.0, [(5.0, "succeeded")])
    assert told.faults == [(0.0, "root/grasp", "fault 1", "its end is reported 3 s late")]


def test_a_hanging_goal_is_cancelled_by_the_timeout_and_confirms() -> None:
    """The device had long done it; the state is told that it was cancelled."""
    told = run_with_faults(GRASP_WITHIN_5_S, "- {address: left/**, hang: {}}")
    assert (told.result.outcome, told.ends, told.device) == ("bad", [(5.0, "canceled")], (SENT, "grasped"))


def test_a_cancel_of_a_hanging_goal_reaches_the_device() -> None:
    """A stop while the fingers move brings them to rest."""
    told = run_with_faults(GRASP, "- hang: {}", stop_at_s=1.0)
    assert (told.result.status, told.ends, told.device) == ("stopped", [(1.0, "canceled")], (SENT, "stopped"))


def test_a_goal_that_hears_no_cancel_is_named_and_abandoned() -> None:
    """The run says who does not stop and goes on without it."""
    told = run_with_faults(GRASP, "- hang: {ignore_cancel: true}", stop_at_s=1.0)
    assert (told.result.status, told.result.abandoned, told.device) == ("errored", ("root/grasp",), (SENT, "grasped"))


@pytest.mark.parametrize(
    ("error", "ends"),
    [
        ("the fingers are blocked", [(0.0, "aborted")]),
        ("{message: the fingers are blocked, by: reject}", [(0.0, "rejected")]),
        ("{message: the fingers are blocked, by: reject, after: 1 s}", [(1.0, "rejected")]),
        ("{message: the fingers are blocked, after: 1 s}", [(1.0, "aborted")]),
    ],
)
def test_a_failing_goal_says_why(error: str, ends: list[tuple[float, str]]) -> None:
    """The message travels in the cause chain of the run."""
    told = run_with_faults(GRASP, f"- error: {error}")
    assert (told.result.outcome, told.ends) == ("bad", ends)
    assert told.result.cause is not None
    assert "the fingers are blocked" in [link.message for link in told.result.cause.chain()]
    assert told.device == ((SENT, "stopped") if "after" in error and "reject" not in error else ())


def test_an_error_raised_in_the_state_ends_the_run() -> None:
    """Nothing handles it here."""
    told = run_with_faults(GRASP, "- error: {message: the wire is cut, by: raise}")
    assert (told.result.status, told.device) == ("errored", ())
    assert told.result.cause is not None
    assert "the wire is cut" in told.result.cause.message


def test_a_copy_that_comes_at_once_is_refused_as_busy_and_nobody_notices() -> None:
    """The bus runs one goal of a device at a time; the first one counts."""
    told = run_with_faults(GRASP, "- duplicate: at_once")
    assert (told.result.outcome, told.ends, told.device) == ("good", [(2.0, "succeeded")], (SENT, "grasped"))


def test_a_copy_that_comes_afterwards_is_carried_out_with_the_same_id() -> None:
    """A device that does not remember ids does it twice; the state is told the first end."""
    told = run_with_faults(GRASP, "- duplicate: after_end")
    assert (told.ends, told.device) == ([(4.0, "succeeded")], (SENT, "grasped", SENT, "grasped"))


def test_a_cancel_stops_the_copy_too() -> None:
    """In the second round."""
    told = run_with_faults(GRASP, "- duplicate: after_end", stop_at_s=3.0)
    assert (told.result.status, told.device) == ("stopped", (SENT, "grasped", SENT, "stopped"))


def test_a_lost_goal_never_reaches_the_device() -> None:
    """Only the timeout ends it, and the cancel finds nothing to stop."""
    told = run_with_faults(GRASP_WITHIN_5_S, "- lost: request")
    assert (told.result.outcome, told.ends, told.device) == ("bad", [(5.0, "canceled")], ())


def test_a_lost_end_is_reported_to_who_asks() -> None:
    """The effect has happened; the answer to the cancel tells it."""
    told = run_with_faults(GRASP_WITHIN_5_S, "- lost: answer")
    assert (told.result.outcome, told.ends, told.device) == ("bad", [(5.0, "succeeded")], (SENT, "grasped"))


@pytest.mark.parametrize(
    ("fault", "device", "logged", "outcome"),
    [
        ("late: 2 s", ("read", "read"), [(2.0, "0.01"), (2.0, "0.02")], "good"),
        ("hang: {}", ("read",), [], "bad"),
        ("lost: request", (), [], "bad"),
        ("lost: answer", ("read",), [], "bad"),
        ("error: no answer", (), [(0.0, "failed: no answer")], "bad"),
        ("error: {message: no answer, after: 2 s}", (), [(2.0, "failed: no answer")], "bad"),
        ("duplicate: at_once", ("read", "read", "read"), [(0.0, "0.01"), (0.0, "0.03")], "good"),
    ],
)
def test_faults_of_a_service(
    fault: str, device: tuple[str, ...], logged: list[tuple[float, str]], outcome: str
) -> None:
    """The first of two calls is hit; the first of two answers counts."""
    told = run_with_faults(READ_TWICE, f"- {{request: 1, {fault}}}")
    assert (told.device, told.logged, told.result.outcome) == (device, logged, outcome)


@pytest.mark.parametrize(
    ("fault", "logged", "outcome"),
    [
        ("late: 2 s", [(3.0, "1"), (4.0, "4")], "good"),
        ("hang: {}", [], "bad"),
        ("lost: answer", [(2.0, "2"), (3.0, "3")], "good"),
        ("duplicate: at_once", [(1.0, "1"), (1.0, "1")], "good"),
    ],
)
def test_faults_of_a_topic(fault: str, logged: list[tuple[float, str]], outcome: str) -> None:
    """Messages come a second apart, from second 1 on; the first read is hit."""
    told = run_with_faults(LISTEN, f"- {{address: left/gripper/state, request: 1, {fault}}}", messages=5)
    assert (told.logged, told.result.outcome) == (logged, outcome)


def test_a_service_that_hears_no_cancel_is_abandoned() -> None:
    """As a state that swallows its cancellation."""
    told = run_with_faults(READ_TWICE, "- hang: {ignore_cancel: true}")
    assert (told.result.status, told.result.abandoned) == ("errored", ("root/read",))


def test_a_crash_comes_with_its_event() -> None:
    """Of everything the watchers have seen it is the last."""
    told = run_with_faults(GRASP, "- crash: {at_event: 3}")
    assert told.killed_at in ((2,), (3,))


@pytest.mark.parametrize(("when", "device"), [("before", ()), ("after", (SENT, "grasped"))])
def test_a_crash_at_a_request_comes_before_it_or_after_its_effect(when: str, device: tuple[str, ...]) -> None:
    """Before, the goal is in the log and not at the device; after, it is done and the log does not know."""
    told = run_with_faults(GRASP, f"- crash: {{on_request: {when}}}")
    names = [type(event).__name__ for event in told.events[: told.killed_at[0]]]
    assert names[-2:] == ["GoalSent", "FaultInjected"]
    assert told.device[: len(device)] == device
    assert len(told.killed_at) == 1


def test_a_second_answer_that_is_an_error_is_reported_in_the_log_only() -> None:
    """The state has the first answer; that the device did not take the copy stands in the event log."""
    told = run_with_faults(READ_TWICE.replace("times: 2", "times: 1"), "- duplicate: at_once", breaks_at_read=2)
    assert (told.result.outcome, told.logged) == ("good", [(0.0, "0.01")])
    assert [detail for *_, detail in told.faults] == [
        "asked twice", "the copy of the request failed: left/gripper: it takes one request only",
    ]  # fmt: skip


def test_a_held_goal_is_held_at_the_device() -> None:
    """A pause of the run reaches through the fault to the fingers."""
    told = run_with_faults(GRASP, "- late: 1 s", pause_s=(1.0, 1.5))
    assert (told.device, told.ends) == ((SENT, "held", "resumed", "grasped"), [(3.0, "succeeded")])


def test_a_lost_goal_is_held_without_the_device() -> None:
    """There is nothing to bring to rest."""
    told = run_with_faults(GRASP_WITHIN_5_S, "- lost: request", pause_s=(1.0, 4.0))
    assert (told.device, told.result.duration_s) == ((), 8.0)


def test_a_fault_that_was_never_applied_is_reported_before_the_end() -> None:
    """With its number, its place and the reason; the last event is still the end of the run."""
    told = run_with_faults(
        GRASP,
        """
        - {at: root/gasp, hang: {}}
        - {name: second try, request: 2, hang: {}}
        - {late: 1 s}
        - {hang: {}}
        - {crash: {at_event: 500}}
        """,
    )
    assert [message for _, message in told.logged] == [
        "fault 1 (hang, faults.yaml:4:3) was never applied: no state at root/gasp sent a request to **",
        "second try (hang, faults.yaml:5:3) was never applied: no state made a request number 2 that it matches",
        "fault 4 (hang, faults.yaml:7:3) was never applied: a fault before it was applied instead",
        "fault 5 (crash, faults.yaml:8:3) was never applied: the run has no event 500",
    ]
    assert type(told.events[-1]).__name__ == "RunEnded"


def test_the_event_log_with_faults_is_the_same_twice() -> None:
    """Faults draw from a stream of their own, so the log depends on the seed alone."""
    faults = "- {probability: 0.5, late: 1 s}\n- {probability: 0.5, error: no luck}"
    logs = [encode_event_log(run_with_faults(READ_TWICE, faults, seed=seed).events) for seed in (5, 5, 1, 2, 3, 4)]
    assert (logs[0] == logs[1], len(set(logs)) > 2) == (True, True)
