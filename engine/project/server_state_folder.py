"""The state folder of a server: created, checked and locked, so that only one server at a time uses it."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import msgspec

from engine.bus.remote_bus import ServerRecord, server_file
from engine.errors import BusError, FlexcellError
from engine.host.private_files import make_private_folder, open_private
from engine.journal import Journal
from engine.stop import StopEndpoint

LOCK_FILE = "lock"


class ServerStateFolder:
    """A locked state folder, in which the server announces its address."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def open_journal(self) -> Journal:
        """Open the journal of the server's runs; raises JournalError if that is not possible."""
        return Journal.open(self.path)

    def announce(self, *, url: str, token: str, stop: StopEndpoint | None = None) -> None:
        """Write the addresses of the server and of STOP, readable by the owner only."""
        record = ServerRecord(
            url=url,
            token=token,
            pid=os.getpid(),
            stop_url=stop.url if stop is not None else "",
            stop_token=stop.token if stop is not None else "",
        )
        file = server_file(self.path)
        part = file.with_suffix(".part")
        with open_private(part) as stream:
            stream.write(msgspec.json.encode(record))
        part.replace(file)


@contextmanager
def lock_server_state_folder(path: Path) -> Generator[ServerStateFolder]:
    """Lock a state folder for one server; the lock ends with the process, however it ends.

    Raises:
        FlexcellError: the folder cannot be written, or another server has locked it.
    """
    with _locked(path):
        folder = ServerStateFolder(path)
        # The address file of a killed server is outdated.
        server_file(path).unlink(missing_ok=True)
        try:
            yield folder
        finally:
            server_file(path).unlink(missing_ok=True)


@contextmanager
def _locked(path: Path) -> Generator[None]:
    file = path / LOCK_FILE
    try:
        make_private_folder(path)
        descriptor = os.open(file, os.O_RDWR | os.O_CREAT, 0o600)
    except OSError as error:
        raise FlexcellError(
            f"the state folder cannot be written: {error.strerror}",
            where=path,
            hint="make it writable for this user, or give another folder with --state",
        ) from error
    try:
        _take(descriptor, path)
        yield
    finally:
        # Closing the file releases the lock; the file stays, because removing it could separate two waiting servers.
        os.close(descriptor)


def _take(descriptor: int, path: Path) -> None:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError as error:
        raise FlexcellError(
            f"another server uses this state folder: {_holder(descriptor, path)}",
            where=path,
            hint="stop it, or give another folder with --state",
        ) from error
    try:
        os.ftruncate(descriptor, 0)
        os.pwrite(descriptor, str(os.getpid()).encode(), 0)
    except OSError as error:
        raise FlexcellError(
            f"the state folder cannot be written: {error.strerror}", where=path, hint="free disk space"
        ) from error


def _holder(descriptor: int, path: Path) -> str:
    pid = os.pread(descriptor, 20, 0).decode("ascii", "replace") or "unknown"
    try:
        return f"process {pid} at {ServerRecord.read(path).url}"
    except BusError:
        return f"process {pid}, which is starting or stopping"
