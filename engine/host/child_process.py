"""Starts child processes and describes how they ended."""

from __future__ import annotations

import ctypes
import os
import select
import signal
import socket
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from engine.errors import RobotError

_PR_SET_PDEATHSIG = 1
_libc = ctypes.CDLL(None)
_ROOT = str(Path(__file__).resolve().parents[2])


def start_child(
    code: str, descriptors: Sequence[int], *, what: str, settings: Mapping[str, str] | None = None
) -> subprocess.Popen[bytes]:
    """Start Python on `code` with open file descriptors, whose numbers are its arguments.

    `what` names the process in messages; `settings` are additional environment variables.

    Raises:
        RobotError: the process does not start.
    """
    environment = {
        **os.environ,
        # The process must import the same package as this process.
        "PYTHONPATH": os.pathsep.join([_ROOT, *(path for path in sys.path if path)]),
        # A thread pool for 7 x 7 matrices only takes CPU time from other processes.
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
        **(settings or {}),
    }
    command = [sys.executable, "-P", "-c", code, *(str(descriptor) for descriptor in descriptors)]
    try:
        return subprocess.Popen(  # noqa: S603 - our own code
            command, pass_fds=tuple(descriptors), env=environment, stdin=subprocess.DEVNULL
        )
    except OSError as error:
        raise RobotError(f"{what} does not start: {error}", where=sys.executable) from error


def set_parent_death_signal(connection: socket.socket) -> None:
    """Have the system kill this process when its parent ends; called in a child that holds no data to be saved.

    Without it a child in a long computation runs until it next reads its socket. The parent is the thread that
    started the child, which must therefore live as long as the child is needed.
    """
    _libc.prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
    # The parent may have ended before this call: then its socket is closed.
    readable, _, _ = select.select([connection], [], [], 0.0)
    try:
        if readable and not connection.recv(1, socket.MSG_PEEK):
            sys.exit(0)
    except ConnectionError:
        sys.exit(0)


def describe_exit(process: subprocess.Popen[bytes] | None, *, what: str) -> str:
    """Return why a process has ended, once its socket is closed; None means that this process ended it."""
    if process is None:
        return f"{what} was ended"
    try:
        code = process.wait(timeout=1.0)
    except subprocess.TimeoutExpired:
        return f"{what} closed its connection"
    return f"{what} {'was ended' if code < 0 else 'ended'} {exit_code_text(code)}"


def exit_code_text(code: int) -> str:
    """Return `by SIGKILL` or `with exit code 1` for the return code of a process."""
    return f"by {signal.Signals(-code).name}" if code < 0 else f"with exit code {code}"
