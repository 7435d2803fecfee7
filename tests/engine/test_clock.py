"""Virtual time jumps, stands still for threads, steps simulations, and reports a standstill."""

from __future__ import annotations

import asyncio
import contextlib
import math
import threading
import time
from collections.abc import Callable, Coroutine
from typing import Any

import pytest

from engine.clock import OneTurn, VirtualLoop, VirtualTimeDeadlock, new_clock, run_virtual


def test_an_hour_of_sleeps_takes_no_time() -> None:
    """360 sleeps of ten seconds pass in a moment, and the clock shows an hour."""

    async def hour() -> float:
        clock = new_clock()
        for _ in range(360):
            await clock.sleep(10.0)
        return clock.now_s()

    began = time.monotonic()
    assert run_virtual(hour()) == pytest.approx(3600.0)
    assert time.monotonic() - began < 5.0


def test_timers_fire_in_order_of_their_time() -> None:
    """Concurrent sleeps end in the order of their instants, ties in the order of their starts."""

    async def race() -> list[str]:
        order: list[str] = []

        async def sleeper(name: str, duration_s: float) -> None:
            await asyncio.sleep(duration_s)
            order.append(name)

        await asyncio.gather(sleeper("c", 2.0), sleeper("a", 1.0), sleeper("d", 2.0), sleeper("b", 1.5))
        return order

    assert run_virtual(race()) == ["a", "b", "c", "d"]


def test_time_stands_still_while_a_thread_works() -> None:
    """A thread's result arrives before any later timer, however slow the thread is."""

    async def work() -> tuple[str, float]:
        release = threading.Event()
        timer = asyncio.create_task(asyncio.sleep(100.0, "timer"))
        thread = asyncio.create_task(asyncio.to_thread(release.wait, 5.0))
        await asyncio.sleep(0)
        release.set()
        done, _ = await asyncio.wait({timer, thread}, return_when=asyncio.FIRST_COMPLETED)
        timer.cancel()
        return ("thread" if thread in done else "timer"), new_clock().now_s()

    assert run_virtual(work()) == ("thread", 0.0)


def test_a_standstill_is_an_error_that_names_who_waits() -> None:
    """Waiting for what can never come is reported, not hung."""

    async def stuck() -> None:
        await asyncio.get_running_loop().create_future()

    with pytest.raises(VirtualTimeDeadlock, match=r"virtual time cannot advance at t=0.000 s: .* \(waiting: main\)"):
        run_virtual(stuck())


class CountingSimulation:
    """Steps a millisecond at a time and wakes `future` at `due_s`."""

    def __init__(self, due_s: float) -> None:
        self.due_s = due_s
        self.time_s = 0.0
        self.future: asyncio.Future[float] = asyncio.get_running_loop().create_future()

    @property
    def busy(self) -> bool:
        return not self.future.done()

    def advance(self, until_s: float) -> float:
        while self.time_s + 1e-3 <= until_s + 1e-9:
            self.time_s += 1e-3
            if not self.future.done() and self.time_s >= self.due_s:
                self.future.set_result(self.time_s)
                return self.time_s
        return until_s


def test_a_simulation_is_stepped_to_each_timer_and_no_further() -> None:
    """Physics and timers share one time."""

    async def both() -> tuple[float, float, float]:
        loop = asyncio.get_running_loop()
        assert isinstance(loop, VirtualLoop)
        simulation = CountingSimulation(due_s=0.5)
        loop.attach(simulation)
        await asyncio.sleep(0.2)
        at_timer_s = simulation.time_s
        woke_s = await simulation.future
        return at_timer_s, woke_s, loop.time()

    at_timer_s, woke_s, now_s = run_virtual(both())
    assert (at_timer_s, woke_s, now_s) == (pytest.approx(0.2), pytest.approx(0.5), pytest.approx(0.5))


def test_the_deepest_waiter_for_idleness_goes_first_and_alone() -> None:
    """Containers decide from the inside out within one instant."""

    async def decide() -> list[str]:
        loop = asyncio.get_running_loop()
        assert isinstance(loop, VirtualLoop)
        order: list[str] = []

        async def container(name: str, depth: int) -> None:
            await loop.idle((depth, True))
            order.append(name)
            await asyncio.sleep(0)
            order.append(f"{name} settled")

        await asyncio.gather(container("outer", 1), container("inner", 3), container("middle", 2))
        return order

    assert run_virtual(decide()) == ["inner", "inner settled", "middle", "middle settled", "outer", "outer settled"]


def test_an_exception_of_the_main_coroutine_travels_out() -> None:
    """Errors are not swallowed by the loop."""

    async def broken() -> None:
        await asyncio.sleep(1.0)
        raise ValueError("boom")

    with pytest.raises(ValueError, match="boom"):
        run_virtual(broken())


def test_a_task_left_behind_is_cancelled_with_its_cleanup() -> None:
    """Nothing outlives the loop."""
    cleaned: list[bool] = []

    async def leaver() -> None:
        async def background() -> None:
            try:
                await asyncio.sleep(math.inf)
            finally:
                cleaned.append(True)

        task = asyncio.create_task(background())
        await asyncio.sleep(0)
        assert not task.done()

    run_virtual(leaver())
    assert cleaned == [True]


def test_what_ignores_its_end_does_not_hold_up_the_loop(caplog: pytest.LogCaptureFixture) -> None:
    """It is named; what main returned is not lost."""

    async def deaf() -> None:
        while True:
            with contextlib.suppress(asyncio.CancelledError):
                await asyncio.sleep(3600.0)

    left: list[asyncio.Task[None]] = []

    async def main() -> int:
        left.append(asyncio.create_task(deaf(), name="deaf one"))
        await asyncio.sleep(1.0)
        return 5

    assert run_virtual(main()) == 5
    assert "closed while deaf one has not ended after its cancellation" in caplog.text


async def _awaited_turn() -> None:
    await OneTurn()


@pytest.mark.parametrize("work", [OneTurn, _awaited_turn, lambda: asyncio.sleep(0)])
def test_a_turn_goes_round_once_as_a_sleep_of_no_time_does(work: Callable[[], Coroutine[Any, Any, None]]) -> None:
    """Awaited, and as the work of a task."""

    async def main() -> list[str]:
        order: list[str] = []
        task = asyncio.create_task(work())
        task.add_done_callback(lambda _: order.append("task"))
        for number in range(4):
            asyncio.get_running_loop().call_soon(order.append, f"before {number}")
            await work()
            order.append(f"after {number}")
        return order

    assert run_virtual(main()) == [
        "before 0", "after 0", "before 1", "after 1", "task", "before 2", "after 2", "before 3", "after 3",
    ]  # fmt: skip


def test_a_task_that_takes_a_turn_can_be_cancelled() -> None:
    async def main() -> bool:
        task = asyncio.create_task(OneTurn())
        await asyncio.sleep(0)
        task.cancel()
        await asyncio.wait({task})
        return task.cancelled()

    assert run_virtual(main())


def test_a_turn_that_nobody_takes_is_closed_without_a_word() -> None:
    OneTurn().close()
