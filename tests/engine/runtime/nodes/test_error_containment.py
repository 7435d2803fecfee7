"""Whatever the code of a state raises, wherever it is called: an error of its node, which retries and on_error take."""

from __future__ import annotations

from typing import Any, ClassVar

import pytest

from engine.cause_chain import describe_cause
from engine.errors import Cause
from engine.event import MessageLogged
from engine.journal import decode_event, encode_event
from engine.state import Context, Outcome, State
from tests.engine.run_document import ObservedRun
from tests.engine.runtime.control.operate import operate, pause, resume

HALF = "half a character: \ud83d"
DOCUMENT = """
root:
  machine:
    initial: one
    states:
      one: {state: NAME, transitions: {done: good} MORE}
"""


class Greedy(State, frozen=True, kw_only=True):
    """Cannot say what it leases."""

    state_name: ClassVar[str] = "test.Greedy"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    def resources(self) -> tuple[str, ...]:
        raise KeyError("arm")

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("done")


class Stillborn(State, frozen=True, kw_only=True):
    """Ends the program when it is made."""

    state_name: ClassVar[str] = "test.Stillborn"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    def __post_init__(self) -> None:
        raise SystemExit(3)

    async def run(self, ctx: Context) -> Outcome:
        return Outcome("done")


class Sloppy(State, frozen=True, kw_only=True):
    """Gives outputs that are no mapping."""

    state_name: ClassVar[str] = "test.Sloppy"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        outputs: Any = ["value"]
        return Outcome("done", outputs)


class Sulky(State, frozen=True, kw_only=True):
    """Ends the program when it is paused."""

    state_name: ClassVar[str] = "test.Sulky"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)

    async def on_pause(self, ctx: Context) -> None:
        raise SystemExit(3)

    async def run(self, ctx: Context) -> Outcome:
        await ctx.clock.sleep(1.0)
        return Outcome("done")


class Mumbling(State, frozen=True, kw_only=True):
    """Says what no UTF-8 holds: in the log, and as its cause or its exception."""

    state_name: ClassVar[str] = "test.Mumbling"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    raises: bool = False

    async def run(self, ctx: Context) -> Outcome:
        ctx.log(HALF)
        if self.raises:
            raise RuntimeError(HALF)
        return Outcome("done", cause=Cause(message="outer", because=Cause(message=HALF, where=HALF)))


STATES: dict[str, type[State]] = {kind.state_name: kind for kind in (Greedy, Stillborn, Sloppy, Sulky, Mumbling)}


def run(kind: type[State], *, more: str = "") -> ObservedRun:
    """Run one state of this kind."""
    return operate(DOCUMENT.replace("NAME", kind.state_name).replace("MORE", more), {}, states=STATES)


@pytest.mark.parametrize("kind", [Greedy, Stillborn, Sloppy])
def test_what_is_no_error_of_flexcell_ends_the_run_and_names_the_node(kind: type[State]) -> None:
    told = run(kind)
    cause = told.result.cause
    assert (told.result.status, cause is not None and "root/one at " in cause.nodes[0]) == ("errored", True)


@pytest.mark.parametrize("kind", [Greedy, Stillborn, Sloppy])
def test_retry_and_on_error_take_it(kind: type[State]) -> None:
    told = run(kind, more=", retry: {times: 2, errors: true}, on_error: bad")
    assert told.result.outcome == "bad"
    assert len([line for line in told.lines if line == "-root/one error"]) == 3


def test_a_pause_goes_on_whatever_a_state_raises_when_it_is_notified() -> None:
    acts = {0.5: pause, 2.5: resume}
    told = operate(DOCUMENT.replace("NAME", "test.Sulky").replace("MORE", ""), acts, states=STATES)
    assert (told.result.outcome, told.result.duration_s) == ("good", pytest.approx(3.0))


@pytest.mark.parametrize("raises", [False, True])
def test_half_a_character_is_written_out_in_every_event(raises: bool) -> None:
    told = run(Mumbling, more=f", with: {{raises: {str(raises).lower()}}}")
    assert [decode_event(encode_event(event)) for event in told.events] == list(told.events)
    assert "half a character: \\ud83d" in [event.message for event in told.events if isinstance(event, MessageLogged)]
    if raises:
        assert "half a character: \\ud83d" in describe_cause(told.result.cause or Cause(message=""))
