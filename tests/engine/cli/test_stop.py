"""`flexcell stop`: the command finds the relay of a running server, and says how far the stop is."""

from __future__ import annotations

import asyncio
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from engine.bus.remote import ServerRecord
from engine.cli.stop import stop_cell
from engine.state_names import SERVER_FILE
from engine.stop import StopEndpoint, StopRelay
from tests.engine.cli.command import flexcell
from tests.engine.stop.device import device, endpoint_of


def record(folder: Path, endpoint: StopEndpoint) -> None:
    """Write what a server leaves in its state folder; the server itself answers nobody."""
    written = ServerRecord(
        url="http://127.0.0.1:9/", token="none", pid=0, stop_url=endpoint.url, stop_token=endpoint.token
    )
    (folder / SERVER_FILE).write_bytes(msgspec.json.encode(written))


async def test_it_says_when_everything_rests(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    async with StopRelay(host="127.0.0.1") as relay, device(relay) as arm:
        record(tmp_path, endpoint_of(relay))
        code = await asyncio.to_thread(stop_cell, tmp_path, "tea")
    told = capsys.readouterr().out.splitlines()
    assert (code, arm.stops) == (0, ["tea"])
    assert told[0].startswith("STOP acknowledged after ")
    assert told[1].startswith("At rest after ")


async def test_a_relay_and_a_server_that_do_not_answer_are_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    record(tmp_path, StopEndpoint(url="http://127.0.0.1:9/stop", token="none"))
    assert stop_cell(tmp_path, "tea") == 3
    assert "use the emergency stop" in capsys.readouterr().err


def test_without_a_server_it_says_where_it_looked(tmp_path: Path) -> None:
    said = flexcell("stop", "--state", tmp_path, cwd=tmp_path)
    assert (said.code, said.out) == (2, "")
    assert f"{tmp_path / SERVER_FILE}: no server runs here" in said.err


def test_its_help_is_that_of_every_command(tmp_path: Path) -> None:
    said = flexcell("stop", "--help", cwd=tmp_path)
    assert said.code == 0
    assert "Exit code 0: everything is at rest." in said.out


def test_the_plain_command_loads_nothing_that_it_does_not_need() -> None:
    code = (
        "import sys; sys.argv = ['flexcell', 'stop', '--state', '/nowhere']\n"
        "from engine.cli.entry import main\n"
        "try: main()\n"
        "except SystemExit: print(sorted({'asyncio', 'msgspec', 'typer', 'rich'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"
