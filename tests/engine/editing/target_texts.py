"""A cell with one arm and a post, and a behavior that takes the arm somewhere, for tests of targets."""

from __future__ import annotations

from pathlib import Path

ID = "behaviors/reach.yaml"
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda, gripper: {model: panda_hand}, base: {xyz: [0, 0, 0]}}
fixtures:
  post: {shape: box, size_m: [0.1, 0.1, 0.5], at: {xyz: [0.5, 0.0, 0.25]}}
"""
REACH = """\
flexcell: 1
name: reach
cell: bench.yaml
outcomes: [good]
success: [good]
root:
  machine:
    initial: go
    states:
      go:
        state: motion.MovePose
        with: {robot: left, target: {xyz: [0.3, 0.0, 0.5], xyzw: [1, 0, 0, 0], frame: world}}
        transitions: {reached: good, failed: good}
"""
FAR = REACH.replace("0.3, 0.0, 0.5", "2.0, 0.0, 0.5")
IN_POST = REACH.replace("0.3, 0.0, 0.5", "0.5, 0.0, 0.3")


def written(project: Path, text: str = REACH) -> Path:
    """Write cell and behavior; return the file of the behavior."""
    (project / "behaviors").mkdir(exist_ok=True)
    (project / "behaviors" / "bench.yaml").write_text(CELL, encoding="utf-8")
    (project / ID).write_text(text, encoding="utf-8")
    return project / ID
