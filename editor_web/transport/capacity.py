"""Connection limit of the server from its file descriptors, whose limit is raised as far as the system allows."""

from __future__ import annotations

import logging
import resource
from pathlib import Path

MAX_CONNECTIONS = 512
COMMAND_RESERVE = 8
"""Number of connections reserved for an operator's commands."""
_MIN_CONNECTIONS = 16
_DESCRIPTORS = 65_536
# For files, child processes and databases that are opened while the server runs.
_SPARE_DESCRIPTORS = 12
_OPEN_DESCRIPTORS = Path("/proc/self/fd")
_log = logging.getLogger("flexcell.server")


def raise_descriptor_limit() -> None:
    """Raise the limit of open files of this process as far as the system allows."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    soft_limit = _DESCRIPTORS if hard == resource.RLIM_INFINITY else min(hard, _DESCRIPTORS)
    if soft != resource.RLIM_INFINITY and soft < soft_limit:
        resource.setrlimit(resource.RLIMIT_NOFILE, (soft_limit, hard))


def connection_limit() -> int:
    """Return the maximum number of connections, and log a warning if it is below `MAX_CONNECTIONS`."""
    soft, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft == resource.RLIM_INFINITY:
        return MAX_CONNECTIONS
    # A page's 3D view needs its own connection and both ends of the connection to viser.
    limit = max(_MIN_CONNECTIONS, min(MAX_CONNECTIONS, (soft - _open_descriptors() - _SPARE_DESCRIPTORS) // 2))
    if limit < MAX_CONNECTIONS:
        _log.warning("the limit of %d open files allows only %d connections; raise `ulimit -n`", soft, limit)
    return limit


def _open_descriptors() -> int:
    return sum(1 for _ in _OPEN_DESCRIPTORS.iterdir()) if _OPEN_DESCRIPTORS.is_dir() else 64
