"""Plans in a process of its own, for asyncio: the loop stays free while coal and OMPL hold the interpreter lock."""

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
# The first start on a machine compiles everything.
_START_S = 300.0
_OVERDUE_S = 5.0
# Before its first answer a process loads the models of all arms, on a machine that may have much else to do.
_LOADING_S = 60.0
# What a request that is no search may take.
_LOOK_S = 1.0


class PlanningWorker:
    """The planning process and its requests, in turn; started by `async with`, again by the next request if it died.

    Ways and configurations are looked at between the pieces of work of a plan, so that they do not wait for it
    (but for PRM and PRMstar, which have none). Cancelling the task that awaits a plan withdraws the request: the
    process stops looking for a way at the next piece of work. A request that stays unanswered well beyond its
    time ends the process. A start takes seconds and goes on when a request that waits for it is cancelled:
    `start` only sets it off, so that the process warms up beside other work.
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
        """The process id, 0 while there is none."""
        return self._process.pid if self._process is not None and self._process.poll() is None else 0

    async def __aenter__(self) -> Self:
        try:
            await self._running()
        except BaseException:
            # Nobody leaves what was not entered.
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
        """Start the process if there is none, without waiting for it; to be closed by `async with` all the same."""
        if not self._closed and (self._wire is None or self._wire.lost) and self._starting is None:
            self._end()
            self._starting = asyncio.ensure_future(self._start())
            self._starting.add_done_callback(self._started_or_not)

    async def plan(self, request: PlanRequest) -> PlanAnswer:
        """Return a confirmed way, or why there is none.

        Raises:
            CellError: the scene has no such arm, or something in it is wrong.
            RobotError: the planning process ended or hangs; the next request finds a new one.
        """
        found = await self._answer(lambda number: AskPlan(number=number, request=request), request.time_s)
        assert isinstance(found, PlanningReply)
        assert not isinstance(found.answer, PathCheck)
        return found.answer

    async def check_path(self, request: PathCheckRequest) -> PathCheck:
        """Return where an arm that follows a trajectory would touch something first. Raises as `plan` does."""
        return await self._checked(lambda number: AskPathCheck(number=number, request=request))

    async def check_attached_parts(self, request: AttachedPartCheckRequest) -> PathCheck:
        """Return where what an arm holds would touch something first on a trajectory. Raises as `plan` does."""
        return await self._checked(lambda number: AskAttachedPartCheck(number=number, request=request))

    async def look(self, request: CollisionRequest) -> CollisionReport:
        """Return what an arm touches in a configuration and how near it is to the rest. Raises as `plan` does."""
        found = await self._answer(lambda number: AskCollisions(number=number, request=request), _LOOK_S)
        assert isinstance(found, CollisionReply)
        return found.answer

    async def _checked(self, make: Callable[[int], PlanningRequest]) -> PathCheck:
        found = await self._answer(make, _LOOK_S)
        assert isinstance(found, PlanningReply)
        assert isinstance(found.answer, PathCheck)
        return found.answer

    async def _answer(self, make: Callable[[int], PlanningRequest], time_s: float) -> PlanningReply | CollisionReply:
        """Return what the process answers to a request, which has a number once it is sent."""
        wire = await self._running()
        self._numbers += 1
        number = self._numbers
        answer = wire.ask(make(number), time_s)
        # Others before it in turn take their time too.
        allowed_s = wire.promised_s + (_OVERDUE_S if wire.has_answered else _LOADING_S)
        try:
            async with asyncio.timeout(allowed_s):
                found = await asyncio.shield(answer)
        except TimeoutError as error:
            self._end()
            raise RobotError(
                f"the planning process has not answered within {allowed_s:.1f} s and was ended",
                hint="plan again; a new process is started",
            ) from error
        except asyncio.CancelledError:
            wire.withdraw(number)
            raise
        if isinstance(found, RequestFailure):
            raise CellError(found.message, where=found.where or None, hint=found.hint or None)
        return found

    async def _running(self) -> _Wire:
        """Return the wire to the process, which is started if there is none."""
        if self._closed:
            raise RobotError("the planning worker was closed", hint="enter a new one with `async with`")
        if self._wire is not None and not self._wire.lost:
            return self._wire
        self.start()
        starting = self._starting
        assert starting is not None
        # Others may wait for the same start.
        await asyncio.wait([starting])
        if starting.cancelled():
            raise RobotError("the planning worker was closed", hint="enter a new one with `async with`")
        return starting.result()

    def _started_or_not(self, starting: asyncio.Task[_Wire]) -> None:
        if not starting.cancelled() and starting.exception() is None:
            self._wire, self.gone = starting.result(), ""
        if self._starting is starting:
            self._starting = None

    async def _start(self) -> _Wire:
        ours, theirs = socket.socketpair()
        try:
            self._process = start_child(_START, (theirs.fileno(),), what=_WHAT)
            theirs.close()
            _, wire = await asyncio.get_running_loop().create_connection(lambda: _Wire(self._it_ended), sock=ours)
        except BaseException:
            # Whatever went wrong, cancellation included, no process may be left behind.
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
            # It holds nothing that could be lost.
            process.kill()
            process.wait()

    def _it_ended(self) -> str:
        self.gone = describe_exit(self._process, what=_WHAT)
        return self.gone


_Answer = PlanningReply | CollisionReply | RequestFailure


class _Wire(asyncio.Protocol):
    """The client's end of the socket."""

    def __init__(self, it_ended: Callable[[], str]) -> None:
        self._it_ended = it_ended
        self._reader = FrameReader()
        self._decode = msgspec.msgpack.Decoder(FromWorker).decode
        self._transport: asyncio.Transport | None = None
        self._asked: dict[int, tuple[asyncio.Future[_Answer], float]] = {}
        self.ready: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self.lost = False
        self.has_answered = False

    @property
    def promised_s(self) -> float:
        """The time that all requests which are not answered may take together."""
        return sum(time_s for _, time_s in self._asked.values())

    def ask(self, ask: PlanningRequest, time_s: float) -> asyncio.Future[_Answer]:
        future: asyncio.Future[_Answer] = asyncio.get_running_loop().create_future()
        if self.lost:
            future.set_exception(_gone(self._it_ended()))
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
        reason = self._it_ended()
        waiting = [future for future, _ in self._asked.values()]
        self._asked.clear()
        for future in (self.ready, *waiting):
            if not future.done():
                future.set_exception(_gone(reason))
                # Who asked may have gone; then nobody else hears of it.
                future.exception()

    def _send(self, message: ToWorker) -> None:
        assert self._transport is not None
        self._transport.write(frame_message(msgspec.msgpack.encode(message)))


def _gone(reason: str) -> RobotError:
    return RobotError(reason, hint="plan again; a new process is started")
