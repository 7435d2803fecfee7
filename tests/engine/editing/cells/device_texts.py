"""A cell with equipment, devices and a bond under test, with a module and pins."""

from __future__ import annotations

from pathlib import Path

PINS = """\
flexcell: 1
equipment: clamps
backend: {kind: simulated}
pins:
  valve: {kind: digital_output, pin: 1, safe: false}
  shut: {kind: digital_input, pin: 2}
"""
MODULE = """\
flexcell: 1
module: press
fixtures:
  ram: {shape: box, size_m: [0.1, 0.1, 0.1]}
devices:
  lift:
    axes:
      up: {joint: slide, body: ram, along: [0, 0, 1], stroke_m: 0.1, force_n: 10, speed_m_s: 0.1, output: lift_up}
    positions:
      top: {steps: [{set: {lift_up: true}}], time: 1 s}
"""
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
equipment:
  valves: {pins: clamps.yaml}   # in the rack
connectors:
  dock: {at: {xyz: [1, 0, 0]}}
modules:
  press: {module: press, connector: dock}
fixtures:
  jaw: {shape: box, size_m: [0.1, 0.1, 0.1], at: {xyz: [0, 0, 0.1]}}
  stop: {shape: box, size_m: [0.1, 0.1, 0.1], at: {xyz: [0.2, 0, 0.1]}}
parts:
  lid: {shape: box, size_m: [0.1, 0.1, 0.01], mass_kg: 0.1, at: {xyz: [0.2, 0, 0.1551]}}
devices:
  clamp:
    equipment: valves
    axes:   # one only
      main: {joint: slide, body: jaw, along: [1, 0, 0], stroke_m: 0.05, force_n: 40, speed_m_s: 0.10, against: [stop],
             output: valve}
    sensors:
      shut: {axis: main, at_least: 0.04}
    positions:
      closed: {steps: [{set: {valve: true}}], sensors: {shut: true}, time: 2 s}
    interlocks:
      - {position: closed, device: press/lift, at: top}
bonds:
  glue: {kind: glue, part: lid, to: stop, force_n: 8.0}
"""


def write_device_cell(folder: Path) -> Path:
    """Write the cell with its module and its pins, and return its file."""
    (folder / "press").mkdir()
    (folder / "press" / "module.yaml").write_text(MODULE)
    (folder / "clamps.yaml").write_text(PINS)
    file = folder / "bench.yaml"
    file.write_text(CELL)
    return file
