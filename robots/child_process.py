"""Processes of our own beside this one: how they are started, and how they ended, in words."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from engine.errors import RobotError

_ROOT = str(Path(__file__).resolve().parents[1])


def start_child(
    code: str, descriptors: Sequence[int], *, what: str, settings: Mapping[str, str] | None = None
) -> subprocess.Popen[bytes]:
    """Start Python on `code` with these open descriptors, whose numbers are its arguments.

    `what` is the process in words; `settings` are more environment variables.

    Raises:
        RobotError: it does not start.
    """
    environment = {
        **os.environ,
        # The process must import this very package, wherever this one found it.
        "PYTHONPATH": os.pathsep.join([_ROOT, *(path for path in sys.path if path)]),
        # A thread pool for 7 x 7 matrices only takes time from the others.
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
        **(settings or {}),
    }
    command = [sys.executable, "-P", "-c", code, *(str(descriptor) for descriptor in descriptors)]
    try:
        return subprocess.Popen(command, pass_fds=tuple(descriptors), env=environment, stdin=subprocess.DEVNULL)
    except OSError as error:
        raise RobotError(f"{what} does not start: {error}", where=sys.executable) from error


def how_it_ended(process: subprocess.Popen[bytes] | None, *, what: str) -> str:
    """Say why a process is gone, once its socket has closed; None stands for one that was ended from here."""
    if process is None:
        return f"{what} was ended"
    try:
        code = process.wait(timeout=1.0)
    except subprocess.TimeoutExpired:
        return f"{what} closed its connection"
    if code < 0:
        return f"{what} was ended by {signal.Signals(-code).name}"
    return f"{what} ended with exit code {code}"
