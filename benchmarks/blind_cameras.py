"""Cameras that fail beside a moving arm: `blind_cameras.py [--trials N]`.

Both cameras of a cell are covered, dark, frozen, late or displaced; then a person's hand goes where the arm is about to
pass, and the arm is told to move. Counted are contacts of the arm with the person, trials in which a camera was
named with its condition, and motions that reached their goal. Virtual time. Run it with `python -P`.
"""

from __future__ import annotations

import argparse
import asyncio
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from engine.bus import GoalStatus
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.messages.sensing import CameraStatus, OccupancyGrid
from engine.skills.motion import JointTrapVel
from engine.skills.people import CountContacts, Reach
from engine.skills.planning import Adaptation, MotionTarget, MoveFree, PlanOptions
from engine.skills.simulated_world import CameraFault, CameraFaultKind, SetCameraFault

KINDS: tuple[CameraFaultKind, ...] = ("none", "covered", "dark", "frozen", "late", "displaced")
CAMERAS = ("front", "side")
THERE = (0.8, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8)
ACROSS = (-0.8, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8)
_CELL = """
flexcell: 1
cell: blind
world: {kind: mujoco}
robots:
  left: {model: panda, base: {xyz: [-0.55, 0, 0]}, gripper: {model: panda_hand}}
fixtures:
  table: {shape: box, size_m: [1.6, 1.2, 0.04], at: {xyz: [0, 0, -0.02]}}
cameras:
  front: {at: [1.3, 0.6, 1.2], look_at: [0, 0, 0.3], size_px: [160, 120], rate_hz: 15, noise_m: 0.001}
  side: {at: [0.3, -1.4, 1.2], look_at: [0, 0, 0.3], size_px: [160, 120], rate_hz: 15}
occupancy:
  center_m: [0, 0, 0.55]
  size_m: [1.2, 1.6, 1.0]
  must_cover: {bench: {center_m: [0.05, 0, 0.5], size_m: [0.7, 1.0, 0.8]}}
people:
  anna: {shoulder: [0.3, -0.2, 0.8], hand_rests: [0.6, 0.3, 0.5]}
"""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """How one trial ended."""

    touched: bool
    conditions: tuple[str, ...]
    status: GoalStatus


def random_fault(kind: CameraFaultKind, random: np.random.Generator) -> CameraFault:
    """Return a fault of a kind with drawn size."""
    away = random.normal(size=3)
    x, y, z = (random.uniform(0.15, 0.4) * away / np.linalg.norm(away)).tolist()
    tilt = float(random.choice((-1.0, 1.0)) * random.uniform(0.1, 0.3))
    return CameraFault(
        kind=kind,
        cover_m=float(random.uniform(0.05, 0.35)),
        delay_s=float(random.uniform(0.5, 3.0)),
        offset_m=(x, y, z),
        turn_rad=(tilt, 0.0, 0.0),
    )


async def _trial(folder: Path, kind: CameraFaultKind, seed: int) -> Trial:
    random = np.random.default_rng(seed)
    file = folder / "blind.yaml"
    # Equal images of a camera without noise are suspicious only once the arm moves.
    file.write_text(_CELL if seed % 2 else _CELL.replace(", noise_m: 0.001", ""), encoding="utf-8")
    async with OpenCell(load_cell(file), seed=seed) as cell:
        bus = cell.bus
        bus.topic("cell/occupancy", OccupancyGrid).subscribe(lambda _: None)
        await bus.send_goal(JointTrapVel(joints=THERE, speed=0.5), to="left").result()
        for camera in CAMERAS:
            await bus.call(SetCameraFault(camera=camera, fault=random_fault(kind, random)), to="cell")
        await asyncio.sleep(float(random.uniform(0.0, 0.5)))
        hand = tuple(float(v) for v in np.array((-0.03, 0.05, 0.5)) + random.uniform(-0.06, 0.06, 3))
        await bus.call(Reach(person="anna", hand_m=(hand[0], hand[1], hand[2]), speed_m_s=1.0), to="cell")
        await asyncio.sleep(float(random.uniform(0.0, 1.0)))
        goal = MoveFree(
            target=MotionTarget(joints=ACROSS), options=PlanOptions(speed=0.3), adaptation=Adaptation(patience_s=1.0)
        )
        end = await bus.send_goal(goal, to="left").result()
        contacts = await bus.call(CountContacts(person="anna"), to="cell")
        statuses = [bus.topic(f"{camera}/status", CameraStatus).latest for camera in CAMERAS]
    return Trial(
        touched=contacts.contacts > 0,
        conditions=tuple(one.condition for one in statuses if one is not None),
        status=end.status,
    )


def trial(kind: CameraFaultKind, seed: int) -> Trial:
    """Run one trial."""
    with tempfile.TemporaryDirectory() as folder:
        return run_virtual(_trial(Path(folder), kind, seed))


def row(kind: CameraFaultKind, trials: Sequence[Trial]) -> str:
    """Return the counts of a kind."""
    expected = "healthy" if kind == "none" else kind
    touched = sum(one.touched for one in trials)
    named = sum(expected in one.conditions for one in trials)
    moved = sum(one.status is GoalStatus.SUCCEEDED for one in trials)
    return f"| {kind} | {len(trials)} | {touched} | {named} | {moved} |"


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=100)
    parser.add_argument("--kinds", nargs="*", choices=KINDS, default=KINDS)
    options = parser.parse_args(arguments)
    print(
        "| fault | trials | with contact | with a camera so named | motions at their goal |\n|---|---:|---:|---:|---:|"
    )
    for kind in options.kinds:
        print(row(kind, [trial(kind, seed) for seed in range(options.trials)]), flush=True)


if __name__ == "__main__":
    main()
