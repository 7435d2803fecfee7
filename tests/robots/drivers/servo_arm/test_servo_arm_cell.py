"""A servo arm in a cell: a behavior moves it through the driver, the line and the board, beside its simulated body."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import pytest

from robots.io.wire.read_capture import read_capture
from tests.engine.cli.command import FLEXCELL
from tests.robots.drivers.servo_arm.emulated_arm import LINES, emulated_servo_arm

CELL = """\
flexcell: 1
cell: bench
world: {{kind: mujoco, engine_silence_s: 10.0, world_silence_s: 10.0}}
robots:
  arm: {{model: servo_arm, driver: {driver}, outputs: {{gripper: 0}}}}
"""
BEHAVIOR = """\
flexcell: 1
name: wave
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: there
    states:
      there:
        state: motion.MoveJoints
        with: {robot: arm, target: [0.5, 0.4], speed: 0.5}
        transitions: {reached: free, failed: failed}
      free:
        state: motion.MoveFree
        with: {robot: arm, joints: [0.2, 0.3]}
        transitions: {reached: pick, blocked: failed, no_way: failed, failed: failed}
      pick:
        state: io.SetOutput
        with: {robot: arm, device: gripper, value: true}
        transitions: {set: finished, failed: failed}
"""


def flexcell(*arguments: str, cwd: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([FLEXCELL, *arguments], cwd=cwd, capture_output=True, text=True, check=False, timeout=300)


@pytest.mark.parametrize("line", LINES)
def test_a_behavior_moves_the_servos_once_a_person_has_enabled_them(tmp_path: Path, line: str) -> None:
    with emulated_servo_arm(line) as emulator:
        options = {"kind": "servo_arm", "device": emulator.serial_device, "stale_s": 5.0, "process_silence_s": 10.0}
        (tmp_path / "cell.yaml").write_text(CELL.format(driver=json.dumps(options)), encoding="utf-8")
        (tmp_path / "wave.yaml").write_text(BEHAVIOR, encoding="utf-8")
        refused = flexcell("run", "wave.yaml", cwd=tmp_path)
        assert refused.returncode != 0
        assert "motion is not enabled" in refused.stdout + refused.stderr

        open_deg = emulator.do("state")["claw_deg"]
        run = flexcell("run", "wave.yaml", "--enable", "the area is clear", "--capture", "traces", cwd=tmp_path)
        assert (run.returncode, run.stderr[-2000:]) == (0, run.stderr[-2000:])
        # Servo angles: the first joint as it is, the second one with an offset of 150 degrees.
        state = emulator.do("state")
        assert state["angles_deg"] == pytest.approx([11.46, 167.19], abs=0.5)
        assert state["claw_deg"] != open_deg
        (file,) = (tmp_path / "traces").iterdir()
        sent = b"".join(each.data for each in read_capture(file).events if each.kind == "sent")
        assert b"GO\n" in sent
        assert b"pick\n" in sent
