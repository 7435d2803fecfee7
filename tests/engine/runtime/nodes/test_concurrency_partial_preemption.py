"""Conditions of a concurrency container that preempt some branches, while the others go on."""

from __future__ import annotations

import pytest

from engine.event import BranchesPreempted
from tests.engine.run_document import ObservedRun, run_document

LOST = "camera: {state: test.Give, with: {outcome: a, after_s: 1.0}}"
LIGHT = "light: {state: test.Give, with: {outcome: b, after_s: 5.0}}"
HANGING = "mover: {state: test.Hang, with: {cleanup_s: 2.0}}"
PREEMPT = "{preempt: [mover], when: {camera: a}}"


def _run(*branches: str, conditions: str, more: str = "otherwise: bad", stop_at_s: float | None = None) -> ObservedRun:
    states = "\n".join(f"              {branch}" for branch in branches)
    return run_document(
        f"""
        root:
          concurrency:
            states:
{states}
            conditions: [{conditions}]
            {more}
        """,
        stop_at_s=stop_at_s,
    )


def _fired(told: ObservedRun) -> list[tuple[float, str, tuple[str, ...]]]:
    return [(e.time_s, e.condition, e.branches) for e in told.events if isinstance(e, BranchesPreempted)]


def test_only_the_branches_that_a_condition_names_are_preempted() -> None:
    """The camera is lost at t=1, the mover cleans up until t=3, the light decides at t=5."""
    told = _run(HANGING, LOST, LIGHT, conditions=f"{PREEMPT}, {{good: {{light: b}}}}")
    assert told.lines == [
        "+root", "+root/mover", "+root/camera", "+root/light", "-root/camera a",
        "!root/mover cleaned up", "-root/mover preempted", "-root/light b", "-root good",
    ]  # fmt: skip
    assert _fired(told) == [(1.0, "preempt mover when camera=a", ("mover",))]
    assert [e.time_s for e in told.events][-2:] == [5.0, 5.0]


def test_a_preempted_branch_has_ended_and_has_no_outcome() -> None:
    """All have finished then, and `otherwise` says who was preempted; its clean-up is waited for until t=3."""
    told = _run(HANGING, LOST, conditions=f"{PREEMPT}, {{good: {{camera: a, mover: b}}}}")
    assert (told.result.outcome, told.result.duration_s) == ("bad", pytest.approx(3.0))
    assert told.result.cause is not None
    assert told.result.cause.chain()[-1].message == "no condition matches (camera: a, mover: preempted)"


def test_without_otherwise_the_error_names_who_was_preempted() -> None:
    told = _run(HANGING, LOST, conditions=PREEMPT, more="")
    assert told.result.status == "errored"
    assert told.result.cause is not None
    assert "all children have finished (camera: a, mover: preempted) and no" in told.result.cause.message


def test_a_condition_that_decides_goes_before_those_that_preempt() -> None:
    """Both hold at t=1: the container ends, and with it all branches, as without the other condition."""
    told = _run(HANGING, LOST, LIGHT, conditions=f"{PREEMPT}, {{good: {{camera: a}}}}")
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(3.0))
    assert told.lines[-3:] == ["!root/mover cleaned up", "-root/mover preempted", "-root good"]
    assert _fired(told) == []


def test_a_branch_that_has_ended_is_left_as_it_is() -> None:
    """It ended with an outcome at the very instant at which the condition first held; that outcome counts."""
    told = _run(
        "mover: {state: test.Give, with: {outcome: c, after_s: 1.0}}", LOST, LIGHT,
        conditions=f"{PREEMPT}, {{good: {{light: b, mover: c}}}}",
    )  # fmt: skip
    assert told.result.outcome == "good"
    assert _fired(told) == [(1.0, "preempt mover when camera=a", ())]


def test_conditions_of_one_instant_preempt_in_the_order_of_the_branches() -> None:
    """A condition fires once; whom another has preempted is not preempted again."""
    told = _run(
        "one: {state: test.Hang}", "two: {state: test.Hang}", LOST, LIGHT,
        conditions="{preempt: [two, one], when: {camera: a}}, "
        "{preempt: [one], when: {camera: a, light: b, at_least: 1}}, {good: {light: b}}",
    )  # fmt: skip
    assert [(time_s, names) for time_s, _, names in _fired(told)] == [(1.0, ("one", "two")), (1.0, ())]
    assert [line for line in told.lines if "preempted" in line] == ["-root/one preempted", "-root/two preempted"]


def test_what_ends_first_may_end_those_that_a_condition_counts() -> None:
    """The first of three that is done is enough, and the container goes on with what runs beside them."""
    told = _run(
        "one: {state: test.Hang}", LOST, LIGHT,
        conditions="{preempt: [one, camera], when: {one: a, camera: a, at_least: 1}}, {good: {light: b}}",
    )  # fmt: skip
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(5.0))
    assert _fired(told) == [(1.0, "preempt one, camera when 1 of one=a, camera=a", ("one",))]


