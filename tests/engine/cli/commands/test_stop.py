"""`flexcell stop`: the command finds the relay of a running server, and says how far the stop is."""

from __future__ import annotations

import asyncio
import socket
import subprocess
import sys
from collections.abc import Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import msgspec
import pytest

from engine.bus.remote_bus import ServerRecord
from engine.cli.commands.stop import release_stop, stop_cell
from engine.host.state_folder_names import SERVER_FILE
from engine.stop import StopEndpoint, StopRelay
from tests.engine.cli.command import flexcell
from tests.engine.stop.device import device, endpoint_of


def record(folder: Path, endpoint: StopEndpoint) -> None:
    """Write what a server leaves in its state folder; the server itself answers nobody."""
    written = ServerRecord(
        url="http://127.0.0.1:9/", token="none", pid=0, stop_url=endpoint.url, stop_token=endpoint.token
    )
    (folder / SERVER_FILE).write_bytes(msgspec.json.encode(written))


@contextmanager
def answering(data: bytes) -> Generator[str]:
    """Answer the first connection with these bytes, after its request, and close; gives the address as a URL."""

    def answer() -> None:
        connection, _ = listener.accept()
        with connection:
            request = b""
            while b"}" not in request:
                request += connection.recv(4096)
            connection.sendall(data)

    with socket.create_server(("127.0.0.1", 0)) as listener, ThreadPoolExecutor(1) as threads:
        answered = threads.submit(answer)
        yield f"http://127.0.0.1:{listener.getsockname()[1]}"
        answered.result(timeout=10.0)


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
        "unwanted = {'asyncio', 'http.client', 'msgspec', 'rich', 'ssl', 'typer'}\n"
        "import sys; sys.argv = ['flexcell', 'stop', '--state', '/nowhere']\n"
        "from engine.cli.entry import main\n"
        "try: main()\n"
        "except SystemExit: print(sorted(unwanted & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


NO_ANSWERS = (
    b"",
    b"\xff\x00 garbage",
    b"HTTP/1.1 200 OK\r\n\r\n[",
    b"HTTP/1.1 200 OK\r\n\r\n[1]",
    b"HTTP/1.1 200 OK\r\n\r\n{}",
    b"HTTP/1.1 401 No\r\n\r\n{}",
)


@pytest.mark.parametrize("answer", NO_ANSWERS)
def test_whatever_answers_in_place_of_the_relay_the_server_is_asked(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], answer: bytes
) -> None:
    with answering(answer) as relay, answering(b"HTTP/1.1 204 No Content\r\nx-served: 1\r\n\r\n") as server:
        written = ServerRecord(url=f"{server}/", token="t", pid=0, stop_url=f"{relay}/stop", stop_token="t")
        (tmp_path / SERVER_FILE).write_bytes(msgspec.json.encode(written))
        assert stop_cell(tmp_path, "tea") == 0
    said = capsys.readouterr()
    assert "the stop relay does not answer" in said.err
    assert said.out == "Stopped: the server confirms that every robot is at rest.\n"


@pytest.mark.parametrize(
    ("answer", "code"),
    [
        (b"HTTP/1.1 204 No Content\r\nx-served: 1\r\n\r\n", 0),
        (b'HTTP/1.1 409 Conflict\r\n\r\n{"message": "left has not confirmed that it is at rest"}', 3),
    ],
)
def test_a_stop_is_released_by_the_server_or_it_says_why_not(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], answer: bytes, code: int
) -> None:
    with answering(answer) as server:
        written = ServerRecord(url=f"{server}/", token="t", pid=0, stop_url="", stop_token="")
        (tmp_path / SERVER_FILE).write_bytes(msgspec.json.encode(written))
        assert release_stop(tmp_path) == code
    said = capsys.readouterr()
    assert ("runs may start" in said.out, "left has not confirmed" in said.err) == (code == 0, code == 3)
