"""Plans in a separate process, for asyncio: the loop stays free while Coal and OMPL hold the interpreter lock."""

from __future__ import annotations

import asyncio
import socket
import subprocess
from collections.abc import Callable
from typing import Self

import msgspec

from engine.errors import CellError, RobotError
from engine.host.child_process import describe_exit, start_child
from engine.skills.planning_scene import CollisionReport
from robots.io.framing import FrameReader, frame_message
from robots.planning.request import (
    AttachedPartCheckRequest,
    CollisionRequest,
    PathCheck,
    PathCheckRequest,
    PlanAnswer,
    PlanRequest,
)
from robots.planning.worker.planning_messages import (
    AskAttachedPartCheck,
    AskCollisions,
    AskPathCheck,
    AskPlan,
    CancelRequest,
    CollisionReply,
    FromWorker,
    PlannerReady,
    PlanningReply,
    PlanningRequest,
    RequestFailure,
    ToWorker,
)

_START = "from robots.planning.worker.planning_worker_main import main; main()"
_WHAT = "the planning process"
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
        self._process: subprocess.Popen[bytes] | None = None
        self._wire: _Wire | None = None
        self._starting: asyncio.Task[_Wire] | None = None
        self._numbers = 0
        self._closed = False
        self.gone = ""

    @property
    def pid(self) -> int:
        """The process id, 0 without a process."""
        return self._process.pid if self._process is not None and self._process.poll() is None else 0

    async def __aenter__(self) -> Self:
        try:
            await self._connected_wire()
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
        if not self._closed and (self._wire is None or self._wire.lost) and self._starting is None:
            self._end()
            self._starting = asyncio.ensure_future(self._start())
            self._starting.add_done_callback(self._on_start_done)

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a validated path, or why there is none.

        Raises:
            CellError: the scene has no such arm, or is invalid.
            RobotError: the planning process has ended or hangs; the next request starts a new one.
        """
        reply = await self._answer(lambda number: AskPlan(number=number, request=request), request.time_s)
        assert isinstance(reply, PlanningReply)
        assert not isinstance(reply.answer, PathCheck)
        return reply.answer

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return the first collision of an arm that follows a trajectory. Raises as `plan` does."""
        return await self._path_check(lambda number: AskPathCheck(number=number, request=request))

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return the first collision of an attached part on a trajectory. Raises as `plan` does."""
        return await self._path_check(lambda number: AskAttachedPartCheck(number=number, request=request))

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Return the collisions and the clearance of an arm in a configuration. Raises as `plan` does."""
        reply = await self._answer(lambda number: AskCollisions(number=number, request=request), _LOOK_S)
        assert isinstance(reply, CollisionReply)
        return reply.answer

    async def _path_check(self, make: Callable[[int], PlanningRequest]) -> PathCheck:
        reply = await self._answer(make, _LOOK_S)
        assert isinstance(reply, PlanningReply)
        assert isinstance(reply.answer, PathCheck)
        return reply.answer

    async def _answer(self, make: Callable[[int], PlanningRequest], time_s: float) -> PlanningReply | CollisionReply:
        """Send a request with a new number and return the answer of the process."""
        wire = await self._connected_wire()
        self._numbers += 1
        number = self._numbers
        answer = wire.ask(make(number), time_s)
        # Includes the time of queued requests before it.
        allowed_s = wire.promised_s + (_OVERDUE_S if wire.has_answered else _LOADING_S)
        try:
            async with asyncio.timeout(allowed_s):
                reply = await asyncio.shield(answer)
        except TimeoutError as error:
            self._end()
            raise RobotError(
                f"the planning process has not answered within {allowed_s:.1f} s and was ended",
                hint="plan again; the next request starts a new process",
            ) from error
        except asyncio.CancelledError:
            wire.withdraw(number)
            raise
        if isinstance(reply, RequestFailure):
            raise CellError(reply.message, where=reply.where or None, hint=reply.hint or None)
        return reply

    async def _connected_wire(self) -> _Wire:
        """Return the connection to the process; starts the process if there is none."""
        if self._closed:
            raise RobotError("the planning worker was closed", hint="enter a new one with `async with`")
        if self._wire is not None and not self._wire.lost:
            return self._wire
        self.start()
        starting = self._starting
        assert starting is not None
        # Other requests may wait for the same start.
        await asyncio.wait([starting])
        if starting.cancelled():
            raise RobotError("the planning worker was closed", hint="enter a new one with `async with`")
        return starting.result()

    def _on_start_done(self, starting: asyncio.Task[_Wire]) -> None:
        if not starting.cancelled() and starting.exception() is None:
            self._wire, self.gone = starting.result(), ""
        if self._starting is starting:
            self._starting = None

    async def _start(self) -> _Wire:
        ours, theirs = socket.socketpair()
        try:
            self._process = start_child(_START, (theirs.fileno(),), what=_WHAT)
            theirs.close()
            _, wire = await asyncio.get_running_loop().create_connection(lambda: _Wire(self._describe_end), sock=ours)
        except BaseException:
            # After any failure, including cancellation, no process may remain.
            ours.close()
            theirs.close()
            self._end()
            raise
        try:
            async with asyncio.timeout(_START_S):
                await asyncio.shield(wire.ready)
        except BaseException:
            wire.close()
            self._end()
            raise
        return wire

    def _end(self) -> None:
        wire, self._wire = self._wire, None
        if wire is not None:
            wire.close()
        process, self._process = self._process, None
        if process is not None:
            # The process has no state that could be lost.
            process.kill()
            process.wait()

    def _describe_end(self) -> str:
        self.gone = describe_exit(self._process, what=_WHAT)
        return self.gone


