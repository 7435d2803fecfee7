"""`flexcell serve` and `flexcell login`: who may serve, how one gets in, and what a flood does."""

from __future__ import annotations

import resource
import socket
from pathlib import Path

import httpx
import pytest

from engine.bus.remote_bus import ServerRecord
from engine.cli.commands.login import login
from engine.cli.commands.serve import serve
from engine.errors import BusError, FlexcellError
from tests.engine.cli.command import flexcell
from tests.engine.cli.process import started

LIMIT_S = 60.0
STATE = ".flexcell"


def enters(url: str) -> int:
    """Open a log-in link as a browser does, and return the status."""
    return httpx.get(url, trust_env=False, timeout=LIMIT_S).status_code


def test_one_server_keeps_the_folder_and_prints_links_that_log_in_once(tmp_path: Path) -> None:
    """A second one ends with 2 and leaves the first alone; `flexcell login` asks the first for more links."""
    with started("serve", "--port", "0", cwd=tmp_path) as server:
        assert server.stdout is not None
        printed = server.stdout.readline().removeprefix("Dashboard: ").strip()
        record = ServerRecord.read(tmp_path / STATE)
        assert record.token not in printed
        assert (enters(printed), enters(printed)) == (303, 401)
        second = flexcell("serve", "--port", "0", cwd=tmp_path)
        assert (second.code, f"process {server.pid} at {record.url}" in second.err) == (2, True)
        assert ServerRecord.read(tmp_path / STATE) == record
        made = flexcell("login", "--viewer", cwd=tmp_path)
        assert made.code == 0
        with httpx.Client(trust_env=False, timeout=LIMIT_S, headers={"Sec-Fetch-Site": "same-origin"}) as browser:
            assert browser.get(made.out.strip()).status_code == 303
            assert browser.get(f"{record.url}api/v1/session").json()["role"] == "viewer"


def test_logging_in_where_no_server_runs_says_so(tmp_path: Path) -> None:
    """And how to start one."""
    with pytest.raises(BusError, match=r"no server runs here.*flexcell serve"):
        login(state=tmp_path)


def test_a_state_folder_that_cannot_be_written_is_reported_at_the_start(tmp_path: Path) -> None:
    """Before anything is opened: path and what to do."""
    (tmp_path / "file").write_text("")
    with pytest.raises(FlexcellError, match=r"file/state: the state folder cannot be written: .*--state"):
        serve(state=tmp_path / "file" / "state")


def test_a_flood_of_connections_stops_no_stop_and_writes_no_log(tmp_path: Path) -> None:
    """With 64 descriptors and ten times as many connections: the stop is answered, the log is a few lines."""
    with started("serve", "--port", "0", cwd=tmp_path) as server:
        resource.prlimit(server.pid, resource.RLIMIT_NOFILE, (64, 64))
        assert server.stdout is not None
        server.stdout.readline()
        record = ServerRecord.read(tmp_path / STATE)
        port = int(record.url.rstrip("/").rsplit(":", 1)[1])
        flood = [socket.create_connection(("127.0.0.1", port), timeout=LIMIT_S) for _ in range(300)]
        answer = httpx.post(
            f"{record.url}api/v1/cell/stop",
            headers={"Authorization": f"Bearer {record.token}"},
            json={},
            trust_env=False,
            timeout=LIMIT_S,
        )
        assert answer.status_code == 204
        for wire in flood:
            wire.close()
        server.terminate()
        assert len(server.communicate(timeout=LIMIT_S)[1]) < 10_000
