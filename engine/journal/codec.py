"""Encodes events as JSON and decodes them; equal events give equal bytes."""

from __future__ import annotations

from collections.abc import Iterable

import msgspec

from engine.errors import JournalError
from engine.event import AnyEvent, Event

_ENCODER = msgspec.json.Encoder(order="deterministic")
_UNWRITABLE = (TypeError, ValueError, OverflowError, RecursionError)
_DECODER: msgspec.json.Decoder[AnyEvent] = msgspec.json.Decoder(AnyEvent)


def encode_event(event: Event) -> bytes:
    """Return one line of JSON without its newline, with sorted dictionary keys.

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
            hint="use only numbers, text, lists, dictionaries and messages in userdata and requests",
        ) from error


def decode_event(data: bytes | str) -> AnyEvent:
    """Decode one event; messages inside userdata become plain dictionaries.

    Raises:
        JournalError: the text is not an event.
    """
    try:
        return _DECODER.decode(data)
    except (msgspec.DecodeError, RecursionError) as error:
        raise _not_an_event(error) from error


def encode_event_log(events: Iterable[Event]) -> bytes:
    """Return JSON lines, one event per line, each with a newline; equal runs give equal bytes.

    Raises:
        JournalError: a value inside an event cannot be written as JSON.
    """
    all_events = list(events)
    try:
        return _ENCODER.encode_lines(all_events)
    except _UNWRITABLE:
        # Encode again one by one: the error must name the event.
        return b"".join(encode_event(event) + b"\n" for event in all_events)


def decode_event_log(data: bytes) -> tuple[AnyEvent, ...]:
    """Decode the output of `encode_event_log`.

    Raises:
        JournalError: a line is not an event.
    """
    try:
        return tuple(_DECODER.decode_lines(data))
    except (msgspec.DecodeError, RecursionError) as error:
        raise _not_an_event(error) from error


def _not_an_event(error: Exception) -> JournalError:
    return JournalError(f"this is not an event: {error}", hint="the journal is damaged or of another version")
