"""Records the topics of a bus, each up to a maximum rate."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import Any

import msgspec

from engine.bus import SkillBus, Subscription, Topic
from engine.recording.channel_schema import channel_schema
from engine.recording.foxglove_views import VIEWS, FoxgloveView
from engine.recording.live_file import LiveFile

_SLACK_NS = 1000
"""Tolerance for early messages: clocks round."""

_log = logging.getLogger("flexcell.recording")


@dataclass(kw_only=True)
class _Recorded:
    """Recording of one topic."""

    channel: int
    view: FoxgloveView | None
    view_channel: int
    due_ns: int = 0
    last: object = None
    count: int = 0


class TopicTap:
    """Subscribes to the topics whose names match, including topics created later.

    Args:
        file: The file of the messages.
        now_ns: The time of the recording.
        rate_hz: Maximum recorded rate of a topic.
        patterns: Names, may hold `*` and `?`.
        left_out: Names that are never recorded.
        passive_topics: Names that are recorded without creating demand for them.
    """

    def __init__(
        self,
        file: LiveFile,
        *,
        now_ns: Callable[[], int],
        rate_hz: float,
        patterns: Sequence[str],
        left_out: Sequence[str] = (),
        passive_topics: Sequence[str] = (),
    ) -> None:
        self._file = file
        self._now_ns = now_ns
        self._period_ns = round(1e9 / rate_hz)
        self._rate_hz = rate_hz
        self._patterns = tuple(patterns)
        self._left_out = tuple(left_out)
        self._overheard = tuple(passive_topics)
        self._recorded: dict[str, _Recorded] = {}
        self._subscriptions: list[tuple[Topic[Any], Subscription[Any]]] = []
        self._unwatch: Callable[[], None] = lambda: None

    def open(self, bus: SkillBus) -> None:
        """Start recording, beginning with the latest message of each topic."""
        self._unwatch = bus.watch_topics(self._add)

    def close(self) -> None:
        """Record the latest message of each topic if it was dropped, and stop."""
        self._unwatch()
        for topic, subscription in self._subscriptions:
            subscription.close()
            try:
                message = topic.latest
                if message is not None and message != self._recorded[topic.name].last:
                    self._write(topic.name, message)
            except Exception:
                # As above; the run has ended, and the other topics have last messages too.
                _log.exception("the last message of topic %s is not recorded", topic.name)
        self._subscriptions.clear()

    def _add(self, topic: Topic[Any]) -> None:
        if not _matches(topic.name, self._patterns) or _matches(topic.name, self._left_out):
            return
        if not issubclass(topic.kind, msgspec.Struct):
            _log.warning("topic %s is not recorded: its messages are not structs", topic.name)
            return
        try:
            self._recorded[topic.name] = self._channels(topic)
            if topic.latest is not None:
                self._write(topic.name, topic.latest)
        except Exception:
            # Types and messages come from robot drivers; an encoding error must not affect the publisher.
            _log.exception("topic %s is not recorded", topic.name)
            return
        listen = topic.subscribe_passively if _matches(topic.name, self._overheard) else topic.subscribe
        subscription = listen(lambda message: self._take(topic.name, message))
        self._subscriptions.append((topic, subscription))

    def _channels(self, topic: Topic[Any]) -> _Recorded:
        limit = {"max_rate_hz": f"{self._rate_hz:g}"}
        name = f"flexcell.{topic.kind.__name__}"
        channel = self._file.channel(f"/{topic.name}", name, channel_schema(topic.kind, title=name), metadata=limit)
        view = VIEWS.get(topic.kind)
        if view is None:
            return _Recorded(channel=channel, view=None, view_channel=0)
        schema = channel_schema(view.kind, title=view.schema_name)
        shown = self._file.channel(view.topic(topic.name), view.schema_name, schema, metadata=limit)
        return _Recorded(channel=channel, view=view, view_channel=shown)

    def _take(self, name: str, message: msgspec.Struct) -> None:
        if self._now_ns() >= self._recorded[name].due_ns - _SLACK_NS:
            self._write(name, message)

    def _write(self, name: str, message: object) -> None:
        recorded = self._recorded[name]
        now_ns = self._now_ns()
        # From the due time, not from now: otherwise jitter would drop messages of topics at about this rate.
        recorded.due_ns = max(recorded.due_ns, now_ns - self._period_ns) + self._period_ns
        recorded.last = message
        recorded.count += 1
        encoded = msgspec.json.encode(message)
        self._file.write_if_quick(recorded.channel, now_ns, encoded, sequence=recorded.count)
        if recorded.view is not None:
            shown = msgspec.json.encode(recorded.view.show(message, now_ns))
            self._file.write_if_quick(recorded.view_channel, now_ns, shown, sequence=recorded.count)


def _matches(name: str, patterns: tuple[str, ...]) -> bool:
    return any(fnmatchcase(name, pattern) for pattern in patterns)
