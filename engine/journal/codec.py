"""Turns events into JSON and back; the same events always give the same bytes."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from engine.errors import JournalError
from engine.event import AnyEvent, Event

_ENCODER = msgspec.json.Encoder(order="deterministic")
_UNWRITABLE = (TypeError, ValueError, OverflowError, RecursionError)
_DECODER: msgspec.json.Decoder[AnyEvent] = msgspec.json.Decoder(AnyEvent)


def encode_event(event: Event) -> bytes:
    """Return one line of JSON without its newline, keys of dictionaries sorted.

    A non-finite float inside userdata becomes null: JSON has no such number.

    Raises:
        JournalError: a value inside the event cannot be written as JSON.
    """
    try:
        return _ENCODER.encode(event)
    except _UNWRITABLE as error:
        raise JournalError(
            f"event {event.seq} ({type(event).__name__}) cannot be written as JSON: {error}",
            where=getattr(event, "path", None),
            hint="userdata and requests may hold numbers, text, lists, dictionaries and messages only",
        ) from error


def decode_event(data: bytes | str) -> AnyEvent:
    """Read one event back; messages inside userdata come back as plain dictionaries.

    Raises:
        JournalError: the text is not an event.
    """
    try:
        return _DECODER.decode(data)
    except (msgspec.DecodeError, RecursionError) as error:
        raise _no_event(error) from error


def encode_event_log(events: Iterable[Event]) -> bytes:
    """Return JSON lines, one event each, every line ended; two equal runs give equal bytes.

    Raises:
        JournalError: a value inside an event cannot be written as JSON.
    """
    known = list(events)
    try:
        return _ENCODER.encode_lines(known)
    except _UNWRITABLE:
        # Once more, one by one: which event it is must be told.
        return b"".join(encode_event(event) + b"\n" for event in known)


def decode_event_log(data: bytes) -> tuple[AnyEvent, ...]:
    """Read back what `encode_event_log` gave.

    Raises:
        JournalError: a line is not an event.
    """
    try:
        return tuple(_DECODER.decode_lines(data))
    except (msgspec.DecodeError, RecursionError) as error:
        raise _no_event(error) from error


def _no_event(error: Exception) -> JournalError:
    return JournalError(f"this is not an event: {error}", hint="the journal is damaged or of another version")
