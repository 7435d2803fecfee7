"""On a real clock a container decides when all in its run waits for something that is yet to come."""

from __future__ import annotations

import asyncio
from typing import ClassVar

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock
from engine.document import parse_behavior
from engine.event import BranchesPreempted, Event
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.run_result import RunResult
from engine.state import Context, Outcome, State

TEXT = """
flexcell: 1
name: test
outcomes: [both, one, other]
success: [both, one, other]
root:
  concurrency:
    states:
      slow: {state: test.Hops, with: {hops: HOPS}}
      fast: {state: test.Hops, with: {hops: 0}}
    conditions:
      - {both: {slow: done, fast: done}}
      - {one: {fast: done}}
      - {other: {slow: done}}
"""
PREEMPTING = (
    TEXT[: TEXT.index("    conditions:")]
    + """
      never: {state: test.Hops, with: {hops: -1}}
    conditions:
      - {preempt: [slow, never], when: {fast: done}}
      - {one: {never: done}}
    otherwise: other
"""
)
GO: list[asyncio.Event] = []


class Hops(State, frozen=True, kw_only=True):
    """Wait for the start, then take so many turns of the loop; negative: until it is preempted."""

    state_name: ClassVar[str] = "test.Hops"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    hops: int

    async def run(self, ctx: Context) -> Outcome:
        await GO[0].wait()
        left = self.hops
        while left:
            # A task for each turn, as futures that wait for one another take them.
            await asyncio.create_task(asyncio.sleep(0))
            left -= 1
        return Outcome("done")


async def _run(hops: int) -> RunResult:
    GO[:] = [asyncio.Event()]
    plan = new_plan(parse_behavior(TEXT.replace("HOPS", str(hops)), file="t.yaml"), {"test.Hops": Hops})
    async with SkillBus(new_clock()) as bus:
        asyncio.get_running_loop().call_soon(GO[0].set)
        return await Run(plan, run="r", bus=bus).execute()


@pytest.mark.parametrize("hops", [0, 1, 7, 9, 50])
async def test_what_is_under_way_to_its_end_ends_at_the_same_instant(hops: int) -> None:
    """However many turns of the loop that takes: nothing else is waited for."""
    assert (await _run(hops)).outcome == "both"


async def test_a_branch_that_is_never_quiet_holds_up_no_decision() -> None:
    """It goes round and round in the loop without waiting; it is preempted like any other."""
    async with asyncio.timeout(30.0):
        assert (await _run(-1)).outcome == "one"


async def test_others_on_the_loop_hold_up_nothing() -> None:
    """Another run, a server or a device that is always busy belongs to somebody else."""
    turns = 0

    async def spin() -> None:
        nonlocal turns
        while True:
            await asyncio.sleep(0)
            turns += 1

    spinning = asyncio.create_task(spin())
    assert (await _run(3)).outcome == "both"
    # It was decided when the run was quiet, not given up after a time.
    assert turns < 200
    spinning.cancel()


@pytest.mark.parametrize("hops", [0, 1, 7, 50])
async def test_a_condition_preempts_only_what_has_not_ended_at_its_instant(hops: int) -> None:
    """However many turns of the loop the end of another branch of that instant takes."""
    GO[:] = [asyncio.Event()]
    behavior = parse_behavior(PREEMPTING.replace("HOPS", str(hops)), file="t.yaml")
    events: list[Event] = []
    async with SkillBus(new_clock()) as bus:
        asyncio.get_running_loop().call_soon(GO[0].set)
        run = Run(new_plan(behavior, {"test.Hops": Hops}), run="r", bus=bus)
        run.watch(events.append)
        result = await run.execute()
    assert result.outcome == "other"
    assert [event.branches for event in events if isinstance(event, BranchesPreempted)] == [("never",)]
