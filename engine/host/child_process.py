"""Processes of our own beside this one: how they are started, and how they ended, in words."""

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


def set_parent_death_signal(connection: socket.socket) -> None:
    """Let the system kill this process when its parent ends; in the child, for one that holds nothing to be lost.

    Without it a child in the midst of a long computation lives on until it looks at its socket. The system means the
    thread that has started the child, which must therefore live as long as the child is needed.
    """
    _libc.prctl(_PR_SET_PDEATHSIG, int(signal.SIGKILL), 0, 0, 0)
    # The parent may have ended before that: then its socket has.
    readable, _, _ = select.select([connection], [], [], 0.0)
    try:
        if readable and not connection.recv(1, socket.MSG_PEEK):
            sys.exit(0)
    except ConnectionError:
        sys.exit(0)


def describe_exit(process: subprocess.Popen[bytes] | None, *, what: str) -> str:
    """Say why a process is gone, once its socket has closed; None stands for one that was ended from here."""
    if process is None:
        return f"{what} was ended"
    try:
        code = process.wait(timeout=1.0)
    except subprocess.TimeoutExpired:
        return f"{what} closed its connection"
    return f"{what} {'was ended' if code < 0 else 'ended'} {exit_code_text(code)}"


def exit_code_text(code: int) -> str:
    """Return how a process ended, as `by SIGKILL` or `with exit code 1`, from its return code."""
    return f"by {signal.Signals(-code).name}" if code < 0 else f"with exit code {code}"
