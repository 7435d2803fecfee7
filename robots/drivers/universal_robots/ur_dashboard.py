"""The dashboard of a controller, on connections of its own: the second path to stop, and the cause of a stop."""

from __future__ import annotations

import time
from contextlib import closing

from robots.io.wire.tcp_connection import TcpConnection
from robots.io.wire.wire_tap import NO_TAP, WireTap

DASHBOARD_PORT = 29999
_LONGEST_LINE = 4096


def ask_dashboard(host: str, command: str, *, limit_s: float, port: int = DASHBOARD_PORT, tap: WireTap = NO_TAP) -> str:
    """Return the answer to a command, empty where there is none within the limit."""
    end_s = time.monotonic() + limit_s
    try:
        with closing(TcpConnection((host, port), timeout_s=limit_s, tap=tap)) as connection:
            _, rest = _line(connection, b"", end_s)
            connection.send(f"{command}\n".encode())
            return _line(connection, rest, end_s)[0].decode("utf-8", "replace").strip()
    except OSError:
        return ""


def _line(connection: TcpConnection, received: bytes, end_s: float) -> tuple[bytes, bytes]:
    """Return the next line, and what was received beyond it; what has no end is a line too."""
    while b"\n" not in received and len(received) < _LONGEST_LINE:
        left_s = end_s - time.monotonic()
        if left_s <= 0.0:
            raise TimeoutError
        connection.set_timeout(left_s)
        packet = connection.receive(_LONGEST_LINE)
        if not packet:
            break
        received += packet
    line, _, rest = received.partition(b"\n")
    return line, rest
