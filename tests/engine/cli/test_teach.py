"""`flexcell teach` against a running server: triggers from a file, buttons from a device, an entry at the end."""

from __future__ import annotations

import os
import struct
import subprocess
from pathlib import Path

from tests.engine.cli.command import FLEXCELL
from tests.engine.cli.process import started

CELL = Path(__file__).parents[2] / "robots" / "arm" / "one_panda.yaml"
TRIGGERS = """
- trig_name: Record joint state
  robot_ns: /
  trig_topic: /keypress/previous
  trig_type: rising_edge
  trig_value: true
  trig_callback: joint_save
"""


def said(*arguments: str | Path, cwd: Path) -> subprocess.CompletedProcess[str]:
    command = [FLEXCELL, *map(str, arguments)]
    return subprocess.run(command, cwd=cwd, capture_output=True, text=True, timeout=60, check=False)


def press(fifo: Path, code: int) -> None:
    """Press a button and let it go, and switch the device off."""
    descriptor = os.open(fifo, os.O_WRONLY)
    for value in (1, 0):
        os.write(descriptor, struct.pack("llHHi", 0, 0, 1, code, value))
    os.close(descriptor)


def test_a_button_of_a_device_teaches_a_configuration(tmp_path: Path) -> None:
    cell = tmp_path / "cell.yaml"
    cell.write_text(
        CELL.read_text(encoding="utf-8") + "\nstore: {kind: sqlite, path: .flexcell/cell.db}\n", encoding="utf-8"
    )
    (tmp_path / "triggers.yaml").write_text(TRIGGERS, encoding="utf-8")
    fifo = tmp_path / "event0"
    os.mkfifo(fifo)
    with started("serve", "--cell", cell, "--port", "0", cwd=tmp_path) as server:
        assert server.stdout is not None
        assert server.stdout.readline().startswith("Dashboard: ")
        assert "Record joint state" in said("teach", "set", "triggers.yaml", cwd=tmp_path).stdout
        with started("teach", "buttons", fifo, cwd=tmp_path) as buttons:
            press(fifo, 165)
            assert buttons.wait(30) == 0
        assert "joints" in said("teach", "status", cwd=tmp_path).stdout
        saved = said("teach", "save", "1", "above", "--tag", "station", cwd=tmp_path)
        assert saved.stdout == "joints above, revision 1\n", saved.stderr
        again = said("teach", "save", "1", "above", cwd=tmp_path)
        assert again.returncode != 0
        assert "above" in again.stderr
        assert '"joints"' in said("store", "get", "joints", "above", "--cell", cell, cwd=tmp_path).stdout
        proposed = said("teach", "propose", "above", "--out", "taught.yaml", cwd=tmp_path)
        assert proposed.stdout == "1. Move to above\n", proposed.stderr
        assert "robot: left" in (tmp_path / "taught.yaml").read_text(encoding="utf-8")
        assert '"taken_at_s"' in said("teach", "show", "1", cwd=tmp_path).stdout
        assert said("teach", "discard", "1", cwd=tmp_path).returncode == 0
        unknown = said("teach", "show", "1", cwd=tmp_path)
        assert "there is no capture 1" in unknown.stderr
