"""The recordings of a session's runs: one file per run; the oldest are removed beyond a number or total size."""

from __future__ import annotations

import asyncio
import fcntl
import logging
import os
import re
from collections.abc import Callable, Generator, Iterable
from contextlib import suppress
from pathlib import Path

from engine.bus import SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.behavior import Behavior
from engine.errors import RecordingError
from engine.host.private_files import make_private_folder
from engine.project.run_recorder import RunStartRecord
from engine.recording import RecordedDocuments, RecordingOptions, RunRecording, collect_documents, part_file
from engine.recording.finalization import PART, finalize_recording
from engine.recording.finalization_process import finalize_in_subprocess
from engine.runtime.run import Run

RECORDINGS = "recordings"
"""Subfolder of the journal's folder."""
RATE_HZ = 20.0
KEPT = 100
SIZE_MB = 2000.0
_SUFFIX = ".mcap"
_CLOSING_S = 5.0
_ID = re.compile(r"[A-Za-z0-9_.-]{1,120}")
# A depth image is as large as all other messages of a second, and is produced only for viewers.
_LEFT_OUT = ("*/depth", "cell/observed_space")
_OVERHEARD = ("cell/occupancy",)

_log = logging.getLogger("flexcell.recording")


class SessionRecordings:
    """Records runs in one folder, which is created on demand.

    Args:
        folder: Folder of the files `<run id>.mcap`.
        kept: Maximum number of recordings.
        size_mb: Maximum total size, in 10^6 bytes; one recording takes at most half of it.
    """

    def __init__(self, folder: Path, *, kept: int = KEPT, size_mb: float = SIZE_MB) -> None:
        self.folder = folder
        self._kept = kept
        self._bytes = round(size_mb * 1e6)
        self._finishing: set[asyncio.Task[None]] = set()
        self._used: set[Path] = set()

    def files(self, run_id: str) -> tuple[Path, ...]:
        """Return the recordings of a run, oldest first, also while it is recorded; more than one if it was resumed."""
        pieces = self._pieces(run_id)
        return tuple(pieces[number] for number in sorted(pieces))

    async def prepare(self, behavior: Behavior, *, cell: OpenCell) -> RecordedDocuments | None:
        """Make room for a recording and read its documents, before its run starts; None if that fails."""
        try:
            return await asyncio.to_thread(self._prepare, behavior, cell)
        except (RecordingError, OSError) as error:
            _log.warning("a run of %s is not recorded: %s", behavior.file, error)
            return None

    def record(self, run: Run, bus: SkillBus, start: RunStartRecord) -> Callable[[], None]:
        """Record a run until the returned function is called; recording errors are logged as warnings."""
        virtual = bus.clock.virtual
        try:
            recording, path = self._open(run.id, start.documents, virtual=virtual)
            recording.attach(
                run, bus, started_unix_s=start.started_unix_s, inputs=start.inputs, supervision=start.supervision
            )
        except (RecordingError, OSError, TypeError, ValueError) as error:
            _log.warning("run %s is not recorded: %s", run.id, error)
            return lambda: None

        def end() -> None:
            recording.detach()
            finishing = asyncio.create_task(
                self._finish(recording, path, virtual=virtual), name=f"recording of {run.id}"
            )
            self._finishing.add(finishing)
            finishing.add_done_callback(self._finishing.discard)

        return end

    async def finished(self) -> None:
        """Wait until all recordings are finalized."""
        while self._finishing:
            await asyncio.wait(self._finishing)

    async def close(self) -> None:
        """Wait briefly for recordings in finalization; the others keep their live file, which is equally complete."""
        if self._finishing:
            _, late = await asyncio.wait(self._finishing, timeout=_CLOSING_S)
            for task in late:
                task.cancel()
            if late:
                await asyncio.wait(late)

    def _pieces(self, run_id: str) -> dict[int, Path]:
        if not _ID.fullmatch(run_id):
            return {}
        name = re.compile(rf"{re.escape(run_id)}(?:~(\d+))?{re.escape(_SUFFIX)}(?:{re.escape(PART)})?")
        pieces: dict[int, Path] = {}
        # The finished file sorts first, and replaces its `.part` while that still exists.
        for file in sorted(self.folder.glob(f"{run_id}*")):
            named = name.fullmatch(file.name)
            if named is not None:
                pieces.setdefault(int(named[1] or 1), file)
        return pieces

    def _prepare(self, behavior: Behavior, cell: OpenCell) -> RecordedDocuments:
        make_private_folder(self.folder)
        self._remove_oldest(room=1)
        return collect_documents(behavior, cell.document)

    def _open(self, run_id: str, documents: RecordedDocuments, *, virtual: bool) -> tuple[RunRecording, Path]:
        # A resumed run has a recording already.
        number = max(self._pieces(run_id), default=0) + 1
        path = self.folder / f"{run_id}{'' if number == 1 else f'~{number}'}{_SUFFIX}"
        order = RecordingOptions(
            path=path,
            documents=documents,
            rate_hz=RATE_HZ,
            left_out=_LEFT_OUT,
            passive_topics=_OVERHEARD,
            max_topic_bytes=self._bytes // 2,
        )
        recording = RunRecording.open(order, inline=virtual)
        self._used.add(part_file(path))
        return recording, path

    async def _finish(self, recording: RunRecording, path: Path, *, virtual: bool) -> None:
        try:
            await asyncio.to_thread(recording.close)
            if virtual:
                await asyncio.to_thread(finalize_recording, part_file(path), path)
            else:
                await finalize_in_subprocess(part_file(path), path)
            await asyncio.to_thread(self._remove_oldest)
        except (RecordingError, OSError) as error:
            _log.warning("%s", error)
        finally:
            self._used.discard(part_file(path))

    def _remove_oldest(self, *, room: int = 0) -> None:
        """Remove recordings, oldest first, until `room` more are allowed; never one that is being written or read."""
        listed = [path for path in self.folder.iterdir() if path.name.endswith((_SUFFIX, _SUFFIX + PART))]
        states = sorted(_present(listed), key=lambda each: each[0].st_mtime_ns)
        number, size = len(states), sum(state.st_size for state, _ in states)
        for state, path in states:
            if number + room <= self._kept and size <= self._bytes:
                return
            if path not in self._used and _removed(path):
                number, size = number - 1, size - state.st_size


def _present(paths: Iterable[Path]) -> Generator[tuple[os.stat_result, Path]]:
    for path in paths:
        # A recording that was finalized in the meantime has another name now.
        with suppress(FileNotFoundError):
            yield path.stat(), path


def _removed(path: Path) -> bool:
    try:
        with path.open("rb") as stream:
            # Its writer or reader holds a lock.
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
            path.unlink()
    except OSError:
        return False
    return True
