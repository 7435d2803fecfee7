"""Records one run into an MCAP file: its events, its documents, and the topics of the bus."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Self

import msgspec

from engine.bus import SkillBus
from engine.errors import JournalError, RecordingError
from engine.event import AnyEvent, Event
from engine.journal import encode_event
from engine.recording.channel_schema import channel_schema
from engine.recording.description import RECORD_NAME, RecordingDescription, present_versions, to_metadata
from engine.recording.event_digests import DIGESTS_NAME, EventDigests
from engine.recording.finalization import EVENT_TOPIC, finalize_recording, part_file, recovered_file
from engine.recording.foxglove_views import FoxgloveLog, log_line
from engine.recording.live_file import LiveFile, require_unused
from engine.recording.recorded_documents import YAML_TYPE, RecordedDocuments
from engine.recording.topic_tap import TopicTap
from engine.runtime.run import Run
from engine.runtime.run_options import RunOptions

DEFAULT_RATE_HZ = 50.0
LOG_TOPIC = "/foxglove/log"

_log = logging.getLogger("flexcell.recording")


@dataclass(frozen=True, kw_only=True)
class RecordingOptions:
    """Path, documents and topics of a recording."""

    path: Path
    documents: RecordedDocuments
    rate_hz: float = DEFAULT_RATE_HZ
    """Maximum recorded rate of a topic, in messages per second; 0 records none."""
    topics: Sequence[str] = ("*",)
    """Names of topics, may hold `*` and `?`."""
    left_out: Sequence[str] = ()
    """Names of topics that are never recorded, even if `topics` matches."""
    passive_topics: Sequence[str] = ()
    """Names of topics that are recorded only while another subscriber exists (expensive topics)."""
    max_topic_bytes: int | None = None
    """Maximum size of topics in the live file, which is not compressed; beyond it, only events are recorded."""


class RunRecording:
    """Recorder of one run, from before its start to after its end; an async context manager.

    During the run the file is `<path>.part`. Create it with `open` before the run starts; then
    `attach` the run before it is executed. File errors never affect the run.
    """

    def __init__(self, order: RecordingOptions, file: LiveFile) -> None:
        self._order = order
        self._file = file
        self._tap: TopicTap | None = None
        self._bus: SkillBus | None = None
        self._run: Run | None = None
        self._zero_s = 0.0
        self._epoch_ns = 0
        self._events = 0
        self._digests = EventDigests()
        self._closed = False
        self._event_channel = 0
        self._log_channel = 0

    @classmethod
    def open(cls, order: RecordingOptions, *, inline: bool) -> Self:
        """Create the file; an earlier recording of a killed process is recovered next to it.

        Args:
            order: What to record.
            inline: Write on the calling thread, as required on a virtual clock.

        Raises:
            RecordingError: the file cannot be created, or another process records into it.
        """
        part = part_file(order.path)
        require_unused(part)
        if part.is_file():
            kept = recovered_file(order.path)
            try:
                finalize_recording(part, kept)
                _log.warning("an earlier recording is truncated; its complete records are in %s", kept)
            except RecordingError as error:
                # An unreadable earlier recording must not prevent the new one.
                _log.warning("an earlier recording is truncated and cannot be recovered: %s", error)
        return cls(order, LiveFile.open(part, inline=inline, max_topic_bytes=order.max_topic_bytes))

    def attach(
        self,
        run: Run,
        bus: SkillBus,
        *,
        started_unix_s: float,
        inputs: Mapping[str, object] | None = None,
        supervision: RunOptions | None = None,
    ) -> None:
        """Record this run from its first event on."""
        order, file = self._order, self._file
        self._run, self._bus = run, bus
        self._zero_s = bus.clock.now_s()
        self._epoch_ns = 0 if bus.clock.virtual else round(started_unix_s * 1e9)
        description = RecordingDescription(
            run=run.id,
            behavior=run.plan.name,
            document=run.plan.document_hash,
            behavior_file=order.documents.behavior,
            cell_file=order.documents.cell,
            meshes=dict(order.documents.meshes),
            parameters=msgspec.to_builtins(run.parameters),
            inputs=msgspec.to_builtins(dict(inputs or {})),
            seed=run.seed,
            clock="virtual" if bus.clock.virtual else "real",
            supervision=supervision or RunOptions(),
            started_unix_s=started_unix_s,
            epoch_ns=self._epoch_ns,
            topic_rate_hz=order.rate_hz,
            topics=tuple(order.topics),
            versions=present_versions(),
        )
        file.describe(RECORD_NAME, to_metadata(description))
        for name, text in order.documents.texts.items():
            file.attach(name, text, media_type=YAML_TYPE)
        self._open_channels()
        run.watch(self._take)
        if order.rate_hz > 0:
            self._tap = TopicTap(
                file,
                now_ns=self._now_ns,
                rate_hz=order.rate_hz,
                patterns=order.topics,
                left_out=order.left_out,
                passive_topics=order.passive_topics,
            )
            self._tap.open(bus)

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close and finalize the file; a failure is logged as a warning, because the run is complete."""
        self.detach()
        closing = asyncio.get_running_loop().run_in_executor(None, self._finish)
        await asyncio.shield(closing)

    def detach(self) -> None:
        """Stop recording the run."""
        if self._run is not None:
            self._run.recorder.unwatch(self._take)
        if self._tap is not None:
            self._tap.close()
            self._tap = None

    def close(self) -> None:
        """Write queued records and keep the live file `<path>.part`; may block on the disk."""
        if not self._closed and self._events > 0:
            self._file.describe(DIGESTS_NAME, self._digests.to_metadata())
        self._closed = True
        self._file.close()
        if self._file.left_out:
            _log.warning(
                "%d messages were dropped from %s: the disk is too slow", self._file.left_out, self._order.path
            )

    def _finish(self) -> None:
        self.close()
        try:
            finalize_recording(part_file(self._order.path), self._order.path)
        except RecordingError as error:
            _log.warning("%s", error)

    def _open_channels(self) -> None:
        file = self._file
        events = channel_schema(AnyEvent, title="flexcell.Event")
        self._event_channel = file.channel(EVENT_TOPIC, "flexcell.Event", events, metadata={})
        log = channel_schema(FoxgloveLog, title="foxglove.Log")
        self._log_channel = file.channel(LOG_TOPIC, "foxglove.Log", log, metadata={})

    def _take(self, event: Event) -> None:
        self._events += 1
        now_ns = self._now_ns()
        try:
            encoded = encode_event(event)
        except JournalError as error:
            # Without this event it could not be replayed; therefore it ends here.
            self._file.give_up(error.message)
            return
        self._file.write(self._event_channel, now_ns, encoded, sequence=self._events)
        self._digests.add(encoded)
        line = log_line(event, now_ns)
        if line is not None:
            self._file.write_if_quick(self._log_channel, now_ns, msgspec.json.encode(line), sequence=self._events)

    def _now_ns(self) -> int:
        bus = self._bus
        return self._epoch_ns + (round((bus.clock.now_s() - self._zero_s) * 1e9) if bus is not None else 0)
