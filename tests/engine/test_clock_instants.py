"""Timers of the virtual loop at one instant: in the order of asking, whatever else is set."""

from __future__ import annotations

import asyncio
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from engine.clock import run_virtual


def _order(others: list[float]) -> list[int]:
    """Let ten timers ring at one instant, with others set before and between."""
    rung: list[int] = []

    async def main() -> None:
        loop = asyncio.get_running_loop()
        for number in range(10):
            for other in others:
                loop.call_later(other, lambda: None)
            loop.call_later(1.0, rung.append, number)
        await asyncio.sleep(2.0)

    run_virtual(main())
    return rung


@given(others=st.lists(st.floats(0.0, 2.0), max_size=5))
def test_timers_of_one_instant_ring_in_the_order_of_asking(others: list[float]) -> None:
    assert _order(others) == list(range(10))


@pytest.mark.virtual
async def test_sums_that_mean_the_same_instant_are_the_same_instant() -> None:
    """0.1 + 0.2 is 0.30000000000000004."""
    rung: list[str] = []
    loop = asyncio.get_running_loop()
    loop.call_at(0.1 + 0.2, rung.append, "first")
    loop.call_at(0.3, rung.append, "second")
    await asyncio.sleep(0.5)
    assert rung == ["first", "second"]


@pytest.mark.virtual
async def test_a_timer_may_be_set_for_never() -> None:
    timer = asyncio.get_running_loop().call_later(math.inf, lambda: None)
    await asyncio.sleep(1.0)
    timer.cancel()
