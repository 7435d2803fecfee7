"""Plans in a separate process, for asyncio: the loop stays free while Coal and OMPL hold the interpreter lock."""

from __future__ import annotations

import asyncio
from typing import Self

from engine.errors import RobotError
from engine.skills.planning_scene import CollisionReport
from robots.io.worker_process import WorkerProcess
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    PairDistanceRequest,
    PairDistances,
    PathCheck,
    PathCheckRequest,
    PathPlan,
    PlanAnswer,
    PlanRefusal,
    PlanRequest,
)
from robots.planning.swept_space import SweptSpace, SweptSpaceRequest
from robots.planning.worker.planning_messages import (
    CancelRequest,
    CollisionReply,
    FromPlanner,
    PlannerReady,
    PlanningRequest,
    ToPlanner,
    WarmUpRequest,
)

_START = "from robots.planning.worker.planning_worker_main import main; main()"
_WHAT = "the planning process"
_HINT = "plan again; the next request starts a new process"
# Timeout of a start: the first one on a machine compiles all kernels.
_START_S = 300.0
_OVERDUE_S = 5.0
# Timeout of the first answer: the process loads the models of all arms, on a machine that may be busy.
_LOADING_S = 60.0
# Longest time of a request without a search.
_LOOK_S = 1.0


class PlanningWorker:
    """The planning process and its queue of requests; `async with` starts it, the next request restarts a dead one.

    Path checks and collision queries run between the work steps of a plan, so that they do not wait for it
    (except PRM and PRMstar, which have no steps). Cancelling the task that awaits a plan cancels the request: the
    process stops the search at the next work step. A request that stays unanswered well beyond its
    time ends the process. A start takes seconds and continues if a request that waits for it is cancelled:
    `start` only triggers it, so that the process warms up in parallel to other work.
    """

    def __init__(self) -> None:
        self._worker: _Worker | None = None
        self._starting: asyncio.Task[_Worker] | None = None
        self._closed = False
        self.gone = ""

    @property
    def pid(self) -> int:
        """The process id, 0 without a process."""
        return self._worker.process.pid if self._worker is not None else 0

    async def __aenter__(self) -> Self:
        try:
            await self._running()
        except BaseException:
            # `__aexit__` is not called if entering fails.
            await self.__aexit__()
            raise
        return self

    async def __aexit__(self, *_error: object) -> None:
        self._closed = True
        starting, self._starting = self._starting, None
        if starting is not None:
            starting.cancel()
            await asyncio.gather(starting, return_exceptions=True)
        self._end()

    def start(self) -> None:
        """Start the process if there is none, without waiting for it; `async with` still closes it."""
        if not self._closed and (self._worker is None or self._worker.process.lost_reason) and self._starting is None:
            self._end()
            self._starting = asyncio.ensure_future(self._start())
            self._starting.add_done_callback(self._on_start_done)

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a validated path, or why there is none.

        Raises:
            CellError: the scene has no such arm, or is invalid.
            RobotError: the planning process has ended or hangs; the next request starts a new one.
        """
        answer = await self._answer(request, request.time_s)
        assert isinstance(answer, PathPlan | PlanRefusal)
        return answer

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return the first collision of an arm that follows a trajectory. Raises as `plan` does."""
        return await self._path_check(request)

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return the first collision of an attached part on a trajectory. Raises as `plan` does."""
        return await self._path_check(request)

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Return the collisions and the clearance of an arm in a configuration. Raises as `plan` does."""
        answer = await self._answer(request, _LOOK_S)
        assert isinstance(answer, CollisionReply)
        return answer.report

    async def pair_distances(self, request: PairDistanceRequest) -> PairDistances:
        """Return the distances of two bodies with an arm at several configurations. Raises as `plan` does."""
        answer = await self._answer(request, _LOOK_S)
        assert isinstance(answer, PairDistances)
        return answer

    async def swept_space(self, request: SweptSpaceRequest) -> SweptSpace:
        """Return the unknown space on a trajectory. Raises as `plan` does."""
        answer = await self._answer(request, _LOOK_S)
        assert isinstance(answer, SweptSpace)
        return answer

    async def _path_check(self, request: PathCheckRequest | AttachedPartCheckRequest) -> PathCheck:
        answer = await self._answer(request, _LOOK_S)
        assert isinstance(answer, PathCheck)
        return answer

    async def _answer(self, request: PlanningRequest, time_s: float) -> FromPlanner:
        """Send a request and return the answer of the process."""
        worker = await self._running()
        number, answer = worker.process.ask(request)
        # Includes the time of queued requests before it.
        allowed_s = worker.promised_s(answer, time_s) + (_OVERDUE_S if worker.has_answered else _LOADING_S)
        try:
            async with asyncio.timeout(allowed_s):
                return await asyncio.shield(answer)
        except TimeoutError as error:
            self._end()
            raise RobotError(
                f"the planning process has not answered within {allowed_s:.1f} s and was ended", hint=_HINT
            ) from error
        except asyncio.CancelledError:
            if not worker.process.lost_reason:
                worker.process.send(CancelRequest(), number=number)
            raise

    async def _running(self) -> _Worker:
        """Return the process; starts one if there is none."""
        if self._closed:
            raise RobotError("the planning worker was closed", hint="enter a new one with `async with`")
        if self._starting is None and self._worker is not None and not self._worker.process.lost_reason:
            return self._worker
        self.start()
        starting = self._starting
        assert starting is not None
        # Other requests may wait for the same start.
        await asyncio.wait([starting])
        if starting.cancelled():
            raise RobotError("the planning worker was closed", hint="enter a new one with `async with`")
        return starting.result()

    def _on_start_done(self, starting: asyncio.Task[_Worker]) -> None:
        if not starting.cancelled() and starting.exception() is None:
            self._worker, self.gone = starting.result(), ""
        if self._starting is starting:
            self._starting = None

    async def _start(self) -> _Worker:
        worker = self._worker = _Worker(
            WorkerProcess[ToPlanner, FromPlanner](_START, FromPlanner, what=_WHAT, hint=_HINT, on_lost=self._when_lost)
        )
        try:
            await worker.process.start()
            try:
                async with asyncio.timeout(_START_S):
                    ready = await asyncio.shield(worker.process.ask(WarmUpRequest()).answer)
            except TimeoutError as error:
                message = f"the planner was not ready within {_START_S:g} s of its start"
                raise RobotError(message, hint="try again when the computer has less to do") from error
            assert isinstance(ready, PlannerReady)
        except BaseException:
            # After any failure, including cancellation, no process may remain.
            self._end()
            raise
        return worker

    def _when_lost(self, reason: str) -> None:
        self.gone = reason

    def _end(self) -> None:
        worker, self._worker = self._worker, None
        if worker is not None:
            # The process has no state that could be lost.
            worker.process.end()


class _Worker:
    """One planning process, and what it has still to answer."""

    def __init__(self, process: WorkerProcess[ToPlanner, FromPlanner]) -> None:
        self.process = process
        self.has_answered = False
        self._promised_s: dict[asyncio.Future[FromPlanner], float] = {}

    def promised_s(self, answer: asyncio.Future[FromPlanner], time_s: float) -> float:
        """Return the total time that all unanswered requests may take, with one more that may take `time_s`."""
        self._promised_s[answer] = time_s
        answer.add_done_callback(self._answered)
        return sum(self._promised_s.values())

    def _answered(self, answer: asyncio.Future[FromPlanner]) -> None:
        self.has_answered = True
        del self._promised_s[answer]
