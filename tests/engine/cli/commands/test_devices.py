"""`flexcell devices` reads real devices and moves nothing; `flexcell emulate` is the other end."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Generator
from pathlib import Path
from typing import Any

import pytest

from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.emulated_gripper import emulated

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: ur10, gripper: {model: robotiq_2f85, driver: DRIVER}}
"""


def flexcell(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([FLEXCELL, *arguments], cwd=cwd, capture_output=True, text=True, check=False, timeout=120)


@pytest.fixture(scope="module")
def emulator() -> Generator[EmulatedProcess]:
    """A gripper that was just switched on."""
    with emulated("modbus_tcp", active=False) as started:
        yield started


def cell(folder: Path, emulator: EmulatedProcess, **connection: object) -> str:
    driver = {"kind": "robotiq", "connection": {**emulator.connection, **connection}, "timeout_s": 1.0, "stale_s": 3.0}
    (folder / "cell.yaml").write_text(CELL.replace("DRIVER", json.dumps(driver)), encoding="utf-8")
    return "cell.yaml"


def reports(folder: Path, name: str) -> list[dict[str, Any]]:
    return json.loads(flexcell("devices", name, "--json", cwd=folder).stdout)


def test_a_device_that_answers_is_reported_and_not_commanded(tmp_path: Path, emulator: EmulatedProcess) -> None:
    name = cell(tmp_path, emulator)
    (report,) = reports(tmp_path, name)
    address = f"{emulator.place['host']}:{emulator.place['port']}"
    assert (report["device"], report["driver"], report["address"]) == ("left/gripper", "robotiq", address)
    assert report["state"] == "not activated (reset)"
    assert report["readings"]["width_m"] == pytest.approx(0.043, abs=0.001)
    assert report["round_trip"]["readings"] == 50
    assert 0.0 < report["round_trip"]["min_s"] <= report["round_trip"]["median_s"] <= report["round_trip"]["max_s"]
    assert report["capabilities"] == ["gripper"]
    assert "Never run on hardware" in report["proven"]

    text = flexcell("devices", name, cwd=tmp_path)
    assert text.returncode == 0
    for line in (
        f"left/gripper: driver robotiq at {address}",
        "state: not activated",
        "fault: none",
        "(min/median/max",
    ):
        assert line in text.stdout
    assert (emulator.do("state")["commands"], emulator.do("state")["travel"]) == (0, 0.0)


def test_a_fault_is_named_and_gives_exit_code_1(tmp_path: Path, emulator: EmulatedProcess) -> None:
    name = cell(tmp_path, emulator)
    emulator.do("fault", code=10)
    found = flexcell("devices", name, cwd=tmp_path)
    emulator.do("fault", code=0)
    assert found.returncode == 1
    assert "fault: under-voltage: check the supply of the gripper" in found.stdout


def test_a_device_that_does_not_answer_says_where_and_what_to_check(tmp_path: Path, emulator: EmulatedProcess) -> None:
    name = cell(tmp_path, emulator, port=1)
    found = flexcell("devices", name, cwd=tmp_path)
    assert found.returncode == 1
    assert f"driver robotiq at {emulator.place['host']}:1\n" in found.stdout
    assert "no answer: cannot connect" in found.stdout
    assert "check: check supply and network" in found.stdout


def test_a_simulated_cell_has_no_real_device_and_a_wrong_option_is_refused_with_its_position(tmp_path: Path) -> None:
    (tmp_path / "sim.yaml").write_text(CELL.replace("DRIVER", "sim"), encoding="utf-8")
    simulated = flexcell("devices", "sim.yaml", cwd=tmp_path)
    assert (simulated.returncode, simulated.stdout) == (0, "all devices of this cell are simulated\n")
    wrong = CELL.replace("DRIVER", "{kind: robotiq, connection: {kind: urcap, hots: x}}")
    (tmp_path / "wrong.yaml").write_text(wrong, encoding="utf-8")
    refused = flexcell("devices", "wrong.yaml", cwd=tmp_path)
    assert refused.returncode == 2
    assert "wrong.yaml:5:" in refused.stderr
    assert "unknown key `hots`" in refused.stderr


def test_without_a_cell_the_installed_drivers_are_listed(tmp_path: Path) -> None:
    drivers = {driver["kind"]: driver for driver in json.loads(flexcell("devices", "--json", cwd=tmp_path).stdout)}
    assert drivers.keys() >= {"robotiq", "softhand"}
    assert drivers["robotiq"]["ports"]["urcap"] == 63352
    text = flexcell("devices", cwd=tmp_path).stdout
    assert "can do: gripper" in text
    assert "Never run on hardware" in text


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("robotik",), "did you mean robotiq?"),
        (("robotiq", "prot=0"), "did you mean port"),
        (("robotiq", "port=x"), "port"),
        (("robotiq", "host=192.0.2.1"), "cannot listen"),
        ((), "name the kind of device"),
    ],
)
def test_an_emulator_that_cannot_be_meant_is_refused(tmp_path: Path, arguments: tuple[str, ...], says: str) -> None:
    refused = flexcell("emulate", *arguments, cwd=tmp_path)
    assert refused.returncode == 2
    assert says in refused.stderr
    assert refused.stderr.count("\n") == 1


def test_emulators_are_listed_with_their_options(tmp_path: Path) -> None:
    text = flexcell("emulate", "--list", cwd=tmp_path).stdout
    assert "\nrobotiq: " in text
    assert "physics in an emulated cell only" in text
    assert "  object_m=" in text


def test_the_side_channel_says_what_it_does_not_understand(emulator: EmulatedProcess) -> None:
    with pytest.raises(AssertionError, match="explode is not known"):
        emulator.do("explode")
    with pytest.raises(AssertionError, match="KeyError"):
        emulator.do("slow")
    with pytest.raises(AssertionError, match="is no number"):
        emulator.do("fault", code="eight")
