"""Every arm with its tool keeps the same contract: the same goals, the same outcomes, the same words."""

from __future__ import annotations

from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from engine.bus import GoalEnd, GoalHandle, SkillBus
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.messages import JointState, Pose, Quaternion, Vector3
from engine.skill import Action
from engine.skills.arm_control import ArmStatus, ReadArm
from engine.skills.contact import MoveUntilContact
from engine.skills.guiding import FinishGuiding, GuideArm
from engine.skills.jogging import JogJoints, StepJoints
from engine.skills.motion import CartLinTask, CartTrapVel, ForwardKinematics, JointTrapVel, PoseMatch
from robots.model.registry import robot_model

DOWN: Quaternion = (1.0, 0.0, 0.0, 0.0)
CELL = """flexcell: 1
cell: bench
world: {{kind: mujoco}}
robots:
  arm: {{model: {model}, gripper: {{model: {tool}}}}}
fixtures:
  table: {{shape: box, size_m: [0.3, 0.3, 0.05], at: {{xyz: [{x}, {y}, {z}]}}}}
"""
REST_RAD_S = 0.02


@dataclass(frozen=True, kw_only=True)
class ArmCase:
    """An arm with its tool, a place for the tool a hand's breadth above a table, and one higher up."""

    model: str
    tool: str
    above: Vector3
    higher: Vector3
    match: PoseMatch = "pose"
    table_below_m: float = 0.05

    def document(self) -> str:
        """The cell; the top of its table is `table_below_m` under the place."""
        x, y, z = self.above
        return CELL.format(model=self.model, tool=self.tool, x=x, y=y, z=z - self.table_below_m - 0.025)


BENCHES = (
    ArmCase(model="panda", tool="panda_hand", above=(0.5, 0.0, 0.3), higher=(0.5, 0.0, 0.35)),
    ArmCase(model="panda", tool="softhand", above=(0.5, 0.0, 0.3), higher=(0.5, 0.0, 0.35), table_below_m=0.15),
    ArmCase(model="ur10", tool="robotiq_2f85", above=(0.7, 0.2, 0.3), higher=(0.7, 0.2, 0.35)),
    ArmCase(model="irb4600", tool="magnet", above=(1.2, 0.3, 0.8), higher=(1.2, 0.3, 0.85)),
    # Its claw moves on a sphere: there is a position for every place on it, and no line.
    ArmCase(
        model="servo_arm",
        tool="servo_claw",
        above=(0.0, 0.225, 0.275),
        higher=(0.0, 0.2194, 0.325),
        match="position",
        table_below_m=0.15,
    ),
)


@dataclass(frozen=True)
class Driven:
    """The open cell with one arm in it."""

    cell: OpenCell

    @property
    def bus(self) -> SkillBus:
        """Its bus."""
        return self.cell.bus

    def joints(self) -> JointState:
        """What is measured."""
        state = self.bus.topic("arm/joint_state", JointState).latest
        assert state is not None
        return state

    def is_at_rest(self) -> bool:
        """Whether no joint moves."""
        return float(np.abs(self.joints().velocity_rad_s).max()) < REST_RAD_S

    async def status(self) -> ArmStatus:
        """What the arm says of itself."""
        return await self.bus.call(ReadArm(), to="arm")

    async def done(self, goal: Action[Any, Any]) -> GoalEnd[Any]:
        """Carry a goal out."""
        return await self.bus.send_goal(goal, to="arm").result()

    async def begun(self, goal: Action[Any, Any], *, after_s: float = 0.15) -> GoalHandle[Any, Any]:
        """Begin a goal, and be in the middle of it."""
        handle = self.bus.send_goal(goal, to="arm")
        await handle.accepted()
        await self.bus.clock.sleep(after_s)
        assert not self.is_at_rest()
        return handle


@asynccontextmanager
async def opened(bench: ArmCase, folder: Path) -> AsyncGenerator[Driven]:
    """The bench, in lockstep."""
    file = folder / "cell.yaml"
    file.write_text(bench.document(), encoding="utf-8")
    async with OpenCell(load_cell(file)) as cell:
        yield Driven(cell)


def words(end: GoalEnd[Any]) -> str:
    """How a goal ended and, where it did not succeed, why in the device's own words."""
    if end.cause is None:
        return end.status.value
    return f"{end.status.value}: {list(end.cause.chain())[-1].message}"


