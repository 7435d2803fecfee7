"""Inverse kinematics is loaded while a cell in real time already works; virtual time never waits for it."""

from __future__ import annotations

import subprocess
import sys
import threading
from pathlib import Path

import pytest

from engine.bus import GoalStatus
from engine.messages import Pose
from engine.skills.arm_control import ArmStatus
from engine.skills.motion import CartTrapVel
from robots.model.inverse_kinematics import InverseKinematicsSolver
from tests.robots.arm.served import MOVE, served

CELL = Path(__file__).parents[1] / "one_panda.yaml"
THERE = CartTrapVel(pose=Pose(xyz=(-0.15, 0.2, 0.3), xyzw=(1.0, 0.0, 0.0, 0.0)), speed=1.0)
WAITING = "waiting until inverse kinematics is loaded"
IN_VIRTUAL_TIME = f"""
import sys
from engine.cell.open_cell import OpenCell
from engine.clock import run_virtual
from engine.document.cell import load_cell
from engine.skills.collision_options import CollisionOptions
from engine.skills.motion import JointTrapVel

async def story():
    async with OpenCell(load_cell({str(CELL)!r})) as cell:
        goal = JointTrapVel(joints=(0.1, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785), speed=1.0,
                            collisions=CollisionOptions(avoid=False))
        return (await cell.bus.send_goal(goal, to="left").result()).status.value

wanted = ("robots.model.inverse_kinematics.kernels", "eaik", "robots.planning.timing.topp_ra_kernels")
print(run_virtual(story()), [name for name in wanted if name in sys.modules])
"""

PREPARED = """
import asyncio, sys
from engine.clock import new_clock
from robots.arm.execution.arm_planner import ArmPlanner
from tests.robots.panda_arm import panda_kinematics

wanted = ("robots.model.inverse_kinematics.kernels", "robots.planning.timing.topp_ra_kernels")

async def story():
    async def nothing(): ...
    before = [name in sys.modules for name in wanted]
    ArmPlanner(panda_kinematics(), clock=new_clock(), loaded=nothing).prepare()
    print(before, [name in sys.modules for name in wanted])

asyncio.run(story())
"""


class Gate:
    """Stands for a machine that loads slowly; `opened` lets it go on."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.opened = threading.Event()

        def prepare(_: InverseKinematicsSolver) -> None:
            assert self.opened.wait(60.0)

        monkeypatch.setattr(InverseKinematicsSolver, "prepare", prepare)


async def test_a_pose_waits_until_it_is_loaded_and_the_status_says_so_while_joints_move_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    gate = Gate(monkeypatch)
    async with served() as cell:
        joints = await cell.bus.send_goal(MOVE, to="left").result()
        with cell.bus.topic("left/status", ArmStatus).stream() as told:
            pose = cell.bus.send_goal(THERE, to="left")
            while (await told.next()).activity != WAITING:
                pass
            assert not gate.opened.is_set()
            gate.opened.set()
            while (await told.next()).activity != "cart_trap_vel":
                pass
        end = await pose.result()
    assert [joints.status, end.status] == [GoalStatus.SUCCEEDED] * 2


async def test_a_cell_that_closes_meanwhile_leaves_nothing_behind(monkeypatch: pytest.MonkeyPatch) -> None:
    """It closes when the thread is done."""
    gate = Gate(monkeypatch)
    async with served():
        threading.Timer(0.1, gate.opened.set).start()
    assert gate.opened.is_set()


async def test_a_load_that_does_not_end_fails_the_goal_by_name_and_lets_the_cell_close(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    gate = Gate(monkeypatch)
    monkeypatch.setattr("robots.arm.execution.warm_up.LOADING_LIMIT_S", 0.2)
    async with served() as cell:
        end = await cell.bus.send_goal(THERE, to="left").result()
        assert end.status is not GoalStatus.SUCCEEDED
        assert end.cause is not None
        assert any("was not loaded within 0.2 s" in link.message for link in end.cause.chain())
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED
    assert not gate.opened.is_set()
    gate.opened.set()


async def test_what_cannot_be_loaded_is_reported_by_the_goal_that_needs_it(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The arm itself works."""

    def broken(_: InverseKinematicsSolver) -> None:
        raise ImportError("no compiler")

    monkeypatch.setattr(InverseKinematicsSolver, "prepare", broken)
    async with served() as cell:
        assert await cell.status_of_next() is GoalStatus.SUCCEEDED
        await cell.bus.send_goal(THERE, to="left").result()
    assert "left: inverse kinematics cannot be loaded" in caplog.text


def test_joint_motions_that_are_not_checked_load_nothing_of_it_in_virtual_time() -> None:
    """The check of a path loads the planner."""
    done = subprocess.run([sys.executable, "-P", "-c", IN_VIRTUAL_TIME], capture_output=True, text=True, check=True)
    assert done.stdout == "succeeded []\n"


def test_what_poses_and_waypoints_need_is_compiled_when_the_arm_is_prepared() -> None:
    """In the middle of a motion, compiling would silence the engine."""
    done = subprocess.run([sys.executable, "-c", PREPARED], capture_output=True, text=True, check=False, timeout=120)
    assert done.stdout.strip() == "[False, False] [True, True]", done.stderr
