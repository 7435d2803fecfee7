"""A part is taken and put down by every kind of tool in physics: one state to pick, one to place."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent, indent

import pytest

from engine.cause_chain import describe_cause
from engine.document import load_cell
from engine.registry import load_states
from engine.testing.behavior_run import CompletedRun, run_behavior

BEHAVIORS = Path(__file__).parents[3] / "behaviors"

PANDA_HAND = """
pick:
  {robot: left, part: hca_north, width_m: 0.03, force_n: 30, turns: 2, mass_kg: 0.12}
place:
  {robot: left, part: hca_north, target: {xyz: [-0.11, -0.28, 0.0275]}, target_of: part}
expect:
  {part: hca_north, region: {center_m: [-0.11, -0.28], size_m: [0.02, 0.02], height_m: [0.02, 0.03]}}
"""
ROBOTIQ = """
pick:
  {robot: arm, part: payload, width_m: 0.05, force_n: 146.5, turns: 4, approach_m: 0.15, mass_kg: 0.5}
place:
  {robot: arm, part: payload, target: {xyz: [-0.2, 0.8, 0.051]}, target_of: part, approach_m: 0.15}
expect:
  {part: payload, region: {center_m: [-0.2, 0.8], size_m: [0.02, 0.02], height_m: [0.048, 0.052]}}
"""
SOFT_HAND = """
pick:
  robot: arm
  tool: hand
  part: can
  grasp: {xyz: [0.009, -0.002, 0], xyzw: [0, 0.70710678, 0, 0.70710678], frame: part}
  approach: [0, -1, 0]
  percent: 70
place:
  robot: arm
  tool: hand
  part: can
  target: {xyz: [0.5, 0.4, 0.653]}
  target_of: part
  approach: [0, -1, 0]
expect:
  {part: can, region: {center_m: [0.5, 0.4], size_m: [0.03, 0.03], height_m: [0.64, 0.66]}}
"""
SOFT_HAND_CELL = """
flexcell: 1
cell: soft_hand
world: {kind: mujoco}
robots:
  arm: {model: panda, gripper: {model: softhand}}
fixtures:
  pedestal: {shape: box, size_m: [0.1, 0.1, 0.6], at: {xyz: [0.5, 0, 0.3]}}
  other: {shape: box, size_m: [0.1, 0.1, 0.6], at: {xyz: [0.5, 0.4, 0.3]}}
parts:
  can: {shape: cylinder, size_m: [0.05, 0.1], mass_kg: 0.25, at: {xyz: [0.5, 0, 0.65]}}
"""
HEAD = """
flexcell: 1
name: pick_and_place
outcomes: [placed, missed, unreachable, blocked, failed]
success: [placed]
root:
  machine:
    initial: pick
    states:
"""
OTHERS = "missed: missed, unreachable: unreachable, blocked: blocked, failed: failed"


def behavior(steps: str) -> str:
    """Write the behavior of these parameters of its three states."""
    pick, place, expect = (indent(part.split(":\n", 1)[1], "        ") for part in _parts(steps))
    return (
        f"{HEAD.strip()}\n"
        f"      pick:\n        state: manipulation.PickPart\n        with:\n{pick}\n"
        f"        transitions: {{picked: place, {OTHERS}}}\n"
        f"      place:\n        state: manipulation.PlacePart\n        with:\n{place}\n"
        f"        transitions: {{placed: expect, {OTHERS}}}\n"
        f"      expect:\n        state: cell.ExpectPart\n        with:\n{expect}\n"
        f"        transitions: {{there: placed, elsewhere: failed}}\n"
    )


def _parts(steps: str) -> tuple[str, str, str]:
    head, _, rest = dedent(steps).strip().partition("\nplace:")
    place, _, expect = rest.partition("\nexpect:")
    return head, f"place:{place}", f"expect:{expect}"


def run(folder: Path, cell: Path, steps: str, *, seed: int | None = None) -> CompletedRun:
    file = folder / "behavior.yaml"
    file.write_text(behavior(steps), encoding="utf-8")
    return run_behavior(file, catalogue=load_states(), store=folder / "store.db", cell=cell, seed=seed)


def ended(ran: CompletedRun) -> tuple[str | None, str]:
    """The outcome, and its causes."""
    return ran.outcome, describe_cause(ran.result.cause) if ran.result.cause else ""


@pytest.mark.parametrize(
    ("cell", "steps", "seed"),
    [
        pytest.param("dual_panda", PANDA_HAND, None, id="panda_hand", marks=pytest.mark.nightly),
        pytest.param("ur10", ROBOTIQ, 3, id="robotiq_2f85-3"),
        pytest.param("dual_panda", PANDA_HAND, 3, id="panda_hand-3", marks=pytest.mark.nightly),
        pytest.param("ur10", ROBOTIQ, None, id="robotiq_2f85", marks=pytest.mark.nightly),
    ],
)
def test_two_fingers_take_a_part_where_it_lies_and_put_it_down_straight(
    tmp_path: Path, cell: str, steps: str, seed: int | None
) -> None:
    """With a seed it lies off and turned."""
    assert ended(run(tmp_path, BEHAVIORS / "cells" / f"{cell}.yaml", steps, seed=seed)) == ("placed", "")


def test_a_soft_hand_takes_a_can_from_the_side_and_puts_it_down(tmp_path: Path) -> None:
    cell = tmp_path / "cell.yaml"
    cell.write_text(SOFT_HAND_CELL.lstrip(), encoding="utf-8")
    assert load_cell(cell).document.cell == "soft_hand"
    assert ended(run(tmp_path, cell, SOFT_HAND)) == ("placed", "")


def test_a_part_out_of_reach_is_unreachable_with_the_reason(tmp_path: Path) -> None:
    """The other arm's part, and a grasp from below the table."""
    cell = BEHAVIORS / "cells" / "dual_panda.yaml"
    far = PANDA_HAND.replace("turns: 2", "grasp: {xyz: [1.2, 0, 0], xyzw: [1, 0, 0, 0], frame: part}")
    ran = run(tmp_path, cell, far)
    assert ran.outcome == "unreachable"
    assert "left did not pick part hca_north" in ended(ran)[1]
