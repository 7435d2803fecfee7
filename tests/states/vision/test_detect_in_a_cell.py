"""A behavior that looks for parts with a simulated camera, and goes on with what it finds."""

from __future__ import annotations

from pathlib import Path

import pytest

from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document import load_behavior, load_cell
from engine.event import Event, MessageLogged, NodeExited
from engine.journal import NullJournal
from engine.registry import load_states
from engine.runtime.plan import new_plan
from engine.runtime.run import Run

_CELL = """
flexcell: 1
cell: seen
world: {kind: mujoco, step_s: 0.002}
fixtures:
  floor: {shape: box, size_m: [2, 2, 0.04], at: {xyz: [0.3, 0, -0.02]}}
  lid: {shape: box, size_m: [0.4, 0.4, 0.01], at: {xyz: [0.4, -0.3, 0.2]}}
parts:
  cube: {shape: box, size_m: [0.05, 0.05, 0.05], mass_kg: 0.1, at: {xyz: [0.4, 0.2, 0.025]}}
  ball: {shape: sphere, size_m: [0.04], mass_kg: 0.1, at: {xyz: [0.4, -0.3, 0.02]}}
cameras:
  top: {at: [0.4, 0.0, 1.8], look_at: [0.4, 0, 0.1], detect: {labels: {cube: device}}}
"""
_BEHAVIOR = """
flexcell: 1
name: look
outcomes: [done, failed]
success: [done]
root:
  machine:
    initial: look
    states:
      look:
        state: vision.Detect
        with: {camera: top, label: device}
        transitions: {found: tell, not_found: failed, failed: failed}
      tell:
        state: flow.Log
        with: {message: "${label} at ${pose.xyz[0]}, one of ${size(detections)}"}
        transitions: {done: look_under_the_lid}
      look_under_the_lid:
        state: vision.Detect
        with: {camera: top, label: ball}
        transitions: {found: failed, not_found: done, failed: failed}
"""


def test_what_it_finds_is_there_for_the_states_after_it(tmp_path: Path) -> None:
    (tmp_path / "seen.yaml").write_text(_CELL, encoding="utf-8")
    (tmp_path / "look.yaml").write_text(_BEHAVIOR, encoding="utf-8")
    log: list[Event] = []

    async def main() -> str | None:
        plan = new_plan(load_behavior(tmp_path / "look.yaml"), load_states())
        journal = NullJournal().begin("look", behavior="", document="", started_unix_s=0.0)
        async with OpenCell(load_cell(tmp_path / "seen.yaml")) as cell:
            run = Run(plan, run="look", bus=cell.bus, parameters={}, inputs={}, seed=0, journal=journal)
            run.watch(log.append)
            return (await run.execute()).outcome

    assert run_virtual(main()) == "done"
    left = [f"{event.path} {event.outcome}" for event in log if isinstance(event, NodeExited)]
    assert left[:3] == ["root/look found", "root/tell done", "root/look_under_the_lid not_found"]
    (line,) = [event.message for event in log if isinstance(event, MessageLogged)]
    assert line.startswith("device at ")
    assert line.endswith(", one of 1")
    assert float(line.removeprefix("device at ").partition(",")[0]) == pytest.approx(0.4, abs=1e-3)
