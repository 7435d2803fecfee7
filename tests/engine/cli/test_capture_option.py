"""`--capture` writes what devices and drivers say, `flexcell emulate replay` plays it back; what is refused."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from robots.io.wire.read_capture import CapturedConnection, read_capture
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.emulated_device import replayed
from tests.robots.drivers.emulated_gripper import emulated
from tests.robots.drivers.servo_arm.emulated_arm import emulated_servo_arm
from tests.robots.drivers.universal_robots.client_library import needs_client_library
from tests.robots.drivers.universal_robots.emulated_controller import EmulatedController

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {ROBOT}
"""


def flexcell(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([FLEXCELL, *arguments], cwd=cwd, capture_output=True, text=True, check=False, timeout=120)


def devices(folder: Path, robot: object, *arguments: str) -> subprocess.CompletedProcess[str]:
    (folder / "cell.yaml").write_text(CELL.replace("{ROBOT}", json.dumps(robot)), encoding="utf-8")
    found = flexcell("devices", "cell.yaml", *arguments, cwd=folder)
    assert found.returncode == 0, found.stdout + found.stderr
    return found


def captured(folder: Path) -> dict[str, CapturedConnection]:
    """Return all captures of a folder by device and protocol."""
    found = [read_capture(file) for file in folder.iterdir()]
    return {f"{each.device} {each.protocol}": each for each in found}


def test_the_readings_of_a_gripper_are_captured_and_read_again_from_the_capture(tmp_path: Path) -> None:
    def robot(connection: object) -> object:
        driver = {"kind": "robotiq", "connection": connection, "timeout_s": 1.0, "stale_s": 3.0}
        return {"model": "ur10", "driver": "sim", "gripper": {"model": "robotiq_2f85", "driver": driver}}

    with emulated("modbus_tcp", active=False) as emulator:
        before = devices(tmp_path, robot(emulator.connection), "--capture", "traces/today")
    found = captured(tmp_path / "traces" / "today")
    (events,) = (each.events for each in found.values())
    assert list(found) == ["left/gripper modbus_tcp"]
    assert sum(each.kind == "sent" for each in events) >= 50
    assert (events[0].kind, events[-1].kind) == ("opened", "closed")

    (file,) = (tmp_path / "traces" / "today").iterdir()
    with replayed(file) as replay:
        after = devices(tmp_path, robot(replay.connection))
    state = "state: not activated (reset)"
    assert state in before.stdout
    assert state in after.stdout


def test_the_process_of_an_arm_captures_its_line(tmp_path: Path) -> None:
    with emulated_servo_arm("tcp") as board:
        driver = {"kind": "servo_arm", "device": board.serial_device, "stale_s": 5.0, "process_silence_s": 10.0}
        devices(tmp_path, {"model": "servo_arm", "driver": driver}, "--capture", "traces")
    found = captured(tmp_path / "traces")
    assert list(found) == ["left servo_lines"]
    received = b"".join(each.data for each in found["left servo_lines"].events if each.kind == "received")
    assert received.startswith(b"READY flexcell_servo_arm")
    assert b"HALT boot" in received


@needs_client_library
def test_what_a_library_sends_by_itself_is_not_captured_and_said_so(tmp_path: Path) -> None:
    with EmulatedController(series="cb3") as controller:
        driver = {"kind": "universal_robots", "host": controller.host, "stale_s": 5.0, "process_silence_s": 10.0}
        found = devices(tmp_path, {"model": "ur10", "driver": driver}, "--capture", "traces")
    assert "the capture of left is not complete: RTDE" in found.stderr
    assert "tcpdump" in found.stderr
    assert list(captured(tmp_path / "traces")) == ["left ur_dashboard"]


def test_a_folder_that_cannot_be_made_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("", encoding="utf-8")
    (tmp_path / "cell.yaml").write_text("flexcell: 1\ncell: bench\n", encoding="utf-8")
    refused = flexcell("devices", "cell.yaml", "--capture", "file/traces", cwd=tmp_path)
    assert refused.returncode == 2
    assert "--capture file/traces: cannot be made" in refused.stderr


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((), "name the capture (flexcell emulate replay file=FILE)"),
        (("file=none.pcapng",), "none.pcapng: cannot be read: No such file or directory"),
        (("file=cell.yaml",), "cell.yaml: no capture of this program: offset 0: no section header of pcapng"),
        (("pace=fast",), "the emulator replay"),
    ],
)
def test_a_capture_that_cannot_be_replayed_is_refused(tmp_path: Path, arguments: tuple[str, ...], says: str) -> None:
    (tmp_path / "cell.yaml").write_text("flexcell: 1\ncell: bench\n", encoding="utf-8")
    refused = flexcell("emulate", "replay", *arguments, cwd=tmp_path)
    assert refused.returncode == 2
    assert says in refused.stderr
    assert refused.stderr.count("\n") == 1
