"""Messages between the engine, the relay's process and the stop lines: one JSON object per line."""

from __future__ import annotations

import socket
from typing import Literal

import msgspec

MAX_MESSAGE = 16_384
_READ_BYTES = 65536
MAX_REASON = 500


class _Message(msgspec.Struct, frozen=True, kw_only=True, tag_field="message"):
    """Base of the messages."""


class StopNotice(_Message, frozen=True, kw_only=True, tag="stop"):
    """A stop of the cell: a device's process latches, the engine ends its runs.

    `stop` counts from 1. `source` is a page or client over `http`, the `engine` itself, a `signal` that the engine
    did not answer, or the `loss` of the engine.
    """

    stop: int
    reason: str
    source: Literal["http", "engine", "signal", "loss"]


class StopRelease(_Message, frozen=True, kw_only=True, tag="release"):
    """The engine has ended its runs: a device that is latched by this stop or an earlier one unlatches."""

    stop: int


class StopAcknowledgement(_Message, frozen=True, kw_only=True, tag="acknowledged"):
    """A device has received a stop and decelerates; with `at_rest` it has come to rest."""

    stop: int
    at_rest: bool


class RelaySettings(_Message, frozen=True, kw_only=True, tag="settings"):
    """Engine to relay: the token for STOP over HTTP, origins of pages that may read responses, effect of signals."""

    token: str
    origins: tuple[str, ...]
    stops_at_signals: bool = False


class NewStopLine(_Message, frozen=True, kw_only=True, tag="new_line"):
    """Engine to relay: the attached descriptor is the relay's end of the stop line of `device`."""

    device: str


class StopCommand(_Message, frozen=True, kw_only=True, tag="order"):
    """Engine to relay: stop everything; answered by `StopCommandReply` with the same `request`."""

    reason: str
    request: int


class StopCommandReply(_Message, frozen=True, kw_only=True, tag="ordered"):
    """Relay to engine: the stop has been sent to every line."""

    stop: int
    request: int


class EngineProbe(_Message, frozen=True, kw_only=True, tag="probe"):
    """Relay to engine: liveness probe; the event loop replies at once."""

    number: int


class ProbeReply(_Message, frozen=True, kw_only=True, tag="reply"):
    """Engine to relay: the event loop runs and has received every message before this probe."""

    number: int


class RelayReady(_Message, frozen=True, kw_only=True, tag="ready"):
    """Relay to engine: the relay is ready."""


class CloseRelay(_Message, frozen=True, kw_only=True, tag="close"):
    """Engine to relay: all devices are at rest and closed; end without a stop."""


ToRelay = RelaySettings | NewStopLine | StopCommand | StopRelease | ProbeReply | CloseRelay
FromRelay = RelayReady | StopNotice | StopCommandReply | EngineProbe
ToDevice = StopNotice | StopRelease


class DeviceStop(msgspec.Struct, frozen=True, kw_only=True):
    """The status of a stop at one device; `connected` is false once its process has ended."""

    name: str
    connected: bool
    acknowledged: bool
    at_rest: bool


class StopStatus(msgspec.Struct, frozen=True, kw_only=True):
    """The response to STOP: `acknowledged` once every connected device has it; `stop` is 0 before the first.

    `engine` is `informed` when its event loop has received the stop, `silent` while it is blocked or frozen, `ended`
    when its process has ended. `after_s` is the time from STOP to this response.
    """

    stop: int
    reason: str
    acknowledged: bool
    at_rest: bool
    engine: Literal["informed", "silent", "ended"]
    after_s: float
    devices: tuple[DeviceStop, ...]


class MessageReader:
    """Splits a byte stream into messages of one union of types."""

    def __init__(self, types: object) -> None:
        self._decoder: msgspec.json.Decoder[object] = msgspec.json.Decoder(types)  # pyright: ignore[reportCallIssue, reportArgumentType, reportUnknownMemberType]
        self._waiting = bytearray()

    def feed(self, data: bytes) -> list[object]:
        """Append bytes and return the messages that are now complete.

        Raises:
            msgspec.DecodeError: a line is not a message of these types; the rest of the stream cannot be trusted.
        """
        self._waiting += data
        *lines, rest = self._waiting.split(b"\n")
        if len(rest) > MAX_MESSAGE:
            raise msgspec.DecodeError(f"a message is longer than {MAX_MESSAGE} bytes")
        self._waiting = bytearray(rest)
        return [self._decoder.decode(line) for line in lines]

    def receive(self, connection: socket.socket) -> tuple[list[object], bool]:
        """Read the available messages of a non-blocking socket.

        Returns:
            The messages, and whether the stream has ended: closed by the other end, cut, or not a message stream.
        """
        try:
            data = connection.recv(_READ_BYTES)
            return self.feed(data), not data
        except BlockingIOError:
            return [], False
        except (OSError, msgspec.DecodeError):
            return [], True


def encode_message(message: ToRelay | FromRelay | ToDevice | StopAcknowledgement) -> bytes:
    """Return a message as one line of JSON."""
    return msgspec.json.encode(message) + b"\n"
