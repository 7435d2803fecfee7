"""Output files of commands: checked for writability before the work, written after it."""

from __future__ import annotations

import os
from pathlib import Path

from engine.errors import FlexcellError


def prepare(*paths: Path | None) -> None:
    """Create the folders of output files and verify that the files can be written; None is no file.

    Raises:
        FlexcellError: a file cannot be written.
    """
    for path in paths:
        if path is None:
            continue
        if path.is_dir():
            raise FlexcellError("the output path is a folder", where=path, hint="give the path of a file")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise _cannot_be_written(path, error) from error
        if not os.access(path if path.exists() else path.parent, os.W_OK):
            hint = "give another path, or grant write permission"
            raise FlexcellError("this file cannot be written: permission denied", where=path, hint=hint)


def write(path: Path, data: bytes) -> None:
    """Write an output file.

    Raises:
        FlexcellError: the file cannot be written.
    """
    try:
        path.write_bytes(data)
    except OSError as error:
        raise _cannot_be_written(path, error) from error


def _cannot_be_written(path: Path, error: OSError) -> FlexcellError:
    reason = error.strerror or str(error)
    return FlexcellError(f"this file cannot be written: {reason}", where=path, hint="give another path")
