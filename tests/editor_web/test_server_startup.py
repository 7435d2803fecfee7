"""The server starts while clients reconnect to it; more of it with `python -m benchmarks.server_startup`."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.server_startup import new_project, start_server_once


@pytest.mark.timeout(300)
def test_the_server_starts_under_clients_that_reconnect(tmp_path: Path, loopback: str) -> None:
    """Two starts, threads changing places every microsecond: it died by SIGSEGV each time before types were ready."""
    new_project(tmp_path)
    assert [start_server_once(tmp_path, clients=4, host=loopback) for _ in range(2)] == ["ok", "ok"]
