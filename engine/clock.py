"""The time of a run: real time, or virtual time that jumps to the next timer.

The event loop is the clock: `LoopClock` only reads its time. A `VirtualLoop` never waits:
when no callback is ready, time jumps to the next timer, and every simulation attached to the
loop is stepped up to it first. Virtual time is frozen while worker threads work, so their
results arrive at a definite instant.
"""

from __future__ import annotations

import asyncio
import logging
import math
import selectors
from collections.abc import Callable, Coroutine, Iterator
from concurrent.futures import Executor
from contextvars import Context
from functools import partial
from typing import Any, NoReturn, Protocol, TypeVar

from engine.errors import FlexcellError

T = TypeVar("T")
_log = logging.getLogger(__name__)


class Clock(Protocol):
    """The clock of states, runs and devices."""

    @property
    def virtual(self) -> bool:
        """True when time is virtual and passes without waiting."""
        ...

    def now_s(self) -> float:
        """Seconds since the clock started."""
        ...

    def sleep(self, duration_s: float) -> Coroutine[Any, Any, None]:
        """Wait for `duration_s`; 0 lets all ready callbacks run first."""
        ...


class LockstepSimulation(Protocol):
    """A simulation that advances only with the time of the virtual loop."""

    @property
    def busy(self) -> bool:
        """True while it may still schedule a callback."""
        ...

    def advance(self, until_s: float) -> float:
        """Step towards `until_s` (may be infinite); return early when a callback was scheduled."""
        ...


Rank = tuple[int, bool]
"""The nesting depth of a node that decides, and whether it is the node itself and not its container."""

_ONE_STEP = (None,)
_GRID_S = 1e-9
_CLOSING_S = 60.0
"""Time limit, in virtual time, for cancelled tasks to end when the loop is closed."""
_LEAP_S = 0.25
"""Maximum simulated time before the loop polls signals and sockets again."""


class VirtualTimeDeadlock(FlexcellError):
    """Virtual time cannot advance: no timer is set, no simulation is busy, no thread works."""


class OneTurn(Coroutine[None, None, None]):
    """Lets all ready callbacks run first, as `asyncio.sleep(0)` does, at less cost.

    Awaiting it adds no coroutine frame, neither when waiting nor when resumed.
    """

    __slots__ = ("_steps",)
    _steps: Iterator[None]
    __await__ = staticmethod(partial(iter, _ONE_STEP))  # pyright: ignore[reportAssignmentType]

    def send(self, value: None, /) -> None:
        """Advance one step; called by the task."""
        try:
            steps = self._steps
        except AttributeError:
            steps = self._steps = iter(_ONE_STEP)
        return next(steps)

    def throw(self, error: Any, value: object = None, trace: object = None, /) -> NoReturn:
        """Raise the error; there is nothing to clean up."""
        raise value if isinstance(value, BaseException) else error

    def close(self) -> None:
        """Do nothing; there is nothing to close."""


class LoopClock:
    """The time of the running event loop since the clock was created."""

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._start_s = 0.0 if self.virtual else self._loop.time()

    @property
    def virtual(self) -> bool:
        """True on a `VirtualLoop`."""
        return isinstance(self._loop, VirtualLoop)

    def now_s(self) -> float:
        """Seconds since the clock was created, or since the virtual loop started."""
        return self._loop.time() - self._start_s

    async def sleep(self, duration_s: float) -> None:
        """Wait for `duration_s`."""
        await asyncio.sleep(duration_s)


class _JumpingSelector(selectors.BaseSelector):
    """Polls real files without waiting and advances virtual time instead."""

    def __init__(self) -> None:
        self._real = selectors.DefaultSelector()
        self.pass_time: Callable[[float | None], float | None] = lambda timeout: timeout

    def register(self, fileobj: Any, events: int, data: Any = None) -> selectors.SelectorKey:
        return self._real.register(fileobj, events, data)

    def unregister(self, fileobj: Any) -> selectors.SelectorKey:
        return self._real.unregister(fileobj)

    def modify(self, fileobj: Any, events: int, data: Any = None) -> selectors.SelectorKey:
        return self._real.modify(fileobj, events, data)

    def close(self) -> None:
        self._real.close()

    def get_map(self) -> Any:
        return self._real.get_map()

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        if timeout is not None and timeout <= 0:
            return self._real.select(0)
        ready = self._real.select(0)
        if ready:
            return ready
        return self._real.select(self.pass_time(timeout))


class _Instant(float):
    """A time on a grid of nanoseconds; equal times are ordered by the order of their requests.

    The heap of asyncio orders equal times depending on the other timers. Sums of floats for the
    same instant differ in the last bit. Neither may affect a run.
    """

    __slots__ = ("order",)
    order: int

    def __lt__(self, other: object) -> bool:
        if not isinstance(other, _Instant):
            return NotImplemented
        return float(self) < float(other) or (float(self) == float(other) and self.order < other.order)


