"""The cell of `chaos.py`: two Pandas that plan around each other, and a depth camera."""

from __future__ import annotations

from pathlib import Path

BEHAVIOR = "behaviors/shared.yaml"

_CELL = """
flexcell: 1
cell: chaos
world: {kind: mujoco, step_s: 0.001}
robots:
  left: {model: panda, driver: sim, base: {xyz: [-0.55, 0, 0], rpy: [0, 0, 0]}}
  right: {model: panda, driver: sim, base: {xyz: [0.55, 0, 0], rpy: [0, 0, 3.141592653589793]}}
cameras:
  above: {at: [0, -1.6, 1.8], look_at: [0, 0, 0.4], size_px: [160, 120], rate_hz: 5}
occupancy: {center_m: [0, 0, 0.6], size_m: [1.2, 1.2, 0.8], voxel_m: 0.05}
"""
_ARM = """
      {robot}:
        machine:
          initial: there
          states:
            there:
              state: motion.MoveFree
              with: {{robot: {robot}, joints: [{turn}, -0.2, 0, -2.0, 0, 1.9, 0.8], speed: 0.3, patience_s: 60}}
              transitions: {{reached: back, blocked: ended, no_way: ended, failed: ended}}
            back:
              state: motion.MoveFree
              with: {{robot: {robot}, joints: [-{turn}, -0.2, 0, -2.0, 0, 1.9, 0.8], speed: 0.3, patience_s: 60}}
              transitions: {{reached: there, blocked: ended, no_way: ended, failed: ended}}
"""
_SHARED = f"""
flexcell: 1
name: shared
cell: cell.yaml
outcomes: [ended]
success: []
root:
  concurrency:
    states:{_ARM.format(robot="left", turn=0.9)}{_ARM.format(robot="right", turn=0.7)}
    conditions:
      - {{ended: {{left: ended}}}}
      - {{ended: {{right: ended}}}}
"""


def write_project(folder: Path) -> None:
    """Write the project."""
    (folder / "behaviors").mkdir(parents=True)
    (folder / "behaviors" / "cell.yaml").write_text(_CELL, encoding="utf-8")
    (folder / BEHAVIOR).write_text(_SHARED, encoding="utf-8")
