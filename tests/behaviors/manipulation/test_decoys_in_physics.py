"""A decoy of the same shape is no part, and a toppled part is not where it should be: in physics, by every tool."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cause_chain import describe_cause
from engine.event import Event, GoalFinished
from engine.registry import load_states
from engine.testing.behavior_run import CompletedRun, run_behavior

GRIPPER_CELL = """
flexcell: 1
cell: decoys
world: {kind: mujoco}
robots:
  arm: {model: panda, gripper: {model: panda_hand}}
fixtures:
  pedestal: {shape: box, size_m: [0.1, 0.1, 0.3], at: {xyz: [0.5, 0, 0.15]}}
  other: {shape: box, size_m: [0.1, 0.1, 0.3], at: {xyz: [0.5, 0.4, 0.15]}}
parts:
  decoy: {shape: box, size_m: [0.06, 0.03, 0.06], mass_kg: 0.1, at: {xyz: [0.5, 0, 0.33]}}
  payload: {shape: box, size_m: [0.06, 0.03, 0.06], mass_kg: 0.1, at: {xyz: [0.5, 0.4, 0.33]}}
"""
MAGNET_CELL = """
flexcell: 1
cell: decoys
world: {kind: mujoco}
robots:
  arm: {model: irb4600, gripper: {model: magnet}}
fixtures:
  pedestal: {shape: box, size_m: [0.4, 0.4, 1.0], at: {xyz: [1.4, 0.2, 0.5]}}
  other: {shape: box, size_m: [0.4, 0.4, 1.0], at: {xyz: [1.4, -0.6, 0.5]}}
parts:
  decoy: {shape: box, size_m: [0.3, 0.2, 0.01], mass_kg: 3, magnetic: true, at: {xyz: [1.4, 0.2, 1.005]}}
  payload: {shape: box, size_m: [0.3, 0.2, 0.01], mass_kg: 3, magnetic: true, at: {xyz: [1.4, -0.6, 1.005]}}
"""
HAND_CELL = """
flexcell: 1
cell: decoys
world: {kind: mujoco}
robots:
  arm: {model: panda, gripper: {model: softhand}}
fixtures:
  pedestal: {shape: box, size_m: [0.1, 0.1, 0.6], at: {xyz: [0.5, 0, 0.3]}}
  other: {shape: box, size_m: [0.1, 0.1, 0.6], at: {xyz: [0.5, 0.4, 0.3]}}
parts:
  decoy: {shape: cylinder, size_m: [0.05, 0.1], mass_kg: 0.25, at: {xyz: [0.5, 0, 0.65]}}
  payload: {shape: cylinder, size_m: [0.05, 0.1], mass_kg: 0.25, at: {xyz: [0.5, 0.4, 0.65]}}
"""
DOWN = "[1, 0, 0, 0]"
SIDEWAYS = "[0, 0.70710678, 0, 0.70710678]"
TOOLS = {
    "gripper": (GRIPPER_CELL, f"xyz: [0.5, 0, 0.335], xyzw: {DOWN}", "gripper.Grasp", "width_m: 0.03, force_n: 30, "),
    "magnet": (MAGNET_CELL, f"xyz: [1.4, 0.2, 1.011], xyzw: {DOWN}", "magnet.On", ""),
    "hand": (HAND_CELL, f"xyz: [0.509, -0.002, 0.65], xyzw: {SIDEWAYS}", "hand.Close", "percent: 70, "),
}


def holding(tool: str, part: str, checked: str) -> str:
    """Write the behavior that goes to the place of the part, closes the tool there, and checks what it holds."""
    _, pose, state, settings = TOOLS[tool]
    there = f"robot: arm, target: {{{pose}}}"
    above = "[-0.15, 0, 0.15]" if tool == "hand" else "[0, 0, 0.15]"
    # On its direct path the soft hand brushes the pedestal with two fingers.
    touched = "collisions: {may_touch: [pedestal, payload, decoy]}"
    return f"""
