"""A behavior sets an output and waits for an input: at a real server with an emulated pigpiod, and simulated."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path

from engine.registry import load_states
from engine.testing import run_behavior
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.emulated_device import emulated_device
from tests.robots.drivers.equipment.device.equipment_cell import written
from tests.robots.drivers.equipment.served_equipment import PINS, SIMULATED, served_equipment, waited_for

VALVE, THERE = 22, 27
BEHAVIOR = """\
flexcell: 1
name: hold
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: open
    states:
      open:
        state: io.SetOutput
        with: {robot: vice, name: valve, value: true}
        transitions: {set: wait, failed: failed}
      wait:
        state: io.WaitForInput
        with: {robot: vice, name: there, value: VALUE, timeout_s: 60}
        transitions: {reached: read, timeout: failed, unknown: failed}
      read:
        state: io.ReadInput
        with: {robot: vice, name: there}
        transitions: {"on": AFTER_ON, "off": AFTER_OFF, unknown: failed}
"""


def behavior(folder: Path, *, value: bool) -> Path:
    """Write a behavior that waits until the input has this value."""
    after = ("finished", "failed") if value else ("failed", "finished")
    text = BEHAVIOR.replace("VALUE", str(value).lower())
    (folder / "hold.yaml").write_text(
        text.replace("AFTER_ON", after[0]).replace("AFTER_OFF", after[1]), encoding="utf-8"
    )
    return folder / "hold.yaml"


def test_at_a_real_server_once_a_person_permits_it(tmp_path: Path) -> None:
    with emulated_device("pigpiod") as pigpiod:
        place = pigpiod.place
        backend = f"{{kind: gpiozero, factory: pigpio, host: {place['host']}, port: {place['port']}}}"
        pins = f"flexcell: 1\nequipment: clamps\nbackend: {backend}\n{PINS}"
        (tmp_path / "served.yaml").write_text(pins, encoding="utf-8")
        with served_equipment(tmp_path / "served.yaml") as server:
            written(tmp_path, host=server.host, port=server.port, pins=pins)
            behavior(tmp_path, value=True)
            command = [FLEXCELL, "run", "hold.yaml"]
            refused = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=120)
            assert refused.returncode == 1
            assert "not enabled" in refused.stdout + refused.stderr
            assert pigpiod.do("state", pin=VALVE)["level"] == 0
            command += ["--enable", "a test"]
            with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True, env=os.environ) as run:
                assert waited_for(lambda: pigpiod.do("state", pin=VALVE)["level"] == 1, at_most_s=60.0)
                pigpiod.do("level", pin=THERE, on=True)
                out, _ = run.communicate(timeout=60.0)
                assert (run.returncode, out) == (0, out)
            # The cell is closed: the server has made outputs safe.
            assert waited_for(lambda: pigpiod.do("state", pin=VALVE)["level"] == 0)


def test_simulated_by_one_word_in_virtual_time(tmp_path: Path) -> None:
    written(tmp_path, port=1, pins=SIMULATED)
    run = run_behavior(
        behavior(tmp_path, value=False), catalogue=load_states(), store=tmp_path / "store", simulate=("vice",)
    )
    assert run.outcome == "finished"


def test_the_command_line_reports_it_and_finds_mistakes_in_its_options(tmp_path: Path) -> None:
    (tmp_path / "served.yaml").write_text(SIMULATED, encoding="utf-8")
    with served_equipment(tmp_path / "served.yaml") as server:
        file = written(tmp_path, host=server.host, port=server.port)
        listed = subprocess.run(
            [FLEXCELL, "devices", file, "--json"], capture_output=True, text=True, check=False, timeout=120
        )
        (report,) = json.loads(listed.stdout)
        assert (listed.returncode, report["device"], report["fault"]) == (0, "vice", "")
        assert report["state"] == "clamps, nobody controls it"
        assert report["readings"] == {"clamp": 1.0, "valve": 0.0, "there": 0.0}
    file.write_text(file.read_text(encoding="utf-8").replace("port:", "prt:"), encoding="utf-8")
    checked = subprocess.run([FLEXCELL, "check", file], capture_output=True, text=True, check=False, timeout=120)
    assert checked.returncode != 0
    assert "cell.yaml:4:" in checked.stdout
    assert "did you mean port?" in checked.stdout