def test_a_container_that_decides_waits_for_who_cleans_up_and_asks_once() -> None:
    """The mover was asked at t=1 and cleans up until t=9; the light decides at t=5."""
    told = _run(
        "mover: {state: test.Hang, with: {cleanup_s: 8.0}}",
        LOST,
        LIGHT,
        conditions=f"{PREEMPT}, {{good: {{light: b}}}}",
    )
    assert told.lines[4:] == [
        "-root/camera a", "-root/light b", "!root/mover asked to stop 5 s ago and still cleaning up",
        "!root/mover cleaned up", "-root/mover preempted", "-root good",
    ]  # fmt: skip
    assert told.result.duration_s == pytest.approx(9.0)


def test_a_clean_up_that_fails_is_an_error_of_the_container_at_once() -> None:
    """The light is preempted; nobody asks for more."""
    told = _run("mover: {state: test.Messy}", LOST, LIGHT, conditions=f"{PREEMPT}, {{good: {{light: b}}}}")
    assert (told.result.status, told.result.duration_s) == ("errored", pytest.approx(1.0))
    assert told.lines[-2:] == ["-root/light preempted", "-root error"]


def test_a_branch_that_never_cleans_up_is_abandoned_once_and_named() -> None:
    """Thirty seconds and the grace of its depth after it was asked, though the container decided meanwhile."""
    told = _run("mover: {state: test.Deaf}", LOST, LIGHT, conditions=f"{PREEMPT}, {{good: {{light: b}}}}")
    assert (told.result.status, told.result.abandoned) == ("errored", ("root/mover",))
    assert told.result.duration_s == pytest.approx(33.0)


def test_a_branch_that_never_cleans_up_ends_a_container_that_goes_on() -> None:
    """Nothing else would end it before t=100."""
    told = _run(
        "mover: {state: test.Deaf}", LOST, "light: {state: test.Give, with: {outcome: b, after_s: 100.0}}",
        conditions=f"{PREEMPT}, {{good: {{light: b}}}}",
    )  # fmt: skip
    assert (told.result.status, told.result.abandoned) == ("errored", ("root/mover",))
    assert told.result.duration_s == pytest.approx(33.0)


@pytest.mark.parametrize("stop_at_s", [1.0, 2.0, 4.0])
def test_a_stop_lets_everybody_clean_up_once(stop_at_s: float) -> None:
    """Before, while and after a branch cleans up for a condition."""
    told = _run(HANGING, LOST, LIGHT, conditions=f"{PREEMPT}, {{good: {{light: b}}}}", stop_at_s=stop_at_s)
    assert told.result.status == "stopped"
    assert [line for line in told.lines if "cleaned up" in line] == ["!root/mover cleaned up"]
    assert told.result.duration_s == pytest.approx(max(3.0, stop_at_s))


def test_a_timeout_around_waits_for_who_cleans_up() -> None:
    told = run_document(f"""
        root:
          machine:
            initial: both
            states:
              both:
                concurrency:
                  states:
                    {HANGING}
                    {LOST}
                    {LIGHT}
                  conditions: [{PREEMPT}, {{good: {{light: b}}}}]
                timeout: {{after: 2.0, to: bad}}
                transitions: {{good: good}}
    """)
    assert (told.result.outcome, told.result.duration_s) == ("bad", pytest.approx(3.0))


def test_neither_retry_nor_on_error_of_a_preempted_branch_runs_it_again() -> None:
    """It waits for its second attempt when the condition first holds."""
    told = _run(
        "mover: {state: test.Raise, retry: {times: 3, backoff: 10.0}, on_error: late}", LOST, LIGHT,
        conditions=f"{PREEMPT}, {{good: {{light: b}}}}",
    )  # fmt: skip
    assert told.result.outcome == "good"
    assert told.lines.count("+root/mover") == 1


def test_what_a_preempted_branch_has_written_is_merged_with_the_others() -> None:
    told = run_document(f"""
        flexcell: 1
        name: test
        outcomes: [good]
        userdata: {{value: nothing}}
        root:
          concurrency:
            states:
              mover:
                machine:
                  initial: write
                  states:
                    write: {{state: test.Write, with: {{value: from mover}}, transitions: {{done: hang}}}}
                    hang: {{state: test.Hang, transitions: {{done: end}}}}
              {LOST}
              {LIGHT}
            conditions: [{PREEMPT}, {{good: {{light: b}}}}]
    """)
    assert told.result.userdata["value"] == "from mover"


def test_a_container_is_fresh_when_it_is_entered_again() -> None:
    """The condition fires in each of two rounds."""
    told = run_document(f"""
        root:
          machine:
            initial: twice
            states:
              twice:
                foreach:
                  times: 2
                  child:
                    concurrency:
                      states:
                        {HANGING}
                        {LOST}
                        {LIGHT}
                      conditions: [{PREEMPT}, {{good: {{light: b}}}}]
                  next: [good]
                transitions: {{exhausted: good, broken: bad}}
    """)
    assert told.result.outcome == "good"
    assert [time_s for time_s, _, _ in _fired(told)] == [1.0, 6.0]
