"""Files and folders that only their owner may read: journals, stores, recordings, tokens, taught entries.

Data of a cell and of the people in it is private. Files are created with mode 0600 and folders with 0700; a wider
mode of the same owner is narrowed. An existing folder is not changed unless it is a state folder of flexcell: the
user may share a folder on purpose.
"""

from __future__ import annotations

import logging
import os
import stat
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO

from engine.host.state_folder_names import STATE_FOLDER

_FILE, _FOLDER = 0o600, 0o700

_log = logging.getLogger("flexcell.files")


def make_private_folder(folder: Path) -> None:
    """Create a folder and its missing parents, for the owner only.

    Raises:
        OSError: a folder cannot be created.
    """
    missing = [folder, *folder.parents]
    for each in reversed(missing[: next((n for n, each in enumerate(missing) if each.exists()), len(missing))]):
        each.mkdir(mode=_FOLDER, exist_ok=True)
    if not folder.is_dir():
        folder.mkdir(exist_ok=True)  # raises the error for an existing file
    if STATE_FOLDER in (folder.name, folder.parent.name):
        restrict_to_owner(folder if folder.name == STATE_FOLDER else folder.parent)


def new_private_file(path: Path) -> None:
    """Create an empty file for the owner only, or make an existing one private.

    Raises:
        OSError: the file cannot be created.
    """
    # An existing file is not opened: closing it would release SQLite's locks of all connections of this process.
    with suppress(FileExistsError):
        os.close(os.open(path, os.O_RDONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, _FILE))
    restrict_to_owner(path)


def open_private(path: Path) -> BinaryIO:
    """Create or truncate a file and open it for writing, for the owner only.

    Raises:
        OSError: the file cannot be opened.
    """
    stream = os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, _FILE), "wb")
    restrict_to_owner(path)
    return stream


def restrict_to_owner(path: Path) -> None:
    """Remove the access of group and others to a file or folder; one of another owner or kind is not changed."""
    try:
        status = path.stat()
        plain = stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode)
        if plain and status.st_uid == os.geteuid() and status.st_mode & 0o077:
            path.chmod(status.st_mode & 0o700)
    except OSError as error:
        # A file system without modes: its mount options decide who may read it.
        _log.info("%s keeps its mode: %s", path, error)
