"""Sockets that listen on this machine only."""

from __future__ import annotations

import ipaddress
import socket

from engine.errors import FlexcellError

DASHBOARD_PORT = 8642
"""Where `flexcell serve` listens by default."""


def bound_socket(host: str, port: int, *, option: str) -> socket.socket:
    """Return a TCP socket bound to a loopback address, not yet listening; port 0 selects a free one.

    Args:
        host: A loopback address, or `localhost`.
        port: TCP port.
        option: The command-line option that chose the port, for the error.

    Raises:
        FlexcellError: the host is not loopback, or the port is taken.
    """
    if not _is_loopback(host):
        raise FlexcellError(
            "the dashboard listens on this machine only",
            where=host,
            hint="use 127.0.0.1; from another machine, an SSH tunnel for each port (--port, --view-port, --stop-port): "
            f"ssh -L {DASHBOARD_PORT}:127.0.0.1:{DASHBOARD_PORT} <machine>",
        )
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    bound = socket.socket(family, socket.SOCK_STREAM)
    try:
        bound.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        bound.bind((host, port))
    except OSError as error:
        bound.close()
        raise FlexcellError(
            f"cannot listen on {host}:{port}: {error.strerror or error}",
            where=option,
            hint=f"another server may be running: choose another {option}",
        ) from error
    return bound


def host_in_url(host: str) -> str:
    """Return a host as written in a URL, in lower case."""
    return f"[{host}]" if ":" in host else host.lower()


def _is_loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host.lower() == "localhost"
