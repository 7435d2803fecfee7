"""The log of a control process: lines on stderr that never block its control loop."""

from __future__ import annotations

import os
import select

_STDERR = 2
_LONGEST_BYTES = select.PIPE_BUF


def log_nonblocking(line: str, *, of: str = "world") -> None:
    """Write a line to stderr, or drop it if the reader does not keep up."""
    _, writable, _ = select.select([], [_STDERR], [], 0.0)
    if writable:
        # A pipe that is writable takes this much without waiting.
        os.write(_STDERR, f"flexcell {of}: {line}\n".encode()[:_LONGEST_BYTES])
