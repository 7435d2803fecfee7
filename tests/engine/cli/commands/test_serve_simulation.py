"""Sim or real by one word: `--simulate`, and the switch of the page, which opens the cell of a server anew."""

from __future__ import annotations

import json
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

import httpx

from engine.bus.remote_bus import ServerRecord
from engine.journal import list_runs
from engine.recording.recorded_run import read_run
from tests.engine.cli.command import flexcell
from tests.engine.cli.process import started
from tests.robots.drivers.emulated_gripper import emulated

LIMIT_S = 120.0
CELL = """\
flexcell: 1
cell: bench
world: {{kind: mujoco, engine_silence_s: 5.0, world_silence_s: 5.0}}
robots:
  left: {{model: ur10, gripper: {{model: robotiq_2f85, driver: {driver}}}}}
"""
BEHAVIOR = """\
flexcell: 1
name: open_it
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: open
    states:
      open:
        state: gripper.Open
        with: {gripper: left}
        transitions: {opened: finished, failed: failed}
"""
UNREACHABLE = {"kind": "urcap", "host": "127.0.0.77", "port": 9}


def written(folder: Path, connection: dict[str, Any]) -> None:
    options = {"kind": "robotiq", "connection": connection, "stale_s": 5.0, "timeout_s": 1.0}
    (folder / "cell.yaml").write_text(CELL.format(driver=json.dumps(options)), encoding="utf-8")
    (folder / "open.yaml").write_text(BEHAVIOR, encoding="utf-8")


def test_a_real_device_that_is_not_there_is_simulated_by_one_word_also_in_virtual_time(tmp_path: Path) -> None:
    """The journal knows it: the run cannot be resumed with the real device."""
    written(tmp_path, UNREACHABLE)
    unreached = flexcell("run", "open.yaml", cwd=tmp_path)
    assert unreached.code != 0
    assert "127.0.0.77" in unreached.err
    run = flexcell("run", "open.yaml", "--simulate", "all", "--clock", "virtual", "--json", cwd=tmp_path)
    assert (run.code, json.loads(run.out)["outcome"]) == (0, "finished")
    (record,) = [each for each in list_runs(tmp_path / ".flexcell") if each.id == json.loads(run.out)["run"]]
    assert read_run(tmp_path / ".flexcell", record.id).origin.simulated == ("left/gripper",)


def test_a_run_of_a_simulated_cell_does_not_go_on_with_a_device_that_the_cell_has_made_real_since(
    tmp_path: Path,
) -> None:
    written(tmp_path, UNREACHABLE)
    (tmp_path / "cell.yaml").write_text(CELL.format(driver='"sim"'), encoding="utf-8")
    run = flexcell("run", "open.yaml", "--clock", "virtual", "--json", cwd=tmp_path)
    assert (run.code, json.loads(run.out)["outcome"]) == (0, "finished")
    run_id = json.loads(run.out)["run"]
    assert read_run(tmp_path / ".flexcell", run_id).origin.real == ()
    written(tmp_path, UNREACHABLE)
    refused = flexcell("run", "open.yaml", "--from", f"{run_id}@2", "--at", "root/open", cwd=tmp_path)
    assert refused.code == 2
    assert "left/gripper was simulated in this run, and is real now" in refused.err


def test_what_cannot_be_simulated_is_refused(tmp_path: Path) -> None:
    written(tmp_path, UNREACHABLE)
    refused = flexcell("run", "open.yaml", "--simulate", "lift", cwd=tmp_path)
    assert refused.code == 2
    assert "bench has no device `lift` to simulate" in refused.err


@contextmanager
def served(folder: Path, *options: str) -> Generator[tuple[httpx.Client, IO[str]]]:
    """Serve the cell; yields a client with the token of an operator, and what the server prints."""
    with started("serve", "--cell", "cell.yaml", "--port", "0", *options, cwd=folder) as server:
        assert server.stdout is not None
        assert server.stdout.readline().startswith("Dashboard: ")
        server.stdout.readline()
        record = ServerRecord.read(folder / ".flexcell")
        headers = {"Authorization": f"Bearer {record.token}"}
        with httpx.Client(base_url=record.url, headers=headers, trust_env=False, timeout=LIMIT_S) as client:
            yield client, server.stdout


def reopened(client: httpx.Client, printed: IO[str], *simulated: str) -> dict[str, Any]:
    """Ask for the cell to be opened anew, and return the session of the server that answers then."""
    answer = client.post("/api/v1/cell/simulation", json={"simulated": simulated})
    assert answer.status_code == 202, answer.text
    assert printed.readline() == "The cell is open again.\n"
    session: dict[str, Any] = client.get("/api/v1/session").json()
    return session


def test_the_page_switches_a_device_to_its_driver_and_back_at_the_same_address(tmp_path: Path) -> None:
    with emulated("urcap") as emulator:
        written(tmp_path, emulator.connection)
        with served(tmp_path, "--simulate", "left") as (client, printed):
            before = ServerRecord.read(tmp_path / ".flexcell").url
            device = {"device": "left/gripper", "driver": "robotiq"}
            assert client.get("/api/v1/session").json()["devices"] == [device | {"simulated": True}]
            assert client.post("/api/v1/cell/simulation", json={"simulated": ["left"]}).status_code == 409
            assert client.post("/api/v1/cell/simulation", json={"simulated": ["lift"]}).status_code == 422

            session = reopened(client, printed)
            assert session["devices"] == [device | {"simulated": False}]
            assert session["opening_problem"] == ""
            assert (ServerRecord.read(tmp_path / ".flexcell").url, session["role"]) == (before, "operator")
            items = client.get("/api/v1/cell/items").json()["items"]
            assert any("left/gripper/device" in item["topics"] for item in items)
            assert emulator.do("state")["commands"] == 0

            assert reopened(client, printed, "left/gripper")["devices"] == [device | {"simulated": True}]


def test_a_device_that_cannot_be_opened_leaves_the_cell_as_it_was_and_says_why(tmp_path: Path) -> None:
    written(tmp_path, UNREACHABLE)
    with served(tmp_path, "--simulate", "all") as (client, printed):
        session = reopened(client, printed)
        assert [each["simulated"] for each in session["devices"]] == [True]
        assert "127.0.0.77" in session["opening_problem"]