_Answer = PlanningReply | CollisionReply | RequestFailure


class _Wire(asyncio.Protocol):
    """The client's end of the socket."""

    def __init__(self, describe_end: Callable[[], str]) -> None:
        self._describe_end = describe_end
        self._reader = FrameReader()
        self._decode = msgspec.msgpack.Decoder(FromWorker).decode
        self._transport: asyncio.Transport | None = None
        self._asked: dict[int, tuple[asyncio.Future[_Answer], float]] = {}
        self.ready: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self.lost = False
        self.has_answered = False

    @property
    def promised_s(self) -> float:
        """The total time that all unanswered requests may take."""
        return sum(time_s for _, time_s in self._asked.values())

    def ask(self, ask: PlanningRequest, time_s: float) -> asyncio.Future[_Answer]:
        future: asyncio.Future[_Answer] = asyncio.get_running_loop().create_future()
        if self.lost:
            future.set_exception(_process_ended(self._describe_end()))
            return future
        self._asked[ask.number] = (future, time_s)
        self._send(ask)
        return future

    def withdraw(self, number: int) -> None:
        if not self.lost:
            self._send(CancelRequest(number=number))

    def close(self) -> None:
        self.lost = True
        if self._transport is not None:
            self._transport.close()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport

    def data_received(self, data: bytes) -> None:
        for frame in self._reader.feed(data):
            message = self._decode(frame)
            if isinstance(message, PlannerReady):
                self.ready.set_result(None)
                continue
            self.has_answered = True
            future, _ = self._asked.pop(message.number)
            if not future.done():
                future.set_result(message)

    def connection_lost(self, exc: Exception | None) -> None:
        self.lost = True
        reason = self._describe_end()
        waiting = [future for future, _ in self._asked.values()]
        self._asked.clear()
        for future in (self.ready, *waiting):
            if not future.done():
                future.set_exception(_process_ended(reason))
                # Marks the exception as retrieved: the caller may no longer wait.
                future.exception()

    def _send(self, message: ToWorker) -> None:
        assert self._transport is not None
        self._transport.write(frame_message(msgspec.msgpack.encode(message)))


def _process_ended(reason: str) -> RobotError:
    return RobotError(reason, hint="plan again; the next request starts a new process")
