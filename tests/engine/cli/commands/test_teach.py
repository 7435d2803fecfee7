"""`flexcell teach` against a running server: triggers from a file, buttons from a device, an entry at the end."""

from __future__ import annotations

import os
import struct
from pathlib import Path

from tests.engine.cli.command import flexcell
from tests.engine.cli.process import started

CELL = Path(__file__).parents[3] / "robots" / "arm" / "one_panda.yaml"
TRIGGERS = """
- trig_name: Record joint state
  robot_ns: /
  trig_topic: /keypress/previous
  trig_type: rising_edge
  trig_value: true
  trig_callback: joint_save
"""


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
        assert "Record joint state" in flexcell("teach", "set", "triggers.yaml", cwd=tmp_path).out
        with started("teach", "buttons", fifo, cwd=tmp_path) as buttons:
            press(fifo, 165)
            assert buttons.wait(30) == 0
        assert "joints" in flexcell("teach", "status", cwd=tmp_path).out
        saved = flexcell("teach", "save", "1", "above", "--tag", "station", cwd=tmp_path)
        assert saved.out == "joints above, revision 1\n", saved.err
        again = flexcell("teach", "save", "1", "above", cwd=tmp_path)
        assert again.code != 0
        assert "above" in again.err
        assert '"joints"' in flexcell("store", "get", "joints", "above", "--cell", cell, cwd=tmp_path).out
        proposed = flexcell("teach", "propose", "above", "--out", "taught.yaml", cwd=tmp_path)
        assert proposed.out == "1. Move to above\n", proposed.err
        assert "robot: left" in (tmp_path / "taught.yaml").read_text(encoding="utf-8")
        assert '"taken_at_s"' in flexcell("teach", "show", "1", cwd=tmp_path).out
        assert flexcell("teach", "discard", "1", cwd=tmp_path).code == 0
        unknown = flexcell("teach", "show", "1", cwd=tmp_path)
        assert "there is no capture 1" in unknown.err
