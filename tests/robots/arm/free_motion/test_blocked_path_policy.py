"""Patience, pauses between searches, and longer and longer rests."""

from __future__ import annotations

import pytest

from engine.clock import new_clock
from robots.arm.free_motion.blocked_path_policy import BlockedPathPolicy


@pytest.mark.virtual
async def test_patience_counts_each_wait_and_the_total_all_of_them() -> None:
    clock = new_clock()
    waiting = BlockedPathPolicy(clock, patience_s=2.0)
    assert (waiting.is_over, waiting.total_s) == (False, 0.0)
    for total_s in (1.5, 3.0):
        waiting.begin()
        await clock.sleep(1.5)
        waiting.begin()
        assert waiting.is_over is False
        waiting.end()
        await clock.sleep(1.0)
        assert waiting.total_s == pytest.approx(total_s)
    waiting.begin()
    await clock.sleep(2.0)
    assert waiting.is_over is True


@pytest.mark.virtual
async def test_searches_become_rarer_until_something_changes_and_take_half_of_the_time_at_most() -> None:
    clock = new_clock()
    waiting = BlockedPathPolicy(clock, patience_s=100.0)
    pauses: list[float] = []
    for number in range(12):
        if number == 8:
            waiting.something_changed()
        took_s = 0.9 if number == 9 else 0.0
        waiting.searched(took_s=took_s)
        began_s = clock.now_s()
        while not waiting.may_search:
            await clock.sleep(0.01)
        pauses.append(round(clock.now_s() - began_s, 2))
    assert pauses == pytest.approx([0.2, 0.4, 0.8, 1.6, 3.2, 5.0, 5.0, 5.0, 0.2, 0.9, 0.8, 1.6], abs=0.011)


@pytest.mark.virtual
async def test_after_many_stops_an_arm_rests_before_it_goes_on() -> None:
    clock = new_clock()
    waiting = BlockedPathPolicy(clock, patience_s=100.0)
    rests: list[float] = []
    for stops in (1, 3, 4, 5, 6, 20):
        waiting.rest()
        began_s = clock.now_s()
        while not waiting.has_rested(stops=stops):
            await clock.sleep(0.01)
        rests.append(round(clock.now_s() - began_s, 2))
    assert rests == pytest.approx([0.0, 0.0, 0.2, 0.4, 0.8, 3.0], abs=0.011)
