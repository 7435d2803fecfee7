"""Branches that a condition has preempted, when the engine dies or somebody starts from a moment of the run."""

from __future__ import annotations

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.event import BranchesPreempted, Event, NodeEntered, NodeExited
from engine.journal import decode_event, encode_event
from engine.runtime.history.checkpoint import Checkpoint
from engine.runtime.history.resumable_state import ResumableState
from engine.runtime.history.resume import start_checkpoint
from engine.runtime.plan import Plan
from engine.runtime.run import Run
from tests.engine.run_document import ObservedRun, plan_of, run_document

TEXT = """
    root:
      concurrency:
        states:
          mover: MOVER
          camera: {state: test.Give, with: {after_s: 1}}
          light: {state: test.Give, with: {after_s: 5}}
        conditions: [{preempt: [mover], when: {camera: a}}, {good: {light: a}}]
        otherwise: bad
"""
HANGING = TEXT.replace("MOVER", "{state: test.Hang, with: {cleanup_s: 2}}")
MESSY = TEXT.replace("MOVER", "{state: test.Messy}")
TRYING = TEXT.replace("MOVER", "{state: test.Raise, retry: {times: 9, backoff: 10}}")


def _go_on(plan: Plan, checkpoint: Checkpoint, *, run: str = "r") -> ObservedRun:
    async def main() -> ObservedRun:
        events: list[Event] = []
        async with SkillBus(new_clock()) as bus:
            made = Run(plan, run=run, bus=bus, checkpoint=checkpoint)
            made.watch(events.append)
            return ObservedRun(await made.execute(), tuple(events))

    return run_virtual(main())


def _history(plan: Plan, events: list[Event], *, run: str = "r") -> ResumableState:
    return ResumableState(plan, run=run).read([decode_event(encode_event(event)) for event in events])


def _after(text: str, count: int) -> ObservedRun:
    """Go on after so many events of the run."""
    plan = plan_of(text)
    return _go_on(plan, _history(plan, list(run_document(text).events[:count])).checkpoint())


def _place(told: ObservedRun, kind: type[Event], path: str) -> int:
    return next(i for i, e in enumerate(told.events) if isinstance(e, kind) and getattr(e, "path", "") == path) + 1


def _entered(told: ObservedRun) -> list[str]:
    return [event.path for event in told.events if isinstance(event, NodeEntered)]


def test_a_branch_that_had_cleaned_up_is_not_begun_again() -> None:
    whole = run_document(HANGING)
    rest = _after(HANGING, _place(whole, NodeExited, "root/mover"))
    assert (rest.result.outcome, _entered(rest)) == ("good", ["root/light"])


def test_a_branch_that_was_cleaning_up_does_so_from_the_start_and_is_ended() -> None:
    """Its state is entered again, as one in mid-work is, and told to end at once; nothing fires twice."""
    whole = run_document(HANGING)
    rest = _after(HANGING, _place(whole, BranchesPreempted, "root"))
    assert rest.result.outcome == "good"
    assert [line for line in rest.lines if "mover" in line] == [
        "+root/mover", "!root/mover cleaned up", "-root/mover preempted",
    ]  # fmt: skip
    assert not [event for event in rest.events if isinstance(event, BranchesPreempted)]


def test_a_branch_between_two_attempts_had_ended_with_being_preempted() -> None:
    whole = run_document(TRYING)
    rest = _after(TRYING, _place(whole, BranchesPreempted, "root"))
    assert (rest.result.outcome, _entered(rest)) == ("good", ["root/light"])


def test_a_clean_up_that_had_failed_is_still_an_error_of_the_container() -> None:
    whole = run_document(MESSY)
    rest = _after(MESSY, _place(whole, NodeExited, "root/mover"))
    assert (rest.result.status, whole.result.status) == ("errored", "errored")
    assert rest.result.cause is not None
    assert any("in the clean-up" in link.message for link in rest.result.cause.chain())


def test_a_run_that_starts_from_another_branch_leaves_the_preempted_one_ended() -> None:
    """Also the run that goes on with that one after a crash knows it."""
    plan = plan_of(HANGING)
    whole = run_document(HANGING)
    history = _history(plan, list(whole.events[: _place(whole, NodeExited, "root/mover")]))
    other = _go_on(plan, start_checkpoint(history, plan, "root/light"), run="other")
    assert (other.result.outcome, _entered(other)) == ("good", ["root", "root/light"])
    for count in range(_place(other, BranchesPreempted, "root"), len(other.events)):
        rest = _go_on(plan, _history(plan, list(other.events[:count]), run="other").checkpoint(), run="other")
        assert (rest.result.outcome, "root/mover" in _entered(rest)) == ("good", False), other.events[count - 1]


def test_a_run_that_starts_from_the_preempted_branch_lets_it_work() -> None:
    """The condition has fired at that moment, and does so once; the light decides after five more seconds."""
    plan = plan_of(HANGING)
    whole = run_document(HANGING)
    history = _history(plan, list(whole.events[: _place(whole, NodeExited, "root/mover")]))
    other = _go_on(plan, start_checkpoint(history, plan, "root/mover"), run="other")
    assert other.lines == [
        "+root", "+root/mover", "+root/light", "-root/light a",
        "!root/mover cleaned up", "-root/mover preempted", "-root good",
    ]  # fmt: skip
    assert [event.branches for event in other.events if isinstance(event, BranchesPreempted)] == [()]