class VirtualLoop(asyncio.SelectorEventLoop):
    """An event loop with virtual time; run it with `run_virtual`."""

    def __init__(self) -> None:
        self._jumping = _JumpingSelector()
        super().__init__(self._jumping)
        self._jumping.pass_time = self._pass_time
        self._now_s = 0.0
        self._stepped: list[LockstepSimulation] = []
        self._timers = 0
        self._working = 0
        self._outside = 0
        self._idle_waiters: list[tuple[Rank, asyncio.Future[None]]] = []

    def time(self) -> float:
        """Virtual seconds since the loop was created."""
        return self._now_s

    def call_at(
        self, when: float, callback: Callable[..., object], *args: Any, context: Context | None = None
    ) -> asyncio.TimerHandle:
        """Call back at `when`, rounded to nanoseconds; callbacks of one instant run in the order of their requests."""
        instant = _Instant(round(when * 1e9) / 1e9 if math.isfinite(when) else when)
        instant.order = self._timers = self._timers + 1
        return super().call_at(instant, callback, *args, context=context)

    def attach(self, simulation: LockstepSimulation) -> None:
        """Step `simulation` with virtual time."""
        self._stepped.append(simulation)

    def detach(self, simulation: LockstepSimulation) -> None:
        """Stop stepping `simulation`."""
        self._stepped.remove(simulation)

    def expect_outside(self, change: int) -> None:
        """Add (+1) or remove (-1) a real source that will wake the loop, such as a server."""
        self._outside += change

    def expects_more_than(self, timers: int) -> bool:
        """Return whether anything besides `timers` timers can wake the loop."""
        if self._working or self._outside or any(simulation.busy for simulation in self._stepped):
            return True
        scheduled: list[asyncio.TimerHandle] = getattr(self, "_scheduled")  # noqa: B009 - private to asyncio
        return sum(not each.cancelled() for each in scheduled) > timers

    async def idle(self, rank: Rank) -> None:
        """Return when no callback is ready at this instant; the waiter of the highest rank is resumed first, alone."""
        waiter: asyncio.Future[None] = self.create_future()
        entry = (rank, waiter)
        self._idle_waiters.append(entry)
        try:
            await waiter
        finally:
            self._idle_waiters.remove(entry)

    def run_in_executor(  # type: ignore[override]
        self, executor: Executor | None, func: Callable[..., T], *args: Any
    ) -> asyncio.Future[T]:
        """Run in a thread while virtual time is frozen."""
        self._working += 1
        future = super().run_in_executor(executor, func, *args)
        future.add_done_callback(self._work_done)
        return future

    def _work_done(self, _: asyncio.Future[Any]) -> None:
        self._working -= 1

    def _pass_time(self, timeout_s: float | None) -> float | None:
        """Advance virtual time to the next timer; return the real time to wait for files."""
        if self._working:
            return None
        idle = [entry for entry in self._idle_waiters if not entry[1].done()]
        if idle:
            max(idle, key=lambda entry: entry[0])[1].set_result(None)
            return 0
        target_s = math.inf if timeout_s is None else self._now_s + timeout_s
        busy = [simulation for simulation in self._stepped if simulation.busy]
        if math.isinf(target_s) and not busy:
            if self._outside:
                return None
            self.call_soon(self._nothing_can_wake)
            return 0
        if self._stepped:
            # In long waits the loop must still poll signals and sockets.
            target_s = min(target_s, self._now_s + _LEAP_S)
        # Simulations that are not busy are stepped too: parts fall while a behavior sleeps.
        for simulation in self._stepped if not math.isinf(target_s) else busy:
            target_s = min(target_s, simulation.advance(target_s))
        self._now_s = max(self._now_s, target_s)
        # The clock resolution, added to the time to find due timers, must change it even after months.
        self._clock_resolution = max(_GRID_S, math.ulp(self._now_s))
        return 0

    def _nothing_can_wake(self) -> None:
        waiting = sorted(task.get_name() for task in asyncio.all_tasks(self) if not task.done())
        error = VirtualTimeDeadlock(
            f"virtual time cannot advance at t={self._now_s:.3f} s: every task waits and no timer is set",
            hint=f"waiting: {', '.join(waiting)}",
        )
        when_stuck, self.when_stuck = self.when_stuck, None
        if when_stuck is not None:
            when_stuck(error)
            return
        main = self._main_task
        if main is not None and not main.done():
            self.stuck = error
            main.cancel(str(error))
        else:
            self.stop()

    _main_task: asyncio.Task[Any] | None = None
    stuck: VirtualTimeDeadlock | None = None
    when_stuck: Callable[[VirtualTimeDeadlock], None] | None = None
    """Called at the first deadlock, instead of cancelling the main task."""

    def run_main(self, main: Coroutine[Any, Any, T]) -> T:
        """Run `main` to its end, then cancel the remaining tasks; a task that does not end is named in the log.

        Raises:
            VirtualTimeDeadlock: every task waits and no timer is set.
        """
        asyncio.set_event_loop(self)
        try:
            self._main_task = self.create_task(main, name="main")
            try:
                return self.run_until_complete(self._main_task)
            except asyncio.CancelledError:
                if self.stuck is not None:
                    raise self.stuck from None
                raise
        finally:
            self._close_down()

    def _close_down(self) -> None:
        self._outside += 1  # the executor's threads report their end from outside
        remaining = asyncio.all_tasks(self)
        for task in remaining:
            task.cancel()
        if remaining:
            _, unfinished = self.run_until_complete(asyncio.wait(remaining, timeout=_CLOSING_S))
            for task in unfinished:
                _log.error("the virtual loop is closed while %s has not ended after its cancellation", task.get_name())
        self.run_until_complete(self.shutdown_asyncgens())
        self.run_until_complete(self.shutdown_default_executor())
        asyncio.set_event_loop(None)
        self.close()


def run_virtual(main: Coroutine[Any, Any, T]) -> T:
    """Run a coroutine on a new virtual loop: hours pass in milliseconds, and runs are repeatable."""
    return VirtualLoop().run_main(main)


def new_clock() -> LoopClock:
    """Return the clock of the running loop, virtual or real."""
    return LoopClock()
