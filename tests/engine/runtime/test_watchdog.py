"""The watchdog names the state that keeps the event loop, and its line; it leaves virtual time alone."""

from __future__ import annotations

import asyncio
import inspect
import logging
import re
import sys
import threading
import time
from collections.abc import Sequence
from typing import ClassVar

import pytest

from engine.bus import SkillBus
from engine.clock import new_clock, run_virtual
from engine.document import parse_behavior
from engine.event import Event, LoopBlocked, RunEnded
from engine.journal import encode_event_log
from engine.runtime.plan import new_plan
from engine.runtime.run import Run
from engine.runtime.watchdog import LoopStall, LoopWatchdog
from engine.state import Context, Outcome, State
from tests.engine.fake_states import CATALOGUE

BEHAVIOR = """
flexcell: 1
name: blocking
outcomes: [good]
success: [good]
root:
  machine:
    initial: wait
    states:
      wait: {state: test.Give, with: {after_s: 0.1}, transitions: {a: block, b: good, c: good}}
      block: {state: test.Sleep, with: {how: HOW}, transitions: {done: good}}
"""
# Long enough that it is noticed by a thread that gets its turn late.
BLOCKED_S = 1.5


class Sleep(State, frozen=True, kw_only=True):
    """Keep the loop as no state may, in a call of its own or deep in a library; or wait as it should."""

    state_name: ClassVar[str] = "test.Sleep"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    how: str = "itself"

    async def run(self, ctx: Context) -> Outcome:
        match self.how:
            case "itself":
                time.sleep(BLOCKED_S)  # noqa: ASYNC251 - what the watchdog is there for
            case "library":
                threading.Event().wait(BLOCKED_S)
            case _:
                await ctx.clock.sleep(BLOCKED_S)
        return Outcome("done")


def _line_of(text: str) -> str:
    """Return `file:line` of a line of `Sleep.run`."""
    lines, first = inspect.getsourcelines(Sleep.run)
    return f"{__file__}:{first + next(i for i, line in enumerate(lines) if text in line)}"


async def _watched(how: str, *, watched: bool = True) -> tuple[list[Event], list[LoopStall]]:
    plan = new_plan(parse_behavior(BEHAVIOR.replace("HOW", how), file="t.yaml"), {**CATALOGUE, "test.Sleep": Sleep})
    run = Run(plan, run="r", bus=SkillBus(new_clock()))
    events: list[Event] = []
    run.watch(events.append)
    if not watched:
        await run.execute()
        return events, []
    with LoopWatchdog() as watchdog:
        await run.execute()
    return events, list(watchdog.blocks)


def _blocked(events: Sequence[Event]) -> list[LoopBlocked]:
    """Return when the state blocked; a busy machine may keep the loop waiting anywhere else too."""
    return [event for event in events if isinstance(event, LoopBlocked) and event.path == "root/block"]


def _where(blocks: Sequence[LoopStall]) -> list[str]:
    return [block.where for block in blocks if block.path == "root/block"]


def _warnings(caplog: pytest.LogCaptureFixture) -> list[str]:
    messages = [record.getMessage() for record in caplog.records if record.name == "flexcell.watchdog"]
    return [message for message in messages if message.startswith("root/block has blocked the event loop")]


@pytest.mark.parametrize(
    ("how", "text"), [("itself", "time.sleep(BLOCKED_S)"), ("library", "threading.Event().wait(BLOCKED_S)")]
)
def test_a_state_that_blocks_is_named_with_its_line(how: str, text: str, caplog: pytest.LogCaptureFixture) -> None:
    """Logged while it blocks, recorded in its run as soon as the loop is back, before the run ends."""
    events, blocks = asyncio.run(_watched(how))
    (blocked,) = _blocked(events)
    assert blocked.where.endswith(_line_of(text))
    assert ("threading.py" in blocked.where) == (how == "library")
    assert 0.5 < blocked.blocked_s < 60.0
    assert _where(blocks) == [blocked.where]
    assert isinstance(events[-1], RunEnded)
    messages = _warnings(caplog)
    assert re.search(r"event loop for \d+\.\d\d s, at ", messages[0])
    assert messages[0].endswith(blocked.where)


def test_a_state_that_waits_as_it_should_is_left_alone(caplog: pytest.LogCaptureFixture) -> None:
    """The loop sleeps for longer than the threshold, which is no block."""
    events, blocks = asyncio.run(_watched("clock"))
    assert (_blocked(events), _where(blocks), _warnings(caplog)) == ([], [], [])


def test_in_virtual_time_a_block_is_logged_and_not_recorded(caplog: pytest.LogCaptureFixture) -> None:
    """The event log is that of a run that nobody watches."""
    caplog.set_level(logging.INFO, "flexcell.watchdog")
    events, blocks = run_virtual(_watched("itself"))
    unwatched, _ = run_virtual(_watched("itself", watched=False))
    assert _where(blocks) == [_line_of("time.sleep(BLOCKED_S)")]
    assert _warnings(caplog)
    assert encode_event_log(events) == encode_event_log(unwatched)


def test_what_blocks_outside_the_states_is_logged(caplog: pytest.LogCaptureFixture) -> None:
    """A callback of a device or viewer belongs to no run."""

    async def main() -> list[LoopStall]:
        with LoopWatchdog(threshold_s=0.1, idle_look_s=0.1) as watchdog:
            time.sleep(BLOCKED_S)  # noqa: ASYNC251
            await asyncio.sleep(0)
        return list(watchdog.blocks)

    assert [block.path for block in asyncio.run(main()) if block.where.startswith(__file__)] == [""]
    assert "code outside the states has blocked the event loop" in caplog.text


def test_a_stack_that_cannot_be_read_ends_no_watching(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What is given as a frame once is none; the blocks that come later are found."""
    frames, given = sys._current_frames, list[object]()  # pyright: ignore[reportPrivateUsage]

    def once_wrong() -> dict[int, object]:
        if not given:
            given.append(object())
            return dict.fromkeys(frames(), given[0])
        return dict(frames())

    monkeypatch.setattr(sys, "_current_frames", once_wrong)
    events, _ = asyncio.run(_watched("itself"))
    assert len(_blocked(events)) == 1
    assert "the watchdog goes on" in caplog.text
