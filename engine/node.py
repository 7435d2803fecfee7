"""A node of an executable behavior: enters its work, applies timeout, retry and on_error, exits.

The same wrapper surrounds a single state and a whole container; what differs is its `Work`.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Protocol

import msgspec

from engine.cause import cause_of, describe, under
from engine.errors import FlexcellError, JournalError, StateError
from engine.event import Cause, Entered, Exited, Logged, Retried
from engine.execution import Execution
from engine.preemption import being_cancelled, preempt
from engine.state import Outcome, State
from engine.userdata import Scope


@dataclass(frozen=True, kw_only=True)
class Timeout:
    """Preempt the node after `after_s` and go to `target`."""

    after_s: float
    target: str


@dataclass(frozen=True, kw_only=True)
class Retry:
    """Run the node up to `times` more, waiting `backoff_s` doubled each time, on these outcomes or errors."""

    times: int
    backoff_s: float = 0.0
    outcomes: tuple[str, ...] = ()
    errors: bool = True


class Left(msgspec.Struct, frozen=True):
    """How a node was left: with an outcome, or straight to a target (timeout, on_error)."""

    outcome: str
    target: str | None = None
    cause: Cause | None = None


@dataclass(frozen=True)
class Entry:
    """What a node was entered with: the state to run, its input values, and both as plain data."""

    state: State | None = None
    inputs: Mapping[str, object] = field(default_factory=dict[str, object])
    shown: dict[str, object] = field(default_factory=dict[str, object])


NOTHING = Entry()


class Work(Protocol):
    """What a node does between entering and leaving."""

    @property
    def kind(self) -> str:
        """state, machine, concurrency or behavior."""
        ...

    @cached_property
    def nominal(self) -> frozenset[str]:
        """The outcomes that mean that nothing went wrong inside; asked at every transition."""
        ...

    def enter(self, scope: Scope) -> Entry:
        """Evaluate what it is entered with; raises FlexcellError when that cannot be had."""
        ...

    async def run(self, entry: Entry, path: str, visit: int, scope: Scope, execution: Execution) -> Outcome:
        """Do it."""
        ...


@dataclass(frozen=True, kw_only=True)
class Node:
    """One node with its wiring inside the enclosing container."""

    path: str
    name: str
    work: Work
    transitions: Mapping[str, str] = field(default_factory=dict[str, str])
    timeout: Timeout | None = None
    retry: Retry | None = None
    on_error: str | None = None
    position: str = ""

    async def perform(self, scope: Scope, execution: Execution) -> Left:
        """Run the node to its end, whatever that is.

        Raises:
            FlexcellError: the work raised, retries are used up and `on_error` is not set.
            CancelledError: the node was preempted; its clean-up is done.
        """
        if self.timeout is None and self.retry is None and self.on_error is None:
            return await self._attempt(scope, execution)
        return await self._guarded(scope, execution)

    async def _guarded(self, scope: Scope, execution: Execution) -> Left:
        try:
            if self.timeout is None:
                return await self._retried(scope, execution)
            return await self._timed(self.timeout, scope, execution)
        except JournalError:
            raise
        except FlexcellError as error:
            # A stop beats on_error, also when the clean-up fails.
            if self.on_error is None or being_cancelled():
                raise
            return Left("", self.on_error, cause_of(error))

    async def _timed(self, timeout: Timeout, scope: Scope, execution: Execution) -> Left:
        # A task of its own: a stop and a timeout may come together, and clean-up must be cut by neither.
        body = asyncio.create_task(self._retried(scope, execution), name=self.path)
        try:
            await asyncio.wait({body}, timeout=timeout.after_s)
        except asyncio.CancelledError:
            await preempt((body,), overdue_log(execution))
            raise
        if body.done():
            return body.result()
        await preempt((body,), overdue_log(execution))
        if not body.cancelled() and (error := body.exception()) is not None:
            raise error
        cause = Cause(message=f"no outcome within {timeout.after_s:g} s", where=self.path, kind="Timeout")
        return Left("", timeout.target, cause)

    async def _retried(self, scope: Scope, execution: Execution) -> Left:
        retry = self.retry
        attempt = 1
        while True:
            again: Cause | None
            try:
                left = await self._attempt(scope, execution)
                if retry is None or left.outcome not in retry.outcomes or attempt > retry.times:
                    return left
                again = under(f"outcome {left.outcome}", left.cause, where=self.path)
            except JournalError:
                raise
            except FlexcellError as error:
                if retry is None or not retry.errors or attempt > retry.times or being_cancelled():
                    raise
                again = cause_of(error)
            attempt += 1
            wait_s = retry.backoff_s * 2 ** (attempt - 2)
            recorder = execution.recorder
            recorder.record(
                Retried(
                    seq=recorder.next_seq(),
                    time_s=recorder.now_s(),
                    path=self.path,
                    attempt=attempt,
                    wait_s=wait_s,
                    cause=again,
                )
            )
            if wait_s > 0:
                execution.waits += 1
                await execution.clock.sleep(wait_s)

    async def _attempt(self, scope: Scope, execution: Execution) -> Left:
        recorder = execution.recorder
        path = self.path
        visit = execution.visit(path)
        entry, refused = self._entered(scope)
        recorder.record(
            Entered(
                seq=recorder.next_seq(),
                time_s=recorder.now_s(),
                path=path,
                visit=visit,
                kind=self.work.kind,
                inputs=entry.shown,
            )
        )
        try:
            if refused is not None:
                raise refused
            outcome = await self.work.run(entry, path, visit, scope, execution)
        except asyncio.CancelledError as stray:
            if being_cancelled():
                self._record_exit(execution, visit, "", preempted=True)
                raise
            error = StateError("a CancelledError came out though nobody asked it to stop", where=self.position or path)
            self._record_exit(execution, visit, "", cause=cause_of(error))
            raise error from stray
        except Exception as error:
            self._record_exit(execution, visit, "", preempted=being_cancelled(), cause=cause_of(error))
            if being_cancelled() and self.work.kind == "state":
                log(execution, path, f"clean-up failed: {describe(cause_of(error))}", level="error")
            raise
        if being_cancelled():
            # It took no notice, or was just done; whoever stops it must not find its successor running.
            self._record_exit(execution, visit, outcome.name, preempted=True, cause=outcome.cause)
            raise asyncio.CancelledError
        self._record_exit(execution, visit, outcome.name, cause=outcome.cause)
        return Left(outcome.name, None, outcome.cause)

    def _entered(self, scope: Scope) -> tuple[Entry, FlexcellError | None]:
        """Evaluate the entry; a failure counts as a failure of the node that was entered."""
        try:
            return self.work.enter(scope), None
        except FlexcellError as error:
            return NOTHING, error

    def _record_exit(
        self, execution: Execution, visit: int, outcome: str, *, preempted: bool = False, cause: Cause | None = None
    ) -> None:
        recorder = execution.recorder
        recorder.record(
            Exited(
                seq=recorder.next_seq(),
                time_s=recorder.now_s(),
                path=self.path,
                visit=visit,
                outcome=outcome,
                preempted=preempted,
                cause=cause,
            )
        )


def log(execution: Execution, path: str, message: str, *, level: str = "info") -> None:
    """Write a line into the event log of the run."""
    recorder = execution.recorder
    recorder.record(Logged(seq=recorder.next_seq(), time_s=recorder.now_s(), path=path, level=level, message=message))


def overdue_log(execution: Execution) -> Callable[[str, float], None]:
    """Return what names, in the event log, a node that is slow to clean up."""

    def tell(path: str, waited_s: float) -> None:
        log(execution, path, f"asked to stop {waited_s:g} s ago and still cleaning up", level="warning")

    return tell


def explain(child: Node, left: Left) -> Cause:
    """Return why a container failed through this child."""
    said = f"{child.name} ended with {left.outcome}" if left.outcome else f"{child.name} was left for {left.target}"
    return under(said, left.cause, where=child.path)
