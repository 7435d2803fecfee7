"""Finalizes a recording in a separate process: compression would block the interpreter of the engine."""

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
    """Run `finalize_recording` in a process at low priority; if cancelled, the live file is unchanged.

    Raises:
        RecordingError: the recording cannot be finalized.
    """
    # The process must import the same package as this process.
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([_ROOT, *(path for path in sys.path if path)])}
    try:
        process = await asyncio.create_subprocess_exec(
            sys.executable, "-P", "-c", _CODE, str(part), str(target),
            env=environment, stdin=DEVNULL, stdout=DEVNULL, stderr=PIPE, start_new_session=True,
        )  # fmt: skip
    except OSError as error:
        raise RecordingError(f"the recording cannot be finalized: {error}", where=part) from error
    try:
        _, stderr = await process.communicate()
    except asyncio.CancelledError:
        process.kill()
        await process.wait()
        raise
    if process.returncode:
        last = stderr.decode(errors="replace").strip().splitlines()[-1:]
        reason = last[0] if last else f"exit code {process.returncode}"
        raise RecordingError(reason, where=target, hint=f"{part.name} is complete")