flexcell: 1
name: hold
outcomes: [held, missed, lost, failed]
success: [held]
root:
  machine:
    initial: above
    states:
      above:
        state: motion.MovePose
        with: {{{there}, offset_m: {above}, {touched}}}
        transitions: {{reached: down, failed: failed}}
      down:
        state: motion.MoveLinear
        with: {{{there}, speed_m_s: 0.1, {touched}}}
        transitions: {{reached: hold, failed: failed}}
      hold:
        state: {state}
        with: {{{tool}: arm, {settings}part: {part}}}
        transitions: {{held: check, missed: missed, failed: failed}}
      check:
        state: {tool}.CheckHeld
        with: {{{tool}: arm, part: {checked}}}
        transitions: {{held: held, lost: lost}}
"""


def ran(folder: Path, cell: str, behavior: str, events: list[Event] | None = None) -> CompletedRun:
    """Run a behavior in a cell; its events go to `events`."""
    for name, text in (("cell", cell), ("behavior", behavior)):
        (folder / f"{name}.yaml").write_text(text.lstrip(), encoding="utf-8")
    return run_behavior(
        folder / "behavior.yaml",
        catalogue=load_states(),
        store=folder / "store.db",
        cell=folder / "cell.yaml",
        watchers=(events.append,) if events is not None else (),
    )


@pytest.mark.parametrize("tool", TOOLS)
@pytest.mark.parametrize(
    ("part", "checked", "outcome"),
    [("payload", "payload", "missed"), ("decoy", "decoy", "held"), ("decoy", "payload", "lost")],
    ids=["wanted", "itself", "exchanged"],
)
def test_a_decoy_of_the_same_shape_is_not_the_part(
    tmp_path: Path, tool: str, part: str, checked: str, outcome: str
) -> None:
    """The contacts of the simulation name what the tool touches, and the result says that they do."""
    events: list[Event] = []
    run = ran(tmp_path, TOOLS[tool][0], holding(tool, part, checked), events)
    words = describe_cause(run.result.cause) if run.result.cause else ""
    assert (run.outcome, "it holds decoy, by contact, and not payload" in words) == (outcome, outcome != "held"), words
    (result,) = [event.result for event in events if isinstance(event, GoalFinished) and event.path == "root/hold"]
    assert isinstance(result, dict)
    assert (result["held"], result["part"], result["by"]) == (True, "decoy", "contact")


TOPPLING_CELL = """
flexcell: 1
cell: toppling
world: {kind: mujoco}
robots:
  arm: {model: panda, base: {xyz: [2, 0, 0]}}
fixtures:
  table: {shape: box, size_m: [1, 1, 0.1], at: {xyz: [0, 0, -0.05]}}
parts:
  upright: {shape: box, size_m: [0.05, 0.05, 0.12], mass_kg: 0.2, at: {xyz: [0, 0.2, 0.06]}}
  toppling: {shape: box, size_m: [0.05, 0.05, 0.12], mass_kg: 0.2, at: {xyz: [0, -0.2, 0.075], rpy: [0.6, 0, 0]}}
  lying: {shape: box, size_m: [0.05, 0.05, 0.12], mass_kg: 0.2, at: {xyz: [0.2, 0, 0.025], rpy: [1.5708, 0, 0]}}
"""


@pytest.mark.parametrize(("part", "outcome"), [("upright", "there"), ("lying", "there"), ("toppling", "elsewhere")])
def test_a_part_that_toppled_by_90_degrees_is_not_where_it_should_be(tmp_path: Path, part: str, outcome: str) -> None:
    """It leans too far, falls, and lies in its region; one that the cell lays down lies as it should."""
    y_m = {"upright": 0.2, "toppling": -0.2, "lying": 0.0}[part]
    behavior = f"""
flexcell: 1
name: topple
outcomes: [there, elsewhere]
success: [there]
root:
  machine:
    initial: wait
    states:
      wait: {{state: flow.Wait, with: {{duration_s: 2}}, transitions: {{done: expect}}}}
      expect:
        state: cell.ExpectPart
        with: {{part: {part}, region: {{center_m: [0.1, {y_m}], size_m: [0.3, 0.2]}}}}
        transitions: {{there: there, elsewhere: elsewhere}}
"""
    run = ran(tmp_path, TOPPLING_CELL, behavior)
    words = describe_cause(run.result.cause) if run.result.cause else ""
    assert run.outcome == outcome, words
    if outcome == "elsewhere":
        assert "it is tilted by 90.0 deg, 9.7 deg allowed" in words
