"""A world that was lost comes back in a new process: same names, same place, same settings, at rest."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import msgspec
import numpy as np
import pytest

from engine.bus import GoalStatus, SkillBus
from engine.cell.open_cell import OpenCell
from engine.clock import new_clock
from engine.document.cell import load_cell
from engine.errors import RobotError
from engine.messages import JointState
from engine.robot import DeviceStatus
from engine.skills.arm_control import ArmStatus, SetSpeedOverride
from engine.skills.motion import JointTrapVel
from robots.port import Array, MotionEnd, Tolerance
from robots.sim.host.lockstep_host import LockstepHost
from robots.sim.host.process_host import ProcessHost
from robots.sim.host.world_host import WorldListener
from robots.sim.world.sim_world import SimWorld
from tests.robots.sim.sim_cell import HOME, box, grasp, move, one_arm, part_xyz, smooth, until

WHY = "the world's process was ended by SIGKILL"
SERVO_CELL = Path(__file__).parents[4] / "behaviors" / "cells" / "servo_arm.yaml"


class MortalHost(LockstepHost):
    """A world that can be lost, in virtual time."""

    def __init__(self) -> None:
        super().__init__(one_arm(box("part")))
        self.opened = 0
        self.is_damaged = False
        self._heard_by: WorldListener | None = None

    async def open(self, listener: WorldListener) -> None:
        await super().open(listener)
        self.opened += 1
        self._heard_by = listener

    def image(self) -> Array:
        return np.full_like(super().image(), np.nan) if self.is_damaged else super().image()

    def die(self) -> None:
        """Be lost."""
        assert self._heard_by is not None
        self._heard_by.lost(WHY)


@pytest.mark.virtual
async def test_arm_part_grip_and_settings_are_where_they_were() -> None:
    host = MortalHost()
    async with SimWorld(one_arm(box("part")), host=host) as world:
        await grasp(world)
        arm = world.arm("left")
        arm.configure(msgspec.structs.replace(arm.settings, speed_override=0.5))
        there, part = arm.sample().position_rad.copy(), part_xyz(world, "part")
        motion = arm.follow(smooth(np.asarray(arm.sample().desired_rad), HOME, 20.0), tolerance=Tolerance())
        host.die()
        assert (await motion.report()).reason == WHY
        assert (world.status, world.lost_reason) == (DeviceStatus.FAULT, WHY)
        with pytest.raises(RobotError, match="SIGKILL"):
            arm.follow(smooth(there, HOME, 20.0), tolerance=Tolerance())
        assert await world.reconnect() == ""
        assert (world.status, world.lost_reason, host.opened) == (DeviceStatus.READY, "", 2)
        assert arm.settings.speed_override == 0.5
        assert np.abs(arm.sample().position_rad - there).max() < 1e-3
        assert part_xyz(world, "part") == pytest.approx(part, abs=1e-3)
        assert (await move(arm, HOME, 2.0)).end is MotionEnd.REACHED
        assert part_xyz(world, "part")[2] > 0.2


@pytest.mark.virtual
async def test_a_world_whose_last_instant_is_damaged_begins_anew_and_says_so() -> None:
    host = MortalHost()
    async with SimWorld(one_arm(box("part")), host=host) as world:
        assert (await move(world.arm("left"), HOME + 0.1, 0.5)).end is MotionEnd.REACHED
        host.is_damaged = True
        host.die()
        note = await world.reconnect()
        host.is_damaged = False
        assert note.startswith("the world was restarted in the initial state of the cell document")
        assert np.abs(world.arm("left").sample().position_rad - HOME).max() < 1e-4
        assert (await move(world.arm("left"), HOME + 0.1, 0.5)).end is MotionEnd.REACHED


@pytest.mark.virtual
async def test_a_world_that_is_not_lost_is_left_alone() -> None:
    host = MortalHost()
    async with SimWorld(one_arm(box("part")), host=host) as world:
        assert (await world.reconnect(), host.opened) == ("", 1)


async def test_a_world_that_is_killed_again_while_it_comes_back_is_still_lost_and_comes_back_the_next_time() -> None:
    host = ProcessHost(one_arm())
    async with SimWorld(one_arm(), host=host) as world:
        world.register(SkillBus(new_clock()))
        assert (await move(world.arm("left"), HOME + 0.05, 0.3)).end is MotionEnd.REACHED
        await _kill(host, world)
        there = world.arm("left").sample().position_rad.copy()
        first = host.pid
        await world.reconnect()
        assert host.pid != first
        assert np.abs(world.arm("left").sample().position_rad - there).max() < 1e-3
        await _kill(host, world)
        await world.reconnect()
        assert (await move(world.arm("left"), HOME, 0.3)).end is MotionEnd.REACHED


async def _kill(host: ProcessHost, world: SimWorld) -> None:
    os.kill(host.pid, signal.SIGKILL)
    await until(lambda: world.status is DeviceStatus.FAULT)


async def test_the_skills_of_a_cell_go_on_working_with_the_new_process(tmp_path: Path) -> None:
    """Goals, topics, settings and the status of the arm, all under the same names."""
    patient = SERVO_CELL.read_text(encoding="utf-8").replace(
        "{kind: mujoco, step_s: 0.001}", "{kind: mujoco, engine_silence_s: 20, world_silence_s: 20}"
    )
    file = tmp_path / "cell.yaml"
    file.write_text(patient.replace("seed: ../entries/servo_arm.yaml", "seed: entries.yaml"), encoding="utf-8")
    entries = SERVO_CELL.parents[1] / "entries" / "servo_arm.yaml"
    (tmp_path / "entries.yaml").write_bytes(entries.read_bytes())
    async with OpenCell(load_cell(file), store_path=str(tmp_path / "store.db")) as cell:
        world, bus = cell.world, cell.bus
        assert isinstance(world, SimWorld)
        assert isinstance(world.host, ProcessHost)
        await bus.call(SetSpeedOverride(share=0.5), to="arm")
        start = _joints(bus)
        goal = bus.send_goal(JointTrapVel(joints=(start[0] + 0.6, start[1]), speed=0.05), to="arm")
        await until(lambda: abs(_joints(bus)[0] - start[0]) > 0.02)
        os.kill(world.host.pid, signal.SIGKILL)
        end = await goal.result()
        assert end.status is GoalStatus.ABORTED
        status = bus.topic("arm/status", ArmStatus).latest
        assert status is not None
        assert (status.mode, WHY in status.error) == ("fault", True)
        refused = await bus.send_goal(JointTrapVel(joints=start, speed=0.5), to="arm").result()
        assert refused.status is GoalStatus.REJECTED
        there = _joints(bus)
        await cell.reconnect()
        assert _joints(bus) == pytest.approx(there, abs=0.02)
        status = bus.topic("arm/status", ArmStatus).latest
        assert status is not None
        assert (status.mode, status.error, status.settings.speed_override) == ("idle", "", 0.5)
        end = await bus.send_goal(JointTrapVel(joints=start, speed=0.5), to="arm").result()
        assert end.status is GoalStatus.SUCCEEDED, end.cause
        assert _joints(bus) == pytest.approx(start, abs=0.02)


def _joints(bus: SkillBus) -> tuple[float, ...]:
    state = bus.topic("arm/joint_state", JointState).latest
    assert state is not None
    return state.position_rad
