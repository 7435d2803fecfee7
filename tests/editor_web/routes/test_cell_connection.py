"""Whether the cell is connected, and connecting it again, over HTTP and from the command line."""

from __future__ import annotations

import asyncio
from pathlib import Path

import msgspec
import pytest
from typer.testing import CliRunner

from engine.bus.remote_bus import ServerRecord
from engine.cli.main import app
from engine.host.state_folder_names import SERVER_FILE
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_behaviors import SINGLE

WHY = "the world's process was ended by SIGKILL"


def lost() -> FakeBackend:
    """Return a backend whose world is lost."""
    backend = FakeBackend()
    backend.lost_reason = WHY
    return backend


async def test_a_lost_cell_is_reported_and_connected_again(serve: Serve) -> None:
    async with serve(lost()) as served:
        before = (await served.http.get("/api/v1/cell/connection")).json()
        session = (await served.http.get("/api/v1/session")).json()
        answer = await served.http.post("/api/v1/cell/connect", json={})
        after = (await served.http.get("/api/v1/cell/connection")).json()
    assert before == session["cell"] == {"connected": False, "reason": WHY}
    assert (answer.status_code, after) == (204, {"connected": True, "reason": ""})


async def test_a_cell_in_use_is_not_connected_and_says_why(serve: Serve) -> None:
    backend = lost()
    async with serve(backend) as served:
        await backend.start(SINGLE.id, parameters={"part": "hca_north"}, seed=1)
        answer = await served.http.post("/api/v1/cell/connect", json={})
    assert (answer.status_code, answer.json()["message"]) == (409, "a run is active")


async def test_only_an_operator_connects(serve: Serve) -> None:
    backend = lost()
    async with serve(backend) as served:
        headers = {"Authorization": f"Bearer {served.access.viewer}"}
        answer = await served.http.post("/api/v1/cell/connect", json={}, headers=headers)
    assert (answer.status_code, backend.lost_reason) == (403, WHY)


async def test_the_command_line_tells_and_connects(serve: Serve, tmp_path: Path) -> None:
    async with serve(lost()) as served:
        record = ServerRecord(url=served.running.url, token=served.access.operator, pid=0)
        (tmp_path / SERVER_FILE).write_bytes(msgspec.json.encode(record))
        said = [
            await asyncio.to_thread(CliRunner().invoke, app, ["cell", command, "--server", str(tmp_path)])
            for command in ("status", "connect", "status")
        ]
    assert [(each.exit_code, each.stdout) for each in said] == [(1, "lost\n"), (0, "connected\n"), (0, "connected\n")]
    assert said[0].stderr == f"{WHY}\n"


def test_without_a_server_the_command_line_says_how_to_start_one(tmp_path: Path) -> None:
    with pytest.raises(Exception, match="no server runs here"):
        CliRunner().invoke(app, ["cell", "connect", "--server", str(tmp_path)], catch_exceptions=False)
