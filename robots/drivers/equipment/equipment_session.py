"""One connection to an equipment server: its frames, its name, and when it was heard last."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Awaitable, Callable

import msgspec

from engine.errors import RobotError
from robots.drivers.equipment.wire.equipment_messages import EquipmentAnswer, EquipmentRefusal, EquipmentRequest
from robots.io.framing import FrameReader, frame_payload
from robots.io.message_codec import encode_payload, payload_decoder

_READ_BYTES = 1 << 16
_MOST_UNREAD = 1 << 20
_decode: Callable[[bytes], EquipmentRequest] = payload_decoder(EquipmentRequest)

Answering = Callable[["EquipmentSession", EquipmentRequest], Awaitable[EquipmentAnswer]]


class EquipmentSession:
    """Answers the requests of one client, one after the other."""

    def __init__(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter, answer: Answering) -> None:
        self._reader = reader
        self._writer = writer
        self._answer = answer
        host, port = writer.get_extra_info("peername")[:2]
        self._address = f"{host}:{port}"
        self.name = ""
        self.heard_s = time.monotonic()
        self.lost_control = ""
        """Why it does not control any more."""
        self.ended = asyncio.Event()

    def __str__(self) -> str:
        return f"{self.name or 'a client'} at {self._address}"

    async def serve(self) -> None:
        """Answer until the client is gone or sends what is no message."""
        frames = FrameReader()
        try:
            while received := await self._reader.read(_READ_BYTES):
                for number, payload in frames.feed(received):
                    await self._take(number, payload)
        except (ConnectionError, asyncio.CancelledError):
            pass  # the client is gone, or the server ends
        except (RobotError, msgspec.MsgspecError) as error:
            self._send(0, EquipmentRefusal(reason=f"this is no message to an equipment server: {error}"))
        finally:
            self._writer.close()
            self.ended.set()

    def drop(self) -> None:
        """End the connection."""
        self._writer.transport.abort()

    async def _take(self, number: int, payload: bytes) -> None:
        request = _decode(payload)
        self.heard_s = time.monotonic()
        try:
            self._send(number, await self._answer(self, request))
        finally:
            # Its client has waited for the answer until now.
            self.heard_s = time.monotonic()

    def _send(self, number: int, answer: EquipmentAnswer) -> None:
        self._writer.write(frame_payload(encode_payload(answer), number=number))
        if self._writer.transport.get_write_buffer_size() > _MOST_UNREAD:
            raise ConnectionError("the client does not read its answers")
