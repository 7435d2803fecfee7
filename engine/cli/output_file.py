"""Files that a command writes at its end; what can be known to be wrong with them is said at its beginning."""

from __future__ import annotations

import os
from pathlib import Path

from engine.errors import FlexcellError


def prepare(*paths: Path | None) -> None:
    """Make the folders of files that are to be written, and require that they can be; None asks for no file.

    Raises:
        FlexcellError: one cannot be written.
    """
    for path in paths:
        if path is None:
            continue
        if path.is_dir():
            raise FlexcellError("this is a folder, and a file is to be written", where=path, hint="name a file in it")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise _cannot_be_written(path, error) from error
        if not os.access(path if path.exists() else path.parent, os.W_OK):
            hint = "give another place, or the right to write there"
            raise FlexcellError("this file cannot be written: permission denied", where=path, hint=hint)


def write(path: Path, data: bytes) -> None:
    """Write such a file.

    Raises:
        FlexcellError: it cannot be written.
    """
    try:
        path.write_bytes(data)
    except OSError as error:
        raise _cannot_be_written(path, error) from error


def _cannot_be_written(path: Path, error: OSError) -> FlexcellError:
    reason = error.strerror or str(error)
    return FlexcellError(f"this file cannot be written: {reason}", where=path, hint="give another place")
