"""Checks that end at once follow one another on the spot; one that waits has a task of its own, from its first step."""

from __future__ import annotations

import asyncio
import gc
from collections.abc import Callable
from typing import Any, ClassVar

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.errors import StateError
from engine.event import Event, NodeEntered
from engine.runtime.plan import Plan, new_plan
from engine.runtime.run import Run
from engine.runtime.tree.tree_leaf import TreeLeaf
from engine.state import Context, Outcome, State
from tests.engine.runtime.tree.run_tree import HEAD

_DONE: list[str] = []
"""What the states of a test have done."""


class Note(State, frozen=True, kw_only=True):
    """End at once."""

    state_name: ClassVar[str] = "test.Note"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        _DONE.append(ctx.path.rpartition("/")[2])
        return Outcome("done")


class Limited(State, frozen=True, kw_only=True):
    """Open a time limit in the first step, and wait until it is over."""

    state_name: ClassVar[str] = "test.Limited"
    outcomes: ClassVar[tuple[str, ...]] = ("late",)

    async def run(self, ctx: Context) -> Outcome:
        try:
            async with asyncio.timeout(1.0):
                await asyncio.get_running_loop().create_future()
        except TimeoutError:
            _DONE.append("late")
        return Outcome("late")


class EndTask(State, frozen=True, kw_only=True):
    """Have the task that it runs in end, and end without having waited."""

    state_name: ClassVar[str] = "test.EndTask"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        task = asyncio.current_task()
        assert task is not None
        task.cancel()
        return Outcome("done")


class Fail(State, frozen=True, kw_only=True):
    """Raise an error."""

    state_name: ClassVar[str] = "test.Fail"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        _DONE.append(ctx.path.rpartition("/")[2])
        raise StateError("broken", where=ctx.path)


class Move(State, frozen=True, kw_only=True):
    """Command a device for a second: no check."""

    state_name: ClassVar[str] = "test.Move"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    def resources(self) -> tuple[str, ...]:
        return ("arm",)

    async def run(self, ctx: Context) -> Outcome:
        await ctx.clock.sleep(1.0)
        return Outcome("done")


_CATALOGUE: dict[str, type[State]] = {each.state_name: each for each in (Note, Limited, EndTask, Fail, Move)}


def _plan(kind: str, *states: str) -> Plan:
    leaves = "".join(f"\n      - {{name: c{index}, state: test.{state}}}" for index, state in enumerate(states))
    return new_plan(parse_behavior(f"{HEAD}root:\n  tree:\n    {kind}:{leaves}\n", file="t.yaml"), _CATALOGUE)


def _run(plan: Plan, begin: Callable[[Run], None] = lambda run: None) -> str | None:
    """Run in virtual time; return the outcome, or how the run ended without one."""
    _DONE.clear()

    async def main() -> str | None:
        run = Run(plan, run="r", bus=SkillBus(new_clock()))
        begin(run)
        result = await run.execute()
        return result.outcome or result.status

    return run_virtual(main())


def test_they_share_a_task() -> None:
    tasks: list[asyncio.Task[Any]] = []

    def made(loop: asyncio.AbstractEventLoop, work: Any, **options: Any) -> asyncio.Task[Any]:
        tasks.append(asyncio.Task(work, loop=loop, **options))
        return tasks[-1]

    def begin(run: Run) -> None:
        asyncio.get_running_loop().set_task_factory(made)

    assert _run(_plan("sequence", "Note", "Note", "Note"), begin) == "success"
    assert _DONE == ["c0", "c1", "c2"]
    assert sum(task.get_name().startswith("root/") for task in tasks) == 1


def test_what_one_opens_in_its_first_step_belongs_to_it_and_not_to_the_tree_or_those_after_it() -> None:
    assert _run(_plan("parallel", "Note", "Limited", "Note", "Limited", "Note")) == "success"
    assert _DONE == ["c0", "c2", "c4", "late", "late"]


def test_among_many_everybody_else_has_a_turn() -> None:
    count = 1000

    def begin(run: Run) -> None:
        loop = asyncio.get_running_loop()
        loop.call_soon(lambda: loop.call_soon(lambda: loop.call_soon(lambda: run.stop("enough"))))

    assert _run(_plan("sequence", *["Note"] * count), begin) == "stopped"
    assert 0 < len(_DONE) < count


def test_each_of_many_runs_once_though_others_have_turns_in_between() -> None:
    assert _run(_plan("sequence", *["Note"] * 1000)) == "success"
    assert [f"c{index}" for index in range(1000)] == _DONE


def test_each_has_a_task_in_which_an_operator_finds_it() -> None:
    found: list[tuple[str, str]] = []

    def begin(run: Run) -> None:
        def look(event: Event) -> None:
            task = asyncio.current_task()
            if isinstance(event, NodeEntered) and event.path.startswith("root/") and task is not None:
                found.append((event.path, task.get_name()))

        run.watch(look)

    _run(_plan("sequence", "Note", "Note", "Limited"), begin)
    assert found == [(path, path) for path in ("root/sequence/c0", "root/sequence/c1", "root/sequence/c2")]


def test_what_one_raises_is_caught_where_it_stands_and_is_tried_again() -> None:
    leaves = "{name: c0, state: test.Note}, {name: c1, state: test.Fail}"
    text = f"{HEAD}root: {{tree: {{retry: {{times: 1, child: {{sequence: [{leaves}]}}}}}}}}\n"
    assert _run(new_plan(parse_behavior(text, file="t.yaml"), _CATALOGUE)) == "errored"
    assert _DONE == ["c0", "c1", "c0", "c1"]


def test_nothing_of_a_tree_that_has_ended_waits_for_the_collector() -> None:
    plan = _plan("sequence", *["Note"] * 10)
    _run(plan)
    gc.collect()
    gc.disable()
    try:
        _run(plan)
        # Dead weak references of other tests answer `isinstance` with an error.
        assert not [each for each in gc.get_objects() if type(each) is TreeLeaf]
    finally:
        gc.enable()


def test_one_that_has_its_task_end_ends_no_other() -> None:
    alone = _run(_plan("sequence", "EndTask"))
    assert _run(_plan("sequence", "Note", "EndTask", "Note")) == alone
    assert _DONE == ["c0"]


def test_between_ticks_no_task_but_those_of_leaves_at_work_is_left() -> None:
    names: list[str] = []

    def look() -> None:
        names.extend(sorted(task.get_name() for task in asyncio.all_tasks()))

    plan = _plan("sequence", "Note", "Move")
    assert _run(plan, lambda run: asyncio.get_running_loop().call_later(0.5, look) and None) == "success"
    assert names == ["main", "root", "root/sequence/c1"]


def test_who_watches_later_hears_the_numbers_of_who_watched_from_the_start() -> None:
    plan = _plan("sequence", "Note", "Limited", "Note")
    everything: list[Event] = []
    late: list[Event] = []
    _run(plan, lambda run: run.watch(everything.append))
    _run(plan, lambda run: asyncio.get_running_loop().call_later(0.5, run.watch, late.append) and None)
    assert late == everything[-len(late) :] != everything
