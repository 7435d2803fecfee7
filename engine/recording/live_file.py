"""The live file of a recording: MCAP without chunks, every record flushed, so that a kill loses nothing.

A recording is passive: a write error ends the recording with a warning, never the run.
On a virtual clock records are written immediately; on a real clock by a separate thread, because a
disk may stall for an unbounded time.
"""

from __future__ import annotations

import fcntl
import logging
import queue
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import BinaryIO

from mcap.exceptions import McapError
from mcap.writer import Writer

from engine.errors import RecordingError
from engine.host.private_files import open_private

PROFILE = "flexcell"
MAX_TOPIC_BACKLOG = 32 * 2**20
"""Maximum number of unwritten bytes; beyond it, messages of topics are dropped."""
MAX_BACKLOG = 256 * 2**20
"""Maximum number of unwritten bytes; beyond it, the recording ends."""

_log = logging.getLogger("flexcell.recording")
_Job = Callable[[Writer], None]


class LiveFile:
    """One live recording; used on one thread. Open it with `LiveFile.open`, end it with `close`.

    Args:
        path: The path of the file.
        stream: The open file.
        inline: Write on the calling thread.
        max_topic_bytes: Maximum number of bytes of messages that may be dropped.
    """

    def __init__(self, path: Path, stream: BinaryIO, *, inline: bool, max_topic_bytes: int | None = None) -> None:
        self.path = path
        self.failure: str | None = None
        """Why the recording ended early; None without an error."""
        self.left_out = 0
        """Number of messages of topics dropped because the disk was too slow."""
        self._stream = stream
        self._writer = Writer(stream, use_chunking=False)
        self._schemas: dict[str, int] = {}
        self._channels = 0
        self._max_topic_bytes = max_topic_bytes
        self._topic_bytes = 0
        self._taken = 0
        self._written = 0
        self._jobs: queue.SimpleQueue[tuple[_Job, int] | None] = queue.SimpleQueue()
        self._thread: threading.Thread | None = None
        if not inline:
            self._thread = threading.Thread(target=self._work, name=f"recording {path.name}", daemon=True)
            self._thread.start()

    @classmethod
    def open(cls, path: Path, *, inline: bool, max_topic_bytes: int | None = None) -> LiveFile:
        """Create the file and lock it against other processes.

        Raises:
            RecordingError: it cannot be created, or another process records into it.
        """
        require_unused(path)
        try:
            stream = open_private(path)
            fcntl.flock(stream, fcntl.LOCK_EX)
        except OSError as error:
            reason = error.strerror or str(error)
            raise RecordingError(
                f"the recording cannot be created: {reason}", where=path, hint="give a file in a folder that exists"
            ) from error
        live = cls(path, stream, inline=inline, max_topic_bytes=max_topic_bytes)
        live._do(lambda writer: writer.start(profile=PROFILE, library="flexcell"))
        return live

    def describe(self, name: str, pairs: Mapping[str, str]) -> None:
        """Add a metadata record."""
        self._do(lambda writer: writer.add_metadata(name, dict(pairs)))

    def attach(self, name: str, content: bytes, *, media_type: str) -> None:
        """Add a document."""
        self._do(lambda writer: writer.add_attachment(0, 0, name, media_type, content), size=len(content))

    def channel(self, topic: str, schema_name: str, schema: bytes, *, metadata: Mapping[str, str]) -> int:
        """Add a channel of JSON messages and return its number; one schema name is one schema."""
        if schema_name not in self._schemas:
            self._schemas[schema_name] = len(self._schemas) + 1
            self._do(lambda writer: _register(writer, schema_name, schema))
        self._channels += 1
        number = self._schemas[schema_name]
        self._do(lambda writer: _open_channel(writer, topic, number, dict(metadata)))
        return self._channels

    def write(self, channel: int, at_ns: int, message: bytes, *, sequence: int = 0) -> None:
        """Add a message that must not be dropped."""
        self._do(lambda writer: writer.add_message(channel, at_ns, message, at_ns, sequence), size=len(message))

    def write_if_quick(self, channel: int, at_ns: int, message: bytes, *, sequence: int = 0) -> None:
        """Add a message, or drop it if the disk is too slow or such messages have reached their limit."""
        if self._max_topic_bytes is not None:
            if self._topic_bytes > self._max_topic_bytes:
                return
            self._topic_bytes += len(message)
            if self._topic_bytes > self._max_topic_bytes:
                _log.warning("%s has reached its maximum size: only events are recorded from here on", self.path)
                return
        if self._taken - self._written > MAX_TOPIC_BACKLOG:
            self.left_out += 1
            return
        self.write(channel, at_ns, message, sequence=sequence)

    def give_up(self, reason: str) -> None:
        """Stop writing; the file stays valid."""
        if self.failure is None:
            self.failure = reason
            _log.warning("the recording ends here, the run continues: %s: %s", self.path, reason)

    def close(self) -> None:
        """Write queued records and close the file; may be called again."""
        if self._thread is not None:
            self._jobs.put(None)
            self._thread.join()
            self._thread = None
        if self._stream.closed:
            return
        try:
            self._stream.close()
        except OSError as error:
            # The buffered data could not be written; the rest of the file is valid.
            self.give_up(_reason(error))

    def _do(self, job: _Job, *, size: int = 64) -> None:
        if self.failure is not None:
            return
        if self._thread is None:
            self._perform(job)
            return
        self._taken += size
        if self._taken - self._written > MAX_BACKLOG:
            self.give_up("the disk is too slow")
            return
        self._jobs.put((job, size))

    def _work(self) -> None:
        while (item := self._jobs.get()) is not None:
            job, size = item
            if self.failure is None:
                self._perform(job)
            # Only this thread increments it, and only the other one increments `_taken`: neither needs a lock.
            self._written += size

    def _perform(self, job: _Job) -> None:
        try:
            job(self._writer)
            self._writer.flush()
        except (OSError, McapError, ValueError) as error:
            self.give_up(_reason(error))


def require_unused(path: Path) -> None:
    """Check that no other process records into this file.

    Raises:
        RecordingError: another process does.
    """
    if not path.is_file():
        return
    try:
        with path.open("rb") as stream:
            fcntl.flock(stream, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise RecordingError(
            "another process is recording into this file", where=path, hint="give another file"
        ) from error
    except OSError:
        return  # unreadable; creating it raises the reason


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)


def _register(writer: Writer, name: str, schema: bytes) -> None:
    writer.register_schema(name, "jsonschema", schema)


def _open_channel(writer: Writer, topic: str, schema: int, metadata: dict[str, str]) -> None:
    writer.register_channel(topic, "json", schema, metadata)
