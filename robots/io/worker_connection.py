"""The parent's end of the socket to a worker process: numbered requests, their answers, and its loss."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from types import UnionType
from typing import Generic, NamedTuple, TypeVar

import msgspec

from engine.errors import RobotError
from robots.io.framing import FrameReader, frame_payload
from robots.io.message_codec import encode_payload, payload_decoder
from robots.io.request_failure import RequestFailure

Sent = TypeVar("Sent")
Received = TypeVar("Received")


class PendingRequest(NamedTuple, Generic[Received]):
    """A request under way: its number, and its future answer."""

    number: int
    answer: asyncio.Future[Received]


class WorkerConnection(asyncio.Protocol, Generic[Sent, Received]):
    """Sends messages and completes requests; belongs to one event loop.

    Args:
        received: The union of the types of received messages.
        what: Names the process in messages.
        hint: What to do, or what is done, after a loss.
        describe_end: Returns why the process has ended; called once its socket is closed.
        on_notice: Called with messages that answer no request.
        on_lost: Called once with the reason, after all requests have failed.
    """

    def __init__(
        self,
        received: type[Received] | UnionType,
        *,
        what: str,
        hint: str,
        describe_end: Callable[[], str],
        on_notice: Callable[[Received], None],
        on_lost: Callable[[str], None],
    ) -> None:
        self._what = what
        self._hint = hint
        self._describe_end = describe_end
        self._on_notice = on_notice
        self._on_lost = on_lost
        self._loop = asyncio.get_running_loop()
        self._reader = FrameReader()
        self._decode: Callable[[bytes], Received] = payload_decoder(received)
        self._transport: asyncio.Transport | None = None
        self._numbers = 0
        self._asked: dict[int, asyncio.Future[Received]] = {}
        self.lost_reason = ""
        """Why the process is lost; empty while it can be asked."""
        self.closed: asyncio.Future[None] = self._loop.create_future()
        """Completes once the socket is closed."""

    def ask(self, message: Sent) -> PendingRequest[Received]:
        """Send a request. Its answer raises CellError if the process cannot carry it out.

        Raises:
            RobotError: the process is lost; the answer raises it when it is lost later.
        """
        self._numbers += 1
        self.send(message, number=self._numbers)
        answer: asyncio.Future[Received] = self._loop.create_future()
        self._asked[self._numbers] = answer
        return PendingRequest(self._numbers, answer)

    def send(self, message: Sent, *, number: int = 0) -> None:
        """Send a message that wants no answer; `number` is that of the request that it is about.

        Raises:
            RobotError: the process is lost.
        """
        if self.lost_reason:
            raise RobotError(self.lost_reason, hint=self._hint)
        assert self._transport is not None
        self._transport.write(frame_payload(encode_payload(message), number=number))

    def close(self) -> None:
        """Close the socket; requests under way fail soon after."""
        if self._transport is not None:
            self._transport.close()

    def lose(self, reason: str) -> None:
        """Fail all requests, now and from now on; a second reason is ignored."""
        if self.lost_reason:
            return
        self.lost_reason = reason
        waiting, self._asked = self._asked, {}
        for answer in waiting.values():
            _fail(answer, RobotError(reason, hint=self._hint))
        self._on_lost(reason)

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Start receiving; called by asyncio."""
        assert isinstance(transport, asyncio.Transport)
        self._transport = transport

    def data_received(self, data: bytes) -> None:
        """Handle received data; called by asyncio."""
        try:
            messages = [(number, self._decode(payload)) for number, payload in self._reader.feed(data)]
        except (RobotError, msgspec.MsgspecError) as error:
            # Nothing after it can be decoded either.
            self.lose(f"{self._what} sent an invalid message: {error}")
            self.close()
            return
        for number, message in messages:
            self._take(number, message)

    def connection_lost(self, exc: Exception | None) -> None:
        """Fail all requests: the process is lost; called by asyncio."""
        if not self.closed.done():
            self.closed.set_result(None)
        if not self.lost_reason:
            self.lose(self._describe_end())

    def _take(self, number: int, message: Received) -> None:
        if number == 0:
            self._on_notice(message)
            return
        answer = self._asked.pop(number, None)
        if answer is None or answer.done():
            return
        if isinstance(message, RequestFailure):
            _fail(answer, message.error())
        else:
            answer.set_result(message)


def _fail(answer: asyncio.Future[Received], error: Exception) -> None:
    if not answer.done():
        answer.set_exception(error)
        # Marks the exception as retrieved: whoever asked may no longer wait.
        answer.exception()
