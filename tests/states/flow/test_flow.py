"""The states of control flow."""

from __future__ import annotations

import msgspec
import pytest

from engine.errors import Cause
from engine.state import Outcome
from states.flow.decide import Decide
from states.flow.log import Log
from states.flow.set_value import SetValue
from states.flow.wait import Wait
from tests.states.fake_context import FakeContext


@pytest.mark.virtual
async def test_wait_lets_exactly_its_duration_pass() -> None:
    """An hour of the run's clock, not of ours."""
    ctx = FakeContext()
    assert await Wait(duration_s=3600.0).run(ctx) == Outcome("done")
    assert ctx.clock.now_s() == pytest.approx(3600.0)


def test_a_negative_wait_is_refused() -> None:
    """The parameter's range is part of its type."""
    with pytest.raises(msgspec.ValidationError, match="duration_s"):
        msgspec.convert({"duration_s": -1}, Wait)


async def test_log_writes_its_line_at_its_level() -> None:
    """The message goes into the event log as it is."""
    ctx = FakeContext()
    assert await Log(message="half way", level="warning").run(ctx) == Outcome("done")
    assert ctx.logged == [("warning", "half way")]


async def test_decide_gives_the_outcome_its_condition_names() -> None:
    """True and false, and false says so."""
    assert await Decide(when=True).run(FakeContext()) == Outcome("true")
    cause = Cause(message="the condition is false", where="root/step", kind="flow.Decide")
    assert await Decide(when=False).run(FakeContext()) == Outcome("false", {}, cause)


@pytest.mark.parametrize("value", [None, 0.5, "text", [1, {"a": 2}]])
async def test_set_value_writes_any_value(value: object) -> None:
    """Whatever is given comes out under `value`."""
    state = msgspec.convert({"value": value}, SetValue)
    assert await state.run(FakeContext()) == Outcome("done", {"value": value})
