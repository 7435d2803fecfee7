"""The option `--capture`, which all commands that connect to real devices have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from engine.errors import FlexcellError

Capture = Annotated[
    Path | None,
    typer.Option(
        help="Folder to which every byte between drivers and real devices is captured, for Wireshark and for"
        " `flexcell emulate replay`.",
        file_okay=False,
    ),
]


def capture_folder(folder: Path | None) -> Path | None:
    """Return the folder, which exists then; raises FlexcellError where it cannot be made."""
    if folder is not None:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise FlexcellError(f"cannot be made: {error.strerror or error}", where=f"--capture {folder}") from error
    return folder
