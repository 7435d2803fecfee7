"""An FR3 puts a part down and a UR10 takes it from there: two worlds, through libfranka, RTDE and Modbus."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest

from tests.behaviors.real_path.emulated_cell import (
    PATIENT_2F_85,
    PATIENT_FR3,
    PATIENT_HAND,
    PATIENT_WORLD,
    EmulatedCell,
    RealPath,
)
from tests.robots.drivers.franka.emulated_cabinet import needs_franka

TAKEN, PASSED, PUT = (-0.15, 0.25, 0.03), (0.0, -0.2, 0.03), (0.3, -0.5, 0.03)
ABOVE_M = 0.2
CELL = """\
flexcell: 1
cell: passed_part
world: {{kind: mujoco, {world}}}
robots:
  left:
    model: fr3
    base: {{xyz: [-0.55, 0.0, 0.0]}}
    driver: {{kind: franka, host: {host}, real_time: ignore, {fr3}}}
    gripper: {{model: panda_hand, driver: {{kind: franka_hand, host: {host}, {hand}}}}}
  right:
    model: ur10
    base: {{xyz: [1.0, 0.0, 0.0], rpy: [0, 0, 3.141592653589793]}}
    driver: {{kind: universal_robots, host: {host}, stale_s: 5.0, watchdog_hz: 1.0, process_silence_s: 10.0}}
    gripper:
      model: robotiq_2f85
      driver:
        {{kind: robotiq, connection: {{kind: modbus_tcp, host: {host}, port: 15020}}, {two_f}}}
fixtures:
  table: {{shape: box, size_m: [2.4, 1.6, 0.04], at: {{xyz: [0, 0, -0.02]}}}}
parts:
  cube:
    {{shape: box, size_m: [0.04, 0.04, 0.06], mass_kg: 0.1, at: {{xyz: [-0.15, 0.25, 0.03]}}, jitter: {{xy_m: 0.01}}}}
"""


@dataclass(frozen=True)
class PassedPart(RealPath):
    """The cell with both arms at one address, whose ports are not the same."""

    def write_cell(self, folder: Path, host: str) -> Path:
        """Write the cell."""
        file = folder / f"{self.cell}.yaml"
        patience = {"world": PATIENT_WORLD, "fr3": PATIENT_FR3, "hand": PATIENT_HAND, "two_f": PATIENT_2F_85}
        file.write_text(CELL.format(host=host, **patience), "utf-8")
        return file


def unchanged(text: str, host: str) -> str:
    """Return the text."""
    return text


def pose(point: tuple[float, float, float], above_m: float = 0.0) -> dict[str, object]:
    """Return the tool centre point straight down at a point of the cell."""
    x, y, z = point
    return {"xyz": [x, y, z + above_m], "xyzw": [1, 0, 0, 0], "frame": "world"}


def steps(robot: str, start: tuple[float, float, float], end: tuple[float, float, float]) -> Iterator[tuple[str, str]]:
    """Yield the steps of one arm, each with the outcome that leads on: take the part, put it down, go up."""

    def there(target: dict[str, object]) -> tuple[str, str]:
        return f"motion.MovePose, with: {json.dumps({'robot': robot, 'target': target, 'speed': 0.5})}", "reached"

    def straight(target: dict[str, object]) -> tuple[str, str]:
        line = {"robot": robot, "target": target, "speed_m_s": 0.15}
        return f"motion.MoveLinear, with: {json.dumps(line)}", "reached"

    def tool(state: str, outcome: str, **more: object) -> tuple[str, str]:
        return f"gripper.{state}, with: {json.dumps({'gripper': robot, **more})}", outcome

    yield tool("Open", "opened")
    yield there(pose(start, ABOVE_M))
    yield straight(pose(start))
    yield tool("Grasp", "held", part="cube", width_m=0.04, force_n=40)
    yield straight(pose(start, ABOVE_M))
    yield there(pose(end, ABOVE_M))
    yield straight(pose(end))
    yield tool("Open", "opened", part="cube")
    yield straight(pose(end, ABOVE_M))


def write_behavior(file: Path) -> None:
    """Write the behavior: first the FR3, which goes home, then the UR10."""
    home = '{"robot": "left", "target": [0.0, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785], "speed": 0.5}'
    whole = [
        *steps("left", TAKEN, PASSED),
        (f"motion.MoveJoints, with: {home}", "reached"),
        *steps("right", PASSED, PUT),
    ]
    lines = [
        f"      s{number}: {{state: {state}, transitions: {{{on}: {on_to}, {off}failed: failed}}}}"
        for number, (state, on) in enumerate(whole)
        for on_to in (f"s{number + 1}" if number + 1 < len(whole) else "finished",)
        for off in ("missed: failed, " if on == "held" else "",)
    ]
    head = "flexcell: 1\nname: passed_part\ncell: passed_part.yaml\noutcomes: [finished, failed]\n"
    file.write_text(
        head + "success: [finished]\nroot:\n  machine:\n    initial: s0\n    states:\n" + "\n".join(lines) + "\n",
        encoding="utf-8",
    )


@needs_franka
@pytest.mark.nightly
@pytest.mark.timeout(900)
def test_a_part_that_one_arm_puts_down_is_taken_by_an_arm_of_another_make(tmp_path: Path) -> None:
    behavior = tmp_path / "passed_part.behavior.yaml"
    write_behavior(behavior)
    path = PassedPart("An FR3 and a UR10", str(behavior), "passed_part", unchanged)
    with EmulatedCell(path, tmp_path, seed=1) as emulated:
        start = emulated.part("cube")
        assert start != pytest.approx(TAKEN, abs=0.001)
        run = emulated.run("--enable", "the emulated cell is clear", limit_s=800.0)
        assert (run.returncode, (run.stdout + run.stderr)[-3000:]) == (0, (run.stdout + run.stderr)[-3000:])
        assert emulated.part("cube") == pytest.approx(PUT, abs=0.015)
        assert emulated.tilt_rad("cube") == pytest.approx(0.0, abs=0.01)
        assert emulated.state()["touched"] == {"left": [], "right": []}
