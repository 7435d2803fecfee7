"""Finishes a recording in a process of its own: compressing it would take the interpreter from the engine."""

from __future__ import annotations

import asyncio
import os
import sys
from asyncio.subprocess import DEVNULL, PIPE
from pathlib import Path

from engine.errors import RecordingError

_ROOT = str(Path(__file__).resolve().parents[2])
_CODE = """
import os, sys
from pathlib import Path
os.nice(10)
from engine.errors import RecordingError
from engine.recording.finalization import finalize_recording
try:
    finalize_recording(Path(sys.argv[1]), Path(sys.argv[2]))
except RecordingError as error:
    sys.exit(error.message)
"""


async def finalize_in_subprocess(part: Path, target: Path) -> None:
    """Do what `finalize_recording` does, at low priority; cancelled, it leaves the growing file as it is.

    Raises:
        RecordingError: it cannot be finished.
    """
    # The process must import this very package, wherever this one found it.
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([_ROOT, *(path for path in sys.path if path)])}
    try:
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-P", "-c", _CODE, str(part), str(target),
            env=environment, stdin=DEVNULL, stdout=DEVNULL, stderr=PIPE, start_new_session=True,
        )  # fmt: skip
    except OSError as error:
        raise RecordingError(f"the recording cannot be finished: {error}", where=part) from error
    try:
        _, said = await process.communicate()
    except asyncio.CancelledError:
        process.kill()
        await process.wait()
        raise
    if process.returncode:
        last = said.decode(errors="replace").strip().splitlines()[-1:]
        reason = last[0] if last else f"exit code {process.returncode}"
        raise RecordingError(reason, where=target, hint=f"it is whole in {part.name}")
