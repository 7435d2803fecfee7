"""A real gripper on a simulated arm: the same behavior, the same states, through the driver and the wire."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.emulated_gripper import emulated
from tests.robots.drivers.emulated_hand import emulated_hand

CELL = """\
flexcell: 1
cell: bench
world: {{kind: mujoco, engine_silence_s: 5.0, world_silence_s: 5.0}}
robots:
  left:
    model: ur10
    gripper: {{model: robotiq_2f85, driver: {driver}}}
"""
BEHAVIOR = """\
flexcell: 1
name: grip
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: grasp
    states:
      grasp:
        state: gripper.Grasp
        with: {gripper: left, width_m: 0.03, force_n: 60}
        transitions: {held: check, missed: failed, failed: failed}
      check:
        state: gripper.CheckHeld
        with: {gripper: left}
        transitions: {held: open, lost: failed}
      open:
        state: gripper.Open
        with: {gripper: left}
        transitions: {opened: finished, failed: failed}
"""
HAND_CELL = """\
flexcell: 1
cell: bench
world: {{kind: mujoco, engine_silence_s: 5.0, world_silence_s: 5.0}}
robots:
  left:
    model: panda
    gripper: {{model: softhand, driver: {driver}}}
"""
HAND_BEHAVIOR = """\
flexcell: 1
name: grip
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: close
    states:
      close:
        state: hand.Close
        with: {hand: left, percent: 80}
        transitions: {held: check, missed: failed, failed: failed}
      check:
        state: hand.CheckHeld
        with: {hand: left}
        transitions: {held: open, lost: failed}
      open:
        state: hand.Open
        with: {hand: left}
        transitions: {opened: finished, failed: failed}
"""


def flexcell(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([FLEXCELL, *arguments], cwd=cwd, capture_output=True, text=True, check=False, timeout=300)


def written(folder: Path, emulator: EmulatedProcess) -> None:
    options = {"kind": "robotiq", "connection": emulator.connection, "stale_s": 5.0, "timeout_s": 1.0}
    (folder / "cell.yaml").write_text(CELL.format(driver=json.dumps(options)), encoding="utf-8")
    (folder / "grip.yaml").write_text(BEHAVIOR, encoding="utf-8")


def test_a_behavior_grips_with_a_real_gripper_on_a_simulated_arm_once_a_person_has_enabled_it(tmp_path: Path) -> None:
    """Before that it is refused, and says how to enable it."""
    with emulated("urcap", object_m=0.03, active=False) as emulator:
        written(tmp_path, emulator)
        assert flexcell("check", "grip.yaml", cwd=tmp_path).returncode == 0
        refused = flexcell("run", "grip.yaml", cwd=tmp_path)
        assert refused.returncode != 0
        assert "not activated" in refused.stdout + refused.stderr
        assert emulator.do("state")["commands"] == 0

        request = ("left/gripper/enable_device", '{"reason": "the area is clear"}')
        enabled = flexcell("bus", "call", *request, "--cell", "cell.yaml", cwd=tmp_path)
        assert json.loads(enabled.stdout)["enabled"] is True
        run = flexcell("run", "grip.yaml", cwd=tmp_path)
        assert (run.returncode, run.stderr[-2000:]) == (0, run.stderr[-2000:])
        assert emulator.do("state")["width_m"] == pytest.approx(0.085, abs=0.001)


def test_a_real_gripper_has_no_virtual_time(tmp_path: Path) -> None:
    with emulated("modbus_tcp") as emulator:
        written(tmp_path, emulator)
        refused = flexcell("run", "grip.yaml", "--clock", "virtual", cwd=tmp_path)
        assert refused.returncode == 2
        assert "a real gripper has no virtual time" in refused.stderr


def test_a_behavior_grips_with_a_real_hand_on_a_simulated_arm_once_a_person_has_enabled_it(tmp_path: Path) -> None:
    with emulated_hand("tcp", active=False) as emulator:
        options = {"kind": "softhand", "device": emulator.serial_device, "stale_s": 5.0, "timeout_s": 1.0}
        (tmp_path / "cell.yaml").write_text(HAND_CELL.format(driver=json.dumps(options)), encoding="utf-8")
        (tmp_path / "grip.yaml").write_text(HAND_BEHAVIOR, encoding="utf-8")
        emulator.do("object", share=0.5)
        assert flexcell("check", "grip.yaml", cwd=tmp_path).returncode == 0
        refused = flexcell("run", "grip.yaml", cwd=tmp_path)
        assert refused.returncode != 0
        assert "not activated" in refused.stdout + refused.stderr
        assert emulator.do("state")["commands"] == 0

        request = ("left/hand/enable_device", '{"reason": "the area is clear"}')
        enabled = flexcell("bus", "call", *request, "--cell", "cell.yaml", cwd=tmp_path)
        assert json.loads(enabled.stdout)["enabled"] is True
        assert emulator.do("state")["travel"] == 0.0
        run = flexcell("run", "grip.yaml", cwd=tmp_path)
        assert (run.returncode, run.stderr[-2000:]) == (0, run.stderr[-2000:])
        state = emulator.do("state")
        assert (state["position_ticks"], state["travel"] > 10_000) == (0, True)
