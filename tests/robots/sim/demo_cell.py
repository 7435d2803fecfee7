"""The shipped demo cell in virtual time, and how its left arm picks the part before it."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path
from shutil import copy

from engine.bus import GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.document.cell import load_cell
from engine.messages import JointState, PartPoses, Pose
from engine.skills.gripper import GripperGrasp
from engine.skills.motion import CartLinTask, CartTrapVel

CELL = Path(__file__).parents[3] / "behaviors" / "cells" / "dual_panda.yaml"
DOWN = (1.0, 0.0, 0.0, 0.0)
PICK = Pose(xyz=(-0.11, 0.28, 0.028), xyzw=DOWN)
ABOVE_PICK = Pose(xyz=(-0.11, 0.28, 0.178), xyzw=DOWN)
LIFT = CartLinTask(pose=ABOVE_PICK, duration_s=1.0)


@asynccontextmanager
async def opened_cell(folder: Path, *, seed: int | None = None) -> AsyncGenerator[OpenCell]:
    """Open the demo cell with a store of its own."""
    async with OpenCell(load_cell(CELL), seed=seed, store_path=str(folder / "store.db")) as cell:
        yield cell


def patient_copy(folder: Path) -> Path:
    """Write the demo cell and its entries below `folder`, for tests in real time, and return the cell's file.

    A busy machine keeps processes waiting for longer than a robot may be left alone.
    """
    for kind in ("cells", "entries"):
        (folder / "behaviors" / kind).mkdir(parents=True, exist_ok=True)
        copy(CELL.parents[1] / kind / CELL.name, folder / "behaviors" / kind)
    file = folder / "behaviors" / "cells" / CELL.name
    hurried = "{kind: mujoco, step_s: 0.001}"
    text = file.read_text(encoding="utf-8")
    assert hurried in text
    patient = "{kind: mujoco, step_s: 0.001, engine_silence_s: 20, world_silence_s: 20}"
    file.write_text(text.replace(hurried, patient), encoding="utf-8")
    return file


async def pick(bus: SkillBus) -> None:
    """Close the left hand around the part; it is not lifted yet."""
    for goal in (CartTrapVel(pose=ABOVE_PICK, speed=0.5), CartLinTask(pose=PICK, duration_s=1.0)):
        end = await bus.send_goal(goal, to="left").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
    held = await bus.send_goal(GripperGrasp(width_m=0.03, force_n=30.0), to="left/gripper").result()
    assert held.result is not None
    assert held.result.held, held.result.reason


def joint_state(bus: SkillBus, arm: str = "left") -> JointState:
    """Return the measured joints of an arm."""
    state = bus.topic(f"{arm}/joint_state", JointState).latest
    assert state is not None
    return state


def speed_rad_s(bus: SkillBus, arm: str = "left") -> float:
    """Return the speed of an arm's fastest joint."""
    return max(abs(speed) for speed in joint_state(bus, arm).velocity_rad_s)


def part_height_m(bus: SkillBus) -> float:
    """Return how high the picked part is above the table."""
    parts = bus.topic("cell/parts", PartPoses).latest
    assert parts is not None
    return parts.poses["hca_north"].xyz[2]
