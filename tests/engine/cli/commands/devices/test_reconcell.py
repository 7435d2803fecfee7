"""`flexcell reconcell serve` and `flexcell serve --reconcell`: datagrams move an arm in real time; the errors."""

from __future__ import annotations

import socket
import struct
import subprocess
from collections.abc import Callable
from pathlib import Path

import httpx

from engine.bus.remote_bus import ServerRecord
from robots.reconcell.reconcell_client import ReconcellClient
from tests.engine.awaited import wait_until
from tests.engine.cli.command import flexcell
from tests.engine.cli.process import started
from tests.robots.own_address import own_address

CELL = """\
flexcell: 1
cell: one_ur10
world: {kind: mujoco, step_s: 0.002}
robots:
  ur10: {model: ur10}
  panda: {model: panda, base: {xyz: [3, 0, 0]}}
"""
THERE = (0.1, -1.4, 1.5, -1.6, -1.5, 0.1)
LIMIT_S = 60.0


def cell(folder: Path) -> Path:
    (folder / "cell.yaml").write_text(CELL, encoding="utf-8")
    return folder / "cell.yaml"


def until(client: ReconcellClient, true: Callable[[], bool]) -> None:
    def holds() -> bool:
        client.receive(0.1)
        return true()

    wait_until(holds)


def first_line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline()


def test_a_program_moves_the_arm_and_ctrl_c_ends_the_server(tmp_path: Path) -> None:
    address = own_address()
    with (
        started(
            "reconcell", "serve", cell(tmp_path), "--robot", "ur10", "--address", address, "--receiver", address,
            cwd=tmp_path,
        ) as server,
        ReconcellClient(address, own=address) as client,
    ):  # fmt: skip
        assert f"ur10 of one_ur10 is served at {address}" in first_line(server)
        until(client, lambda: client.state is not None)
        client.move_joints(THERE, speed=0.5)
        until(client, lambda: client.flags is not None and client.flags.running == 1)
        until(client, lambda: client.flags is not None and client.flags.finished == 1)
        state = client.state
        assert state is not None
        assert max(abs(a - b) for a, b in zip(state.joints, THERE, strict=True)) < 0.02
        server.send_signal(2)
        assert server.wait(LIMIT_S) == 130


def test_after_a_stop_of_the_cell_no_datagram_moves_the_arm_before_the_release(tmp_path: Path) -> None:
    """Beside a dashboard; the state is sent to 127.0.0.1, so that this test asks the bus."""
    address = own_address()
    arguments = ("serve", "--cell", cell(tmp_path), "--port", "0", "--reconcell", f"ur10={address}")
    with started(*arguments, cwd=tmp_path) as server, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        assert "Dashboard" in first_line(server)
        record = ServerRecord.read(tmp_path / ".flexcell")
        headers = {"Authorization": f"Bearer {record.token}"}
        with httpx.Client(base_url=record.url, headers=headers, trust_env=False, timeout=LIMIT_S) as operator:

            def status() -> dict[str, object]:
                with operator.stream("GET", "/api/v1/bus/echo", params={"topic": "ur10/reconcell"}) as lines:
                    return httpx.Response(200, content=next(lines.iter_lines())).json()

            def command() -> None:
                sender.sendto(struct.pack("<7d", *THERE, 0.1), (address, 26000))
                sender.sendto(bytes([5]), (address, 10000))

            assert flexcell("stop", cwd=tmp_path).code == 0
            command()
            wait_until(lambda: status()["refused"] == {"cell is stopped": 1})
            assert status()["mode"] == 0
            assert flexcell("stop", "--release", cwd=tmp_path).code == 0
            command()
            wait_until(lambda: status()["mode"] == 5)
            assert operator.post("/api/v1/cell/stop", json={}).status_code == 204
            wait_until(lambda: status()["mode"] == 0)


def test_an_arm_that_the_packets_do_not_fit_is_an_error_in_one_line(tmp_path: Path) -> None:
    seven = flexcell("reconcell", "serve", cell(tmp_path), "--robot", "panda", "--address", own_address(), cwd=tmp_path)
    assert seven.code == 2
    assert seven.err.splitlines()[-1].startswith("flexcell: panda: panda has 7 joints")
