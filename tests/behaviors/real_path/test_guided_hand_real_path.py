"""An IRC5 guided by EGM carries a can in a SoftHand, both through their drivers, judged by their emulated world."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.behaviors.real_path.emulated_cell import EmulatedCell, RealPath

CELL = """\
flexcell: 1
cell: guided_hand
world: {kind: mujoco, engine_silence_s: 10.0, world_silence_s: 10.0}
robots:
  arm:
    model: irb4600
    driver:
      kind: abb_irc5
      host: HOST
      loads: defined_there
      patience_s: 300.0
      egm: {port: 16510, address: HOST, stale_s: 5.0, start_s: 30.0, process_silence_s: 10.0}
    gripper: {model: softhand, driver: {kind: softhand, device: "socket://HOST:5001", stale_s: 5.0, timeout_s: 1.0}}
fixtures:
  middle: {shape: box, size_m: [0.1, 0.1, 0.9], at: {xyz: [1.2, 0, 0.45]}}
  left: {shape: box, size_m: [0.1, 0.1, 0.9], at: {xyz: [1.2, 0.4, 0.45]}}
  right: {shape: box, size_m: [0.1, 0.1, 0.9], at: {xyz: [1.2, -0.4, 0.45]}}
parts:
  can: {shape: cylinder, size_m: [0.05, 0.1], mass_kg: 0.25, at: {xyz: [1.2, 0, 0.95]}}
  tin: {shape: cylinder, size_m: [0.05, 0.1], mass_kg: 0.25, at: {xyz: [1.2, -0.4, 0.95]}}
"""
BEHAVIOR = """\
flexcell: 1
name: carry
cell: cells/guided_hand.yaml
parameters:
  part: {type: string, default: can}
  let_go: {type: boolean, default: false}
outcomes: [placed, dropped, failed]
success: [placed]
root:
  machine:
    initial: pick
    states:
      pick:
        state: manipulation.PickPart
        with:
          robot: arm
          tool: hand
          part: "${part}"
          grasp: {xyz: [0.009, -0.002, 0], xyzw: [0, 0.70710678, 0, 0.70710678], frame: part}
          approach: [0, -1, 0]
          percent: 70
        transitions: {picked: choose, missed: failed, unreachable: failed, blocked: failed, failed: failed}
      choose:
        state: flow.Decide
        with: {when: "${let_go}"}
        transitions: {"true": aside, "false": place}
      aside:
        state: motion.MoveFree
        with: {robot: arm, pose: {xyz: [1.1, -0.75, 1.15], xyzw: [0, 0.70710678, 0, 0.70710678]}}
        transitions: {reached: open, blocked: failed, no_way: failed, failed: failed}
      open:
        state: hand.Open
        with: {hand: arm}
        transitions: {opened: check, failed: failed}
      check:
        state: hand.CheckHeld
        with: {hand: arm, part: "${part}"}
        transitions: {held: failed, lost: dropped}
      place:
        state: manipulation.PlacePart
        with:
          robot: arm
          tool: hand
          part: "${part}"
          target: {xyz: [1.2, 0.4, 0.953]}
          target_of: part
          approach: [0, -1, 0]
        transitions: {placed: rest, missed: dropped, unreachable: failed, blocked: failed, failed: failed}
      rest:
        state: motion.MoveJoints
        with: {robot: arm, target: [0.3, 0.1, -0.1, 0, 0.5, 0.2], speed: 0.3}
        transitions: {reached: placed, failed: failed}
"""
REST_RAD = (0.3, 0.1, -0.1, 0.0, 0.5, 0.2)
STANDS_M = 0.95
LIES_M = 0.06


@dataclass(frozen=True)
class GuidedHandPath(RealPath):
    """A cell and a behavior of this test, written to its folder."""

    def write_cell(self, folder: Path, host: str) -> Path:
        """Write both; their drivers connect to an address."""
        (folder / "cells").mkdir()
        (folder / "carry.yaml").write_text(BEHAVIOR, encoding="utf-8")
        cell = folder / "cells" / "guided_hand.yaml"
        cell.write_text(self.with_drivers(CELL, host), encoding="utf-8")
        return cell


@pytest.mark.timeout(1800)
def test_a_guided_arm_carries_a_can_in_a_soft_hand_and_a_can_that_it_lets_go_is_missed(tmp_path: Path) -> None:
    """The engine plans and moves in its own world; what lies where in the end, only this one knows."""
    path = GuidedHandPath(
        name="IRB 4600 by EGM and SoftHand",
        behavior=str(tmp_path / "carry.yaml"),
        cell="guided_hand",
        with_drivers=lambda text, host: text.replace("HOST", host),
    )
    with EmulatedCell(path, tmp_path) as emulated:
        run = emulated.run("--enable", "the emulated cell is clear", limit_s=800.0)
        assert run.returncode == 0, (run.stdout + run.stderr)[-3000:]
        state = emulated.state()
        assert state["arms"]["arm"] == pytest.approx(REST_RAD, abs=0.003)
        assert state["touched"]["arm"] == []
        assert emulated.part("can") == pytest.approx((1.2, 0.4, STANDS_M), abs=0.015)
        assert emulated.tilt_rad("can") < 0.02

        dropped = emulated.run(
            "--enable", "the emulated cell is clear", "-p", "part=tin", "-p", "let_go=true", limit_s=800.0
        )
        said = dropped.stdout + dropped.stderr
        assert (dropped.returncode, "root/open  ended with opened" in said, said[-3000:]) == (1, True, said[-3000:])
        assert "run finished with dropped" in said
        assert emulated.part("tin")[2] < LIES_M
        assert emulated.part("can") == pytest.approx((1.2, 0.4, STANDS_M), abs=0.015)
