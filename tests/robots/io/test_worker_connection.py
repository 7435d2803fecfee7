"""The parent's end of the wire: every request is answered or fails, and nonsense loses the process in words."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field

import msgspec
import pytest

from engine.errors import CellError, RobotError
from robots.io.framing import frame_payload
from robots.io.message_codec import encode_payload
from robots.io.request_failure import RequestFailure
from robots.io.worker_connection import WorkerConnection


class Word(msgspec.Struct, frozen=True, kw_only=True, tag="word"):
    """A question and an answer."""

    text: str


Answer = Word | RequestFailure


@dataclass
class Wire:
    """A connection, what it has told, and the socket of its process."""

    theirs: socket.socket
    connection: WorkerConnection[Word, Answer] = field(init=False)
    notices: list[Answer] = field(default_factory=list[Answer])
    losses: list[str] = field(default_factory=list[str])

    def say(self, message: Answer, *, number: int = 0) -> None:
        """Let the process send a message."""
        self.theirs.sendall(frame_payload(encode_payload(message), number=number))


@asynccontextmanager
async def connected() -> AsyncGenerator[Wire]:
    """Connect to a process of which only the socket exists."""
    ours, theirs = socket.socketpair()
    wire = Wire(theirs)
    with theirs:
        _, wire.connection = await asyncio.get_running_loop().create_connection(
            lambda: WorkerConnection[Word, Answer](
                Answer,
                what="the worker",
                hint="start it again",
                describe_end=lambda: "the worker was ended by SIGKILL",
                on_notice=wire.notices.append,
                on_lost=wire.losses.append,
            ),
            sock=ours,
        )
        yield wire
        wire.connection.close()
        await wire.connection.closed


async def test_answers_find_their_requests_in_any_order_and_other_messages_are_notices() -> None:
    async with connected() as wire:
        first, second = wire.connection.ask(Word(text="a")), wire.connection.ask(Word(text="b"))
        wire.say(Word(text="2"), number=second.number)
        wire.say(Word(text="hello"))
        wire.say(RequestFailure.of(CellError("no such arm", where="left", hint="name another")), number=first.number)
        wire.say(Word(text="late"), number=first.number)
        with pytest.raises(CellError, match="no such arm") as failed:
            await first.answer
        assert (failed.value.where, failed.value.hint) == ("left", "name another")
        assert await second.answer == Word(text="2")
        assert (wire.notices, wire.losses) == ([Word(text="hello")], [])


async def test_an_answer_that_nobody_waits_for_any_more_harms_nobody() -> None:
    async with connected() as wire:
        number, answer = wire.connection.ask(Word(text="a"))
        answer.cancel()
        wire.say(Word(text="1"), number=number)
        later = wire.connection.ask(Word(text="b"))
        wire.say(Word(text="2"), number=later.number)
        assert await later.answer == Word(text="2")


async def test_a_lost_process_fails_all_requests_now_and_later_and_is_reported_once() -> None:
    async with connected() as wire:
        answer = wire.connection.ask(Word(text="a")).answer
        wire.theirs.close()
        with pytest.raises(RobotError, match="SIGKILL") as lost:
            await answer
        assert lost.value.hint == "start it again"
        wire.connection.lose("another reason")
        with pytest.raises(RobotError, match="SIGKILL"):
            wire.connection.ask(Word(text="b"))
        with pytest.raises(RobotError, match="SIGKILL"):
            wire.connection.send(Word(text="b"))
        assert wire.losses == ["the worker was ended by SIGKILL"]


@pytest.mark.parametrize(
    "garbage",
    [
        b"\xff" * 64,
        frame_payload(b"\xc1garbage"),
        frame_payload(b""),
        frame_payload(msgspec.msgpack.encode({"type": "nobody"})),
    ],
)
async def test_garbage_from_the_process_loses_it_in_words(garbage: bytes) -> None:
    async with connected() as wire:
        answer = wire.connection.ask(Word(text="a")).answer
        wire.theirs.sendall(garbage)
        with pytest.raises(RobotError, match="the worker sent an invalid message"):
            await answer
        assert len(wire.losses) == 1
