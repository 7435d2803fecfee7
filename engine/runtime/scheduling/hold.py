"""Holds branches of a run, each hold with a reason; goals and timers of held branches are paused.

A pause of the operator covers the whole run, a priority container everything outside itself. A branch resumes when no
reason covers it. Devices hold their goals and confirm when they are at rest; timers and node timeouts are suspended.
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
    """Work of a state that can be held and resumed."""

    @property
    def path(self) -> str:
        """The path of its state."""
        ...

    @property
    def label(self) -> str:
        """Its name in messages."""
        ...

    async def hold(self) -> None:
        """Bring the work to rest and return then. Raises FlexcellError where it cannot be held."""
        ...

    async def resume(self) -> None:
        """Resume the work."""
        ...


class _Member:
    """One piece of work, held or resumed by at most one task at a time."""

    def __init__(self, work: Holdable, settled: Callable[[], None], *, of_clean_up: bool) -> None:
        self.work = work
        self.of_clean_up = of_clean_up
        self.requested = False
        self.held = False
        self.cannot = ""
        self._settled = settled
        self.task: asyncio.Task[None] | None = None

    def want(self, *, held: bool) -> None:
        self.requested = held
        if self.requested != self.held and (self.task is None or self.task.done()):
            self.task = asyncio.create_task(self._follow(), name=f"hold {self.work.label}")

    async def _follow(self) -> None:
        while self.requested != self.held:
            self.cannot = ""
            try:
                await (self.work.hold() if self.requested else self.work.resume())
            except FlexcellError as error:
                # Work that cannot be held continues to its end; the operator is notified, the pause remains.
                self.cannot = f"{self.work.label}: {error.message}"
            self.held = not self.held
        self._settled()


class BranchHolds:
    """The held branches of one run and the reasons; used on the loop thread."""

    def __init__(self) -> None:
        self._reasons: dict[str, Covers] = {}
        self._members: dict[int, _Member] = {}
        self._timers: dict[int, Timer] = {}
        self._cleaning_up: set[str] = set()
        self._waiters: list[asyncio.Future[None]] = []
        self.on_settled: Callable[[], None] = lambda: None
        self.is_preempted: Callable[[str], bool] = lambda _path: False
        """Whether the node at a path is preempted and cleans up."""

    @property
    def active(self) -> bool:
        """True while any hold is active."""
        return bool(self._reasons)

    def held(self, path: str) -> bool:
        """Return whether the branch of `path` is held."""
        return any(covers(path) for covers in self._reasons.values()) and not self._is_cleaning_up(path)

    def stands_still(self, path: str) -> bool:
        """Return whether the branch of `path` is held, or work or a timer inside it, for which its end may wait."""
        if not self._reasons:
            return False
        paths = {timer.path for timer in self._timers.values()} | {each.work.path for each in self._members.values()}
        return self.held(path) or any(is_inside(path, other) and self.held(other) for other in paths)

    def reasons(self, path: str) -> tuple[str, ...]:
        """Return the reasons that hold `path`."""
        return tuple(reason for reason, covers in self._reasons.items() if covers(path))

    def hold(self, reason: str, covers: Covers) -> None:
        """Hold every branch that `covers` matches, until `release`; replaces an earlier hold with this reason."""
        self._reasons[reason] = covers
        self._apply()

    def release(self, reason: str) -> None:
        """Release the hold with this reason."""
        if self._reasons.pop(reason, None) is not None:
            self._apply()

    def let_clean_up(self, path: str) -> None:
        """Stop holding clean-ups inside `path`; nodes stay held until they are preempted."""
        self._cleaning_up.add(path)
        for timer in self._timers.values():
            if not self.held(timer.path):
                timer.resume()
        for member in self._members.values():
            if member.of_clean_up and not self.held(member.work.path):
                member.want(held=False)
        self.wake()

    def has_cleaned_up(self, path: str) -> None:
        """Allow holds of clean-ups inside `path` again."""
        self._cleaning_up.discard(path)

    def attach(self, work: Holdable) -> None:
        """Hold and resume `work` with its branch, until `detach`."""
        member = _Member(work, self._notify_settled, of_clean_up=self.is_preempted(work.path))
        self._members[id(work)] = member
        if self._reasons and self.held(work.path):
            member.want(held=True)

    async def detach(self, work: Holdable) -> None:
        """Detach `work`; returns when no hold or resume of it is in progress."""
        member = self._members.pop(id(work))
        if member.task is not None and not member.task.done():
            member.task.cancel()
            await asyncio.wait({member.task})
        if member.requested:
            self._notify_settled()

    def timer(self, path: str, duration_s: float) -> Timer:
        """Start a timer that is suspended while `path` is held; end it with `drop`."""
        timer = Timer(path, duration_s, held=bool(self._reasons) and self.held(path))
        self._timers[id(timer)] = timer
        return timer

    @property
    def timers(self) -> tuple[Timer, ...]:
        """The active timers, held or not."""
        return tuple(self._timers.values())

    def drop(self, timer: Timer) -> None:
        """Cancel and remove a timer."""
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
        """Wake all tasks that wait for a change, in order of arrival."""
        waiters, self._waiters = self._waiters, []
        for waiter in waiters:
            if not waiter.done():
                waiter.set_result(None)

    def settled(self) -> bool:
        """Return whether all work to be held is held."""
        return all(member.held for member in self._members.values() if member.requested)

    def cannot(self) -> tuple[str, ...]:
        """Return the messages of work that cannot be held."""
        return tuple(member.cannot for member in self._members.values() if member.requested and member.cannot)

    def _apply(self) -> None:
        for timer in self._timers.values():
            if self.held(timer.path):
                timer.hold()
            else:
                timer.resume()
        for member in self._members.values():
            if not self._is_cleaning_up(member.work.path):
                member.want(held=self.held(member.work.path))
        self.wake()

    def _is_cleaning_up(self, path: str) -> bool:
        is_released = any(is_inside(around, path) for around in self._cleaning_up)
        return is_released and self.is_preempted(path)

    def _notify_settled(self) -> None:
        if self.settled():
            self.on_settled()
