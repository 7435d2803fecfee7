"""A failure by an outcome that was nominal names the node that had it; after a crash too."""

from __future__ import annotations

import pytest

from engine.bus import SkillBus
from engine.cause_chain import describe_cause
from engine.clock import new_clock, run_virtual
from engine.errors import Cause
from engine.event import Event
from engine.runtime.history.resume import read_history, resume_checkpoint
from engine.runtime.plan import Plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from tests.engine.run_document import plan_of, run_document

LOOKED_FOR = """
root:
  machine:
    initial: search
    states:
      search:
        machine:
          initial: look
          states:
            look: {state: test.Give, with: {outcome: b}, transitions: {a: found, b: nothing, c: nothing}}
        transitions: {found: good, nothing: back}
      back: {state: test.Give, with: {after_s: 1}, transitions: {a: bad, b: bad, c: bad}}
"""
AFTER_A_FAILURE = """
root:
  machine:
    initial: begin
    states:
      begin: {state: test.Give, transitions: {a: check, b: bad, c: bad}}
      check: {state: test.Give, with: {outcome: c}, transitions: {a: good, b: good, c: bad}}
"""
GUARDED = """
userdata: {open: false}
root:
  machine:
    initial: enter
    states:
      enter: {state: test.Give, guard: {when: "${open}", to: bad}, transitions: {a: good, b: good, c: good}}
"""
SIDE_BY_SIDE = """
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            left: {state: test.Give, with: {outcome: b}}
            right: {state: test.Give}
          conditions: [{held: {left: a, right: a}}, {empty: {left: b}}]
          otherwise: empty
        transitions: {held: good, empty: bad}
"""
ROUNDS = """
root:
  machine:
    initial: each
    states:
      each:
        foreach: {items: ITEMS, next: [b], child: {state: test.Give, with: {outcome: b}}}
        transitions: {exhausted: bad, broken: good}
"""


CAUSED = """
root:
  machine:
    initial: try
    states:
      try: {state: test.Give, with: {outcome: c}, transitions: {a: good, b: good, c: tidy}}
      tidy: {state: test.Give, with: {after_s: 1}, transitions: {a: bad, b: bad, c: bad}}
"""


def links_of(cause: Cause | None) -> list[str]:
    """A chain from the inside out."""
    return describe_cause(cause).split(", so ") if cause is not None else []


def gone_on(plan: Plan, events: tuple[Event, ...]) -> RunResult:
    """How a run ends whose engine died after these events."""

    async def main() -> RunResult:
        checkpoint = resume_checkpoint(
            read_history(plan, "r", events), plan, answers={}, last_seq=events[-1].seq, epoch=2
        )
        async with SkillBus(new_clock()) as bus:
            return await Run(plan, run="r", bus=bus, checkpoint=checkpoint).execute()

    return run_virtual(main())


@pytest.mark.parametrize(
    ("text", "links"),
    [
        (
            LOOKED_FOR,
            ["root/search/look ended with b", "root/search ended with nothing", "root ended with bad"],
        ),
        (AFTER_A_FAILURE, ["root/check ended with c", "root ended with bad"]),
        (GUARDED, ["root/enter: the guard is closed", "root/enter was left for bad", "root ended with bad"]),
        (SIDE_BY_SIDE, ["root/both/left ended with b", "root/both ended with empty", "root ended with bad"]),
        (
            ROUNDS.replace("ITEMS", "[1, 2]"),
            ["root/each/child ended with b", "root/each ended with exhausted", "root ended with bad"],
        ),
        (
            ROUNDS.replace("ITEMS", "[]"),
            ["root/each: there was no item to iterate over", "root/each ended with exhausted", "root ended with bad"],
        ),
    ],
)
def test_the_chain_goes_down_to_the_node_that_decided(text: str, links: list[str]) -> None:
    """Not only to the container whose outcome is called a failure further out."""
    result = run_document(text).result
    assert (result.status, result.outcome, links_of(result.cause)) == ("finished", "bad", links)


@pytest.mark.parametrize(
    "text", [LOOKED_FOR, AFTER_A_FAILURE, GUARDED, SIDE_BY_SIDE, ROUNDS.replace("ITEMS", "[1, 2]"), CAUSED]
)
def test_a_run_that_is_resumed_at_any_event_tells_the_same(text: str) -> None:
    told = run_document(text)
    plan = plan_of(text)
    for count in range(1, len(told.events)):
        assert links_of(gone_on(plan, told.events[:count]).cause) == links_of(told.result.cause), count
