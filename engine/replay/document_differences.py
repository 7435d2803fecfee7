"""Differences that no event tells: records altered after the run that nothing read, and changed defaults."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from engine.document import Behavior
from engine.journal import encode_event
from engine.recording import Recording, recorded_behavior
from engine.replay.replay_difference import ReplayDifference
from engine.runtime.history.event_texts import event_text

_LONGEST = 240


def altered_records(recording: Recording) -> Iterator[ReplayDifference]:
    """Go through the events that were altered after the run, by their digests."""
    for index, digest in sorted((recording.altered or {}).items()):
        recorded = f"an event with digest {digest}" if digest else "no such event"
        if index >= len(recording.events):
            last = recording.events[-1].event
            yield ReplayDifference(
                number=last.seq + 1,
                time_s=last.time_s,
                path="",
                recorded=recorded,
                replayed="nothing",
                detail="the recording was altered after the run: events are missing",
            )
            return
        event = recording.events[index].event
        yield ReplayDifference(
            number=event.seq,
            time_s=event.time_s,
            path=getattr(event, "path", ""),
            recorded=recorded,
            replayed=f"`{event_text(event).text}`, {_short(encode_event(event).decode())}",
            detail="the recording was altered after the run",
        )


def changed_defaults(recording: Recording, behavior: Behavior) -> Iterator[ReplayDifference]:
    """Go through the parameters that the run had by default, and would have otherwise with this behavior.

    A replay sets the recorded values, so no event tells it.
    """
    before = recorded_behavior(recording.documents).parameters
    started = recording.events[0].event
    for name, spec in behavior.parameters.items():
        former = before.get(name)
        value = recording.description.parameters.get(name)
        if former is None or former.required or value != former.default or spec.default == former.default:
            continue
        yield ReplayDifference(
            number=started.seq,
            time_s=started.time_s,
            path="",
            recorded=f"parameter `{name} = {_json(former.default)}`, by default",
            replayed=f"no default for `{name}`" if spec.required else f"default `{name} = {_json(spec.default)}`",
            detail=f"a run would differ; to keep the value, set it: -p {name}={_json(former.default)}",
        )


def _short(text: str) -> str:
    return text if len(text) <= _LONGEST else text[: _LONGEST - 1] + "…"


def _json(value: object) -> str:
    return msgspec.json.encode(value).decode()
