"""Holds branches of a run, each hold with a reason; goals and timers of held branches are paused.

A pause of the operator covers the whole run, a priority container everything outside itself. A
branch goes on when no reason covers it any more. Goals are held by their devices, which confirm
when they are at rest; timers, and the timeouts of nodes, do not run meanwhile.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Protocol

from engine.errors import FlexcellError
from engine.node_path import is_inside
from engine.runtime.scheduling.timer import Timer

Covers = Callable[[str], bool]


class Holdable(Protocol):
    """Work of a state that can be brought to rest and go on later."""

    @property
    def path(self) -> str:
        """The state that it belongs to."""
        ...

    @property
    def label(self) -> str:
        """What it is, for messages."""
        ...

    async def hold(self) -> None:
        """Bring it to rest; returns when it is. Raises FlexcellError where that cannot be."""
        ...

    async def resume(self) -> None:
        """Let it go on."""
        ...


class _Member:
    """One piece of work, led towards being held or not by one task at a time."""

    def __init__(self, work: Holdable, settled: Callable[[], None], *, of_clean_up: bool) -> None:
        self.work = work
        self.of_clean_up = of_clean_up
        self.wanted = False
        self.held = False
        self.cannot = ""
        self._settled = settled
        self.task: asyncio.Task[None] | None = None

    def want(self, held: bool) -> None:
        self.wanted = held
        if self.wanted != self.held and (self.task is None or self.task.done()):
            self.task = asyncio.create_task(self._follow(), name=f"hold {self.work.label}")

    async def _follow(self) -> None:
        while self.wanted != self.held:
            self.cannot = ""
            try:
                await (self.work.hold() if self.wanted else self.work.resume())
            except FlexcellError as error:
                # What cannot be held goes on to its end; the operator is told, the pause stands.
                self.cannot = f"{self.work.label}: {error.message}"
            self.held = not self.held
        self._settled()


class BranchHolds:
    """Who is held and why; belongs to one run, used on the loop thread."""

    def __init__(self) -> None:
        self._reasons: dict[str, Covers] = {}
        self._members: dict[int, _Member] = {}
        self._timers: dict[int, Timer] = {}
        self._cleaning_up: set[str] = set()
        self._waiters: list[asyncio.Future[None]] = []
        self.on_settled: Callable[[], None] = lambda: None
        self.is_preempted: Callable[[str], bool] = lambda path: False
        """Whether what is at a path has been asked to end, and cleans up."""

    @property
    def active(self) -> bool:
        """True while there is any reason."""
        return bool(self._reasons)

    def held(self, path: str) -> bool:
        """Tell whether the branch of `path` has to stand still."""
        return any(covers(path) for covers in self._reasons.values()) and not self._cleans_up(path)

    def reasons(self, path: str) -> tuple[str, ...]:
        """Return why it has to."""
        return tuple(reason for reason, covers in self._reasons.items() if covers(path))

    def hold(self, reason: str, covers: Covers) -> None:
        """Hold every branch that `covers` is true for, until `release`; replaces an earlier one of this name."""
        self._reasons[reason] = covers
        self._apply()

    def release(self, reason: str) -> None:
        """Take a reason away."""
        if self._reasons.pop(reason, None) is not None:
            self._apply()

    def let_clean_up(self, path: str) -> None:
        """Hold no clean-up inside `path` any more; what is about to be preempted stays held until it is."""
        self._cleaning_up.add(path)
        for timer in self._timers.values():
            if not self.held(timer.path):
                timer.resume()
        for member in self._members.values():
            if member.of_clean_up and not self.held(member.work.path):
                member.want(False)
        self.wake()

    def has_cleaned_up(self, path: str) -> None:
        """Hold what is inside `path` again."""
        self._cleaning_up.discard(path)

    def attach(self, work: Holdable) -> None:
        """Hold and resume `work` along with its branch, from now on until `detach`."""
        member = _Member(work, self._tell_settled, of_clean_up=self.is_preempted(work.path))
        self._members[id(work)] = member
        if self._reasons and self.held(work.path):
            member.want(True)

    async def detach(self, work: Holdable) -> None:
        """Forget it; returns when nothing holds or resumes it any more."""
        member = self._members.pop(id(work))
        if member.task is not None and not member.task.done():
            member.task.cancel()
            await asyncio.wait({member.task})
        if member.wanted:
            self._tell_settled()

    def timer(self, path: str, duration_s: float) -> Timer:
        """Start a timer that stands still while `path` is held; end it with `drop`."""
        timer = Timer(path, duration_s, held=bool(self._reasons) and self.held(path))
        self._timers[id(timer)] = timer
        return timer

    @property
    def timers(self) -> tuple[Timer, ...]:
        """Those that somebody waits for, held or not."""
        return tuple(self._timers.values())

    def drop(self, timer: Timer) -> None:
        """Stop and forget a timer."""
        timer.cancel()
        del self._timers[id(timer)]

    async def until_free(self, path: str) -> None:
        """Return when nothing holds `path`."""
        while self._reasons and self.held(path):
            await self.changed()

    async def changed(self) -> None:
        """Return when the reasons have changed, or `wake` was called."""
        waiter: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiters.append(waiter)
        await waiter

    def wake(self) -> None:
        """Let everybody who waits for a change look again, in the order in which they came."""
        waiters, self._waiters = self._waiters, []
        for waiter in waiters:
            if not waiter.done():
                waiter.set_result(None)

    def settled(self) -> bool:
        """Tell whether everything that is to be held is."""
        return all(member.held for member in self._members.values() if member.wanted)

    def cannot(self) -> tuple[str, ...]:
        """Return what is to be held and cannot."""
        return tuple(member.cannot for member in self._members.values() if member.wanted and member.cannot)

    def _apply(self) -> None:
        for timer in self._timers.values():
            if self.held(timer.path):
                timer.hold()
            else:
                timer.resume()
        for member in self._members.values():
            if not self._cleans_up(member.work.path):
                member.want(self.held(member.work.path))
        self.wake()

    def _cleans_up(self, path: str) -> bool:
        let = any(is_inside(around, path) for around in self._cleaning_up)
        return let and self.is_preempted(path)

    def _tell_settled(self) -> None:
        if self.settled():
            self.on_settled()
