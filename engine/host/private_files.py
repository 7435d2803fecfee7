"""Files and folders that only their owner may read: journals, stores, recordings, tokens, what was taught.

What a file says of a cell and of the people in it is nobody else's. A file is made with mode 0600 and a folder with
0700; a wider one of the same owner is made narrower. A folder that exists is left as it is unless it is a state
folder of ours: somebody may have given one that is shared on purpose.
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
    """Make a folder and those above it that are missing, for the owner alone.

    Raises:
        OSError: it cannot be made.
    """
    missing = [folder, *folder.parents]
    for each in reversed(missing[: next((n for n, each in enumerate(missing) if each.exists()), len(missing))]):
        each.mkdir(mode=_FOLDER, exist_ok=True)
    if not folder.is_dir():
        folder.mkdir(exist_ok=True)  # says what is there instead
    if folder.name == STATE_FOLDER or folder.parent.name == STATE_FOLDER:
        restrict_to_owner(folder if folder.name == STATE_FOLDER else folder.parent)


def new_private_file(path: Path) -> None:
    """Make an empty file for the owner alone, or make one that is there private.

    Raises:
        OSError: it cannot be made.
    """
    # What is there is not opened: closing it would take SQLite's locks from all connections of this process.
    with suppress(FileExistsError):
        os.close(os.open(path, os.O_RDONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, _FILE))
    restrict_to_owner(path)


def open_private(path: Path) -> BinaryIO:
    """Open a file for writing from its start, for the owner alone.

    Raises:
        OSError: it cannot be opened.
    """
    stream = os.fdopen(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_CLOEXEC, _FILE), "wb")
    restrict_to_owner(path)
    return stream


def restrict_to_owner(path: Path) -> None:
    """Take a file or folder from everybody but its owner; of another owner or kind it is left as it is."""
    try:
        status = path.stat()
        plain = stat.S_ISREG(status.st_mode) or stat.S_ISDIR(status.st_mode)
        if plain and status.st_uid == os.geteuid() and status.st_mode & 0o077:
            path.chmod(status.st_mode & 0o700)
    except OSError as error:
        # A file system without modes: whoever mounts it decides who may read it.
        _log.info("%s keeps its mode: %s", path, error)