async def driven_through(arm: Driven, bench: ArmCase) -> dict[str, str]:
    """Everything that an arm can be told, one after the other, and how each of it ended."""
    model = robot_model(bench.model, gripper=bench.tool)
    home = np.array(model.home_rad)
    turn = np.zeros(model.dof)
    turn[0], turn[-1] = 0.4, 0.3
    aside = JointTrapVel(joints=tuple((home + turn).tolist()), speed=0.2)
    back = JointTrapVel(joints=model.home_rad, speed=0.5)
    above, higher = Pose(xyz=bench.above, xyzw=DOWN), Pose(xyz=bench.higher, xyzw=DOWN)
    said: dict[str, str] = {}

    said["joints"] = words(await arm.done(aside))
    said["there"] = str(bool(np.allclose(arm.joints().position_rad, aside.joints, atol=0.01)))
    said["pose"] = words(await arm.done(CartTrapVel(pose=above, speed=0.3, match=bench.match)))
    reached = await arm.bus.call(ForwardKinematics(), to="arm")
    said["at the pose"] = str(bool(np.allclose(reached.xyz, above.xyz, atol=0.004)))
    said["line"] = words(await arm.done(CartLinTask(pose=higher, duration_s=1.0)))
    said["contact"] = words(
        end := await arm.done(MoveUntilContact(direction=(0.0, 0.0, -1.0), distance_m=0.2, speed_m_s=0.05, force_n=8.0))
    )
    said["touched"] = str(end.result is not None and end.result.contact)
    said["away"] = words(await arm.done(CartTrapVel(pose=higher, speed=0.3, match=bench.match)))

    guiding = arm.bus.send_goal(GuideArm(damping=0.5), to="arm")
    await arm.bus.clock.sleep(0.3)
    said["guiding"] = (await arm.status()).mode
    await arm.bus.call(FinishGuiding(), to="arm")
    said["guided"] = words(await guiding.result())
    said["home"] = words(await arm.done(back))

    held = await arm.begun(aside)
    await held.hold()
    said["held"] = f"{held.status.value}, {'at rest' if arm.is_at_rest() else 'moving'}"
    await held.resume()
    said["resumed"] = words(await held.result())
    cancelled = await arm.begun(back)
    cancelled.cancel()
    said["cancelled"] = f"{words(await cancelled.result())}, {'at rest' if arm.is_at_rest() else 'moving'}"
    stopped = await arm.begun(back)
    await arm.cell.robots["arm"].stop()
    said["stopped"] = f"{words(await stopped.result())}, {'at rest' if arm.is_at_rest() else 'moving'}"
    said["next"] = words(await arm.done(back))

    said["jogged"] = words(await arm.done(JogJoints(velocity_rad_s=tuple(turn.tolist()), duration_s=0.3)))
    said["stepped"] = words(await arm.done(StepJoints(step_rad=tuple((0.1 * turn).tolist()), speed=0.3)))
    far = await arm.done(CartTrapVel(pose=Pose(xyz=(9.0, 0.0, 0.0), xyzw=DOWN), speed=0.3, match=bench.match))
    said["far"] = words(far)[: len("rejected: (9.000, 0.000, 0.000) is out of reach by ")]
    said["too many"] = words(await arm.done(JointTrapVel(joints=(0.0,) * 9, speed=0.3)))
    said["idle"] = f"{(await arm.status()).mode} {(await arm.status()).error}"
    return said


NO_LINE = (
    "rejected: an arm of 2 joints cannot keep position and orientation of its tool on this line beyond 0% of it"
    " (move in joint space, or to the end by position only (`match`))"
)


def expected(dof: int) -> dict[str, str]:
    """What every arm answers; one of two joints keeps to no line."""
    other = {"line": NO_LINE, "contact": NO_LINE, "touched": "False"} if dof < 6 else {}
    return {
        "joints": "succeeded",
        "there": "True",
        "pose": "succeeded",
        "at the pose": "True",
        "line": "succeeded",
        "contact": "succeeded",
        "touched": "True",
        "away": "succeeded",
        "guiding": "guiding",
        "guided": "succeeded",
        "home": "succeeded",
        "held": "held, at rest",
        "resumed": "succeeded",
        "cancelled": "canceled, at rest",
        "stopped": "aborted: the arm was stopped by another command, at rest",
        "next": "succeeded",
        "jogged": "succeeded",
        "stepped": "succeeded",
        "far": "rejected: (9.000, 0.000, 0.000) is out of reach by ",
        "too many": f"rejected: the goal has 9 joints (this arm has {dof})",
        "idle": "idle ",
        **other,
    }


@pytest.mark.parametrize("bench", BENCHES, ids=lambda bench: f"{bench.model}-{bench.tool}")
def test_it_does_what_every_arm_does_and_says_what_every_arm_says(tmp_path: Path, bench: ArmCase) -> None:
    async def scenario() -> dict[str, str]:
        async with opened(bench, tmp_path) as arm:
            return await driven_through(arm, bench)

    dof = robot_model(bench.model).dof
    assert run_virtual(scenario()) == expected(dof)
