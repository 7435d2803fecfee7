"""Matches the requests of a driver with those of a capture, in order; knows no socket and no time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from robots.drivers.replay.request_rules import RequestKind, RequestRule
from robots.io.wire.read_capture import CapturedConnection, CapturedEvent

_SHOWN_BYTES = 32


@dataclass(frozen=True, kw_only=True)
class RecordedReply:
    """What the device sent so long after the request before.

    `ends` where it closed the connection instead; `echoes` where it repeated the last set point.
    """

    delay_s: float
    data: bytes = b""
    ends: bool = False
    echoes: bool = False


@dataclass(kw_only=True)
class RecordedExchange:
    """A request, or the beginning of a connection, and what the device sent until the next one.

    `echo` is the answer that repeats the last set point before it; empty where there is none.
    """

    request: bytes
    echo: bytes = b""
    offset: int
    at_s: float
    replies: list[RecordedReply] = field(default_factory=list[RecordedReply])


class ReplayMismatch(Exception):
    """The driver does not do what was recorded; says at which offset of the capture, and with which bytes."""


class CaptureReplay:
    """The device's side of one captured connection, with all its openings.

    Args:
        captured: The connection.
        rule: How its requests are told apart.
    """

    def __init__(self, captured: CapturedConnection, rule: RequestRule) -> None:
        self._rule = rule
        self._openings = _openings(captured.events, rule)
        self._opening = -1
        self._next = 0
        self._latest: dict[bytes, RecordedExchange] = {}
        self._set_point = self._buffer = b""
        self.answered = self.repeated = 0
        """Requests that were answered as recorded, and those of them that were answered as before."""

    @property
    def remaining_commands(self) -> int:
        """Commands of this opening that the driver has not sent yet."""
        rest = self._exchanges[self._next :] if self._opening >= 0 else []
        return sum(self._rule.kind(each.request) is RequestKind.COMMAND for each in rest)

    def open(self) -> list[RecordedReply]:
        """Begin the next recorded opening, after the last the first; returns what the device sends unasked."""
        self._opening = (self._opening + 1) % len(self._openings)
        self._next, self._latest = 1, {}
        self._set_point = self._buffer = b""
        return self._exchanges[0].replies

    def feed(self, received: bytes) -> list[RecordedReply]:
        """Take bytes of the driver and return the replies to what is complete.

        Raises:
            ReplayMismatch: it is not what was recorded.
        """
        replies = [] if self._opening >= 0 else self.open()
        self._buffer += received
        while self._buffer and (size := self._rule.length(self._buffer)):
            request, self._buffer = self._buffer[:size], self._buffer[size:]
            exchange = self._match(request)
            self.answered += 1
            if self._rule.kind(request) is RequestKind.SET_POINT:
                self._set_point = request
            replies += [replace(each, data=self._answer(each, request)) for each in exchange.replies]
        return replies

    def _answer(self, reply: RecordedReply, request: bytes) -> bytes:
        if reply.ends:
            return b""
        if reply.echoes and self._rule.echo is not None and self._set_point:
            return self._rule.echo(self._set_point)
        return self._rule.answer(reply.data, request)

    @property
    def _exchanges(self) -> list[RecordedExchange]:
        return self._openings[self._opening]

    def _match(self, request: bytes) -> RecordedExchange:
        rule, key, exchanges = self._rule, self._rule.key(request), self._exchanges
        kind = rule.kind(request)
        command = next(
            (at for at in range(self._next, len(exchanges)) if rule.kind(exchanges[at].request) is RequestKind.COMMAND),
            len(exchanges),
        )
        if kind is RequestKind.COMMAND:
            if command == len(exchanges) or rule.key(exchanges[command].request) != key:
                raise self._mismatch(request, command)
            return self._advance(command)
        for at in range(self._next, command):
            other = exchanges[at].request
            if rule.kind(other) is kind and rule.key(other) == key:
                return self._advance(at)
        if key in self._latest:
            self.repeated += 1
            return self._latest[key]
        raise self._mismatch(request, self._next)

    def _advance(self, at: int) -> RecordedExchange:
        for exchange in self._exchanges[self._next : at + 1]:
            if self._rule.kind(exchange.request) is not RequestKind.COMMAND:
                self._latest[self._rule.key(exchange.request)] = exchange
        self._next = at + 1
        return self._exchanges[at]

    def _mismatch(self, request: bytes, at: int) -> ReplayMismatch:
        kind, sent = self._rule.kind(request).value, _shown(request)
        if at >= len(self._exchanges):
            last = self._exchanges[-1]
            return ReplayMismatch(
                f"the {kind} {sent} is sent behind the last request of the capture, at offset {last.offset}"
            )
        recorded = self._exchanges[at]
        return ReplayMismatch(
            f"offset {recorded.offset} of the capture, {recorded.at_s:.3f} s: recorded {_shown(recorded.request)},"
            f" received the {kind} {sent}"
        )


def _openings(events: Sequence[CapturedEvent], rule: RequestRule) -> list[list[RecordedExchange]]:
    """Return the exchanges of each opening; one that began before the capture counts too."""
    openings: list[list[RecordedExchange]] = []
    echo = begun = b""
    following = [each.kind for each in events[1:]] + [""]
    for event, next_kind in zip(events, following, strict=True):
        if event.kind == "opened" or not openings:
            openings.append([RecordedExchange(request=b"", offset=event.offset, at_s=event.time_s)])
        exchanges = openings[-1]
        match event.kind:
            case "sent":
                requests = rule.split(begun + event.data)
                begun = b""
                if next_kind == "sent" and requests and not rule.length(requests[-1]):
                    begun = requests.pop()  # sent in pieces
                for request in requests:
                    exchanges.append(RecordedExchange(request=request, offset=event.offset, at_s=event.time_s))
                    if rule.echo is not None and rule.kind(request) is RequestKind.SET_POINT:
                        echo = rule.echo(request)
                    exchanges[-1].echo = echo
            case "received" | "ended":
                delay_s = event.time_s - exchanges[-1].at_s
                reply = RecordedReply(delay_s=delay_s, data=event.data, ends=event.kind == "ended")
                exchanges[-1].replies.append(reply)
            case _:
                pass
    if rule.number_bytes or rule.echo is not None:
        for exchange in (each for opening in openings for each in opening):
            _join(exchange)
    return openings


def _join(exchange: RecordedExchange) -> None:
    """Make one reply of what was received in pieces: its bytes are compared or changed as a whole."""
    pieces = [each for each in exchange.replies if not each.ends]
    if pieces:
        data = b"".join(each.data for each in pieces)
        whole = replace(pieces[-1], data=data, echoes=bool(exchange.echo) and data == exchange.echo)
        exchange.replies[:] = [whole, *(each for each in exchange.replies if each.ends)]


def _shown(data: bytes) -> str:
    more = " …" if len(data) > _SHOWN_BYTES else ""
    return f"{data[:_SHOWN_BYTES].hex(' ')}{more}"
