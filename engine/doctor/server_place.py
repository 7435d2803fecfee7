"""What a server needs of the place where it is started: folders that can be written, space, a free port."""

from __future__ import annotations

import shutil
import socket
import tempfile
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

from engine.bus.remote_bus import ServerRecord
from engine.doctor.examination import Condition, Examination
from engine.errors import BusError, FlexcellError
from engine.host.loopback import bound_socket

_GROUP = "place"
_LEAST_GB = 1.0
_ANSWER_S = 2.0


def server_place(state: Path, *, cache: Path, host: str, port: int) -> Iterator[Examination]:
    """Yield how the place is.

    Args:
        state: Folder of the server's state; it need not exist.
        cache: Folder of what takes long to compute; it need not exist.
        host: Loopback address of the server.
        port: Port of the dashboard.
    """
    yield _writable("state folder", state, "problem", f"give another one: `flexcell serve --state FOLDER`, not {state}")
    yield _writable("cache folder", cache, "note", "set XDG_CACHE_HOME to a folder that can be written")
    free_gb = shutil.disk_usage(_existing(state)).free / 1e9
    low = free_gb < _LEAST_GB
    yield Examination(
        group=_GROUP,
        subject="disk",
        condition="note" if low else "ok",
        state=f"{free_gb:.1f} GB free at {_existing(state).resolve()}",
        advice="make room: journal and recordings grow with each run" if low else "",
    )
    yield _port(state, host=host, port=port)


def _writable(subject: str, folder: Path, otherwise: Condition, advice: str) -> Examination:
    there = _existing(folder)
    try:
        if folder.exists() and not folder.is_dir():
            raise NotADirectoryError(20, "is no folder", str(folder))
        with tempfile.TemporaryFile(dir=there):
            pass
    except OSError as error:
        state = f"{folder} cannot be written: {error.strerror}"
        return Examination(group=_GROUP, subject=subject, condition=otherwise, state=state, advice=advice)
    made = "" if folder.exists() else ", made by the first use"
    return Examination(group=_GROUP, subject=subject, condition="ok", state=f"{folder}{made}")


def _existing(folder: Path) -> Path:
    """Return the folder, or the nearest one above that exists."""
    return next((each for each in (folder, *folder.absolute().parents) if each.is_dir()), Path())


def _port(state: Path, *, host: str, port: int) -> Examination:
    try:
        record = ServerRecord.read(state)
    except BusError:
        record = None
    if record is not None and _answers(record.url):
        return Examination(group=_GROUP, subject="server", condition="ok", state=f"runs at {record.url}")
    try:
        bound_socket(host, port, option="--port").close()
    except FlexcellError as error:
        return Examination(
            group=_GROUP, subject="server", condition="note", state=str(error.statement), advice=error.hint or ""
        )
    return Examination(group=_GROUP, subject="server", condition="ok", state=f"none runs here; port {port} is free")


def _answers(url: str) -> bool:
    address = urlsplit(url)
    try:
        with socket.create_connection((address.hostname, address.port or 80), timeout=_ANSWER_S):
            return True
    except OSError:
        return False
