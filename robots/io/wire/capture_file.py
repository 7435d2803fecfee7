"""Writes the events of one connection to files, in a thread of its own: whoever notes an event never waits for a disk.

A file is ended at a size, and the oldest of the same connection are deleted. What the disk does not take in time is
dropped and counted; a disk that is full ends the capture, and nothing else.
"""

from __future__ import annotations

import logging
import re
import threading
import time
import weakref
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import BinaryIO

from robots.io.wire.packet_headers import PacketEncoder
from robots.io.wire.pcapng_blocks import (
    CaptureInterface,
    CaptureSection,
    CaptureStatistics,
    encode_block,
)
from robots.io.wire.wire_tap import WireEvent

_WRITE_S = 0.1
# An event takes 32 µs: a control loop in this process gets the interpreter in between.
_SLICE_EVENTS, _PAUSE_S = 20, 0.002
_JOIN_S = 2.0
_log = logging.getLogger("flexcell.devices")


@dataclass(frozen=True, kw_only=True)
class CaptureLimits:
    """Bytes of a file and of all files of one connection, and events that wait for the disk."""

    file_bytes: int = 16 << 20
    files: int = 8
    waiting: int = 20_000


@dataclass
class _Queue:
    """What the noting and the writing thread share; each field has one thread that assigns it."""

    events: deque[WireEvent] = field(default_factory=deque[WireEvent])
    closing: threading.Event = field(default_factory=threading.Event)
    dropped: int = 0
    has_ended: bool = False


class CaptureFile:
    """The capture of one connection; its writer ends with it, or with `close`.

    Args:
        folder: Where its files are; exists.
        device: The device, as on the bus.
        protocol: What is spoken on the connection, which also distinguishes it from the device's others.
        limits: Its sizes.
    """

    def __init__(self, folder: Path, *, device: str, protocol: str, limits: CaptureLimits | None = None) -> None:
        self._limits = limits or CaptureLimits()
        self._queue = _Queue()
        self._writer = _CaptureWriter(folder, device, protocol, self._limits, self._queue)
        self._thread = threading.Thread(target=self._writer.work, name=f"capture {device} {protocol}", daemon=True)
        self._finalize = weakref.finalize(self, _end, self._queue, self._thread)

    @property
    def dropped(self) -> int:
        """Number of events that were dropped because the disk was too slow."""
        return self._queue.dropped

    def note(self, event: WireEvent) -> None:
        """Take an event."""
        queue = self._queue
        if queue.has_ended:
            return
        if len(queue.events) >= self._limits.waiting:
            queue.dropped += 1
            return
        queue.events.append(event)
        if not self._thread.ident:
            self._thread.start()

    def close(self) -> None:
        """Write what waits, and end."""
        self._finalize()


def _end(queue: _Queue, thread: threading.Thread) -> None:
    queue.closing.set()
    if thread.ident:
        thread.join(_JOIN_S)


class _CaptureWriter:
    """The writing thread of a capture; it must not refer to the `CaptureFile`, whose end ends it."""

    def __init__(self, folder: Path, device: str, protocol: str, limits: CaptureLimits, queue: _Queue) -> None:
        self._folder = folder
        self._device = device
        self._protocol = protocol
        self._limits = limits
        self._queue = queue
        self._stem = f"{_file_name(device)}.{_file_name(protocol)}"
        # Of one instant for all files: the clock of the day may be set meanwhile, and times of a capture must not jump.
        self._epoch_ns = time.time_ns() - time.monotonic_ns()
        self._encoder: PacketEncoder | None = None
        self._file: BinaryIO | None = None
        self._size = self._noted = self._reported = 0

    def work(self) -> None:
        """Write until the queue is closed, or until the disk fails."""
        try:
            while not self._queue.closing.wait(_WRITE_S):
                self._write_all()
            self._write_all()
            self._end_file()
        except OSError as error:
            _log.warning(
                "the capture of %s (%s) ends: %s; the device is not affected",
                self._device,
                self._protocol,
                error.strerror or error,
            )
        finally:
            self._queue.has_ended = True
            self._queue.events.clear()
            if self._file is not None:
                with suppress(OSError):  # the disk takes no more
                    self._file.close()

    def _write_all(self) -> None:
        events = self._queue.events
        while events:
            event = events.popleft()
            self._noted += 1
            if self._noted % _SLICE_EVENTS == 0:
                self._queue.closing.wait(_PAUSE_S)
            if self._file is None or self._size >= self._limits.file_bytes:
                self._begin_file(event)
            assert self._encoder is not None
            for packet in self._encoder.packets(event, time_ns=self._epoch_ns + event.time_ns):
                self._write(encode_block(packet))
        if self._queue.dropped > self._reported:
            count, self._reported = self._queue.dropped - self._reported, self._queue.dropped
            _log.warning("the disk is too slow for the capture of %s: %d events are missing", self._device, count)
        if self._file is not None:
            self._file.flush()

    def _begin_file(self, event: WireEvent) -> None:
        self._end_file()
        if self._encoder is None:
            opens = event.kind == "opened"
            self._encoder = PacketEncoder("serial" if event.endpoints is None else "tcp" if opens else "udp")
        self._delete_oldest()
        self._file = self._new_file()
        self._size = 0
        comment = f"times are those of the monotonic clock, which was 0 at {self._epoch_ns} ns since 1970"
        self._write(encode_block(CaptureSection(comment=comment, application="flexcell")))
        self._write(
            encode_block(
                CaptureInterface(link_type=self._encoder.link_type, device=self._device, protocol=self._protocol)
            )
        )

    def _new_file(self) -> BinaryIO:
        now = datetime.now(UTC).strftime("%Y%m%dT%H%M%S.%fZ").replace(".", "")
        return (self._folder / f"{self._stem}.{now}.pcapng").open("xb")

    def _delete_oldest(self) -> None:
        kept = self._limits.files - 1
        files = sorted(self._folder.glob(f"{self._stem}.*.pcapng"))
        for old in files[: max(0, len(files) - kept)]:
            old.unlink(missing_ok=True)

    def _end_file(self) -> None:
        if self._file is not None:
            now_ns = self._epoch_ns + time.monotonic_ns()
            statistics = CaptureStatistics(time_ns=now_ns, received=self._noted, dropped=self._queue.dropped)
            self._write(encode_block(statistics))
            self._file.close()
            self._file = None

    def _write(self, data: bytes) -> None:
        assert self._file is not None
        self._file.write(data)
        self._size += len(data)


def _file_name(name: str) -> str:
    """Return a name for files, which no other name has: `left-gripper` of `left/gripper`."""
    return re.sub(r"\W", lambda found: "-" if found[0] == "/" else f"%{ord(found[0]):02X}", name)
