"""The skills of an arm whose world runs in a process of its own, in real time."""

from __future__ import annotations

import dataclasses
from contextlib import AsyncExitStack

import numpy as np
from msgspec.structs import replace

from engine.bus import GoalStatus, SkillBus
from engine.clock import new_clock
from engine.document.cell import Cell, MujocoWorld, load_cell
from engine.skills.arm_control import ArmStatus, RecoverFromError, SetCollisionBehavior, SetSpeedOverride
from engine.skills.direct_control import JointCommand, SwitchDirectControl
from engine.skills.guiding import FinishGuiding, GuideArm
from engine.skills.jogging import JogJoints
from engine.skills.simulated_world import PushBody
from robots.simulated_cell import new_world
from tests.robots.arm.simulated import CELL, Simulated
from tests.robots.panda_arm import home
from tests.robots.sim.sim_cell import PATIENT_S

PUSH = PushBody(body="left/panda_hand", force_n=(0.0, 60.0, 0.0), duration_s=0.3)


def patient_cell() -> Cell:
    """Return the cell of one arm, which forgives an engine that starves beside planners that start."""
    loaded = load_cell(CELL)
    world = loaded.document.world
    assert isinstance(world, MujocoWorld)
    patient = replace(world, engine_silence_s=PATIENT_S, world_silence_s=PATIENT_S)
    return dataclasses.replace(loaded, document=replace(loaded.document, world=patient))


async def test_direct_control_jogging_guiding_reflex_and_recovery_follow_one_another() -> None:
    """Everything that crosses the border to the other process, once; the status names each."""
    async with AsyncExitStack() as stack:
        bus = await stack.enter_async_context(SkillBus(new_clock()))
        world = await stack.enter_async_context(new_world(patient_cell(), bus=bus, virtual=False, seed=None))
        world.register(bus)
        for robot in world.robots():
            await stack.enter_async_context(robot)
            robot.register(bus)
        cell = Simulated(bus, world)
        modes: list[str] = []
        bus.topic("left/status", ArmStatus).subscribe(lambda status: modes.append(status.mode))

        await bus.call(SetSpeedOverride(share=1.0), to="left")
        assert (await bus.call(SwitchDirectControl(on=True, watchdog_s=2.0), to="left")).success
        turned = home()
        turned[0] += 0.1

        def turning() -> bool:
            bus.topic("left/direct_joints", JointCommand).publish(JointCommand(position_rad=tuple(turned.tolist())))
            return bool(cell.joints()[0] - home()[0] > 0.03)

        await cell.until(turning, within_s=30.0)
        assert (await bus.call(SwitchDirectControl(on=False), to="left")).success
        assert cell.joints()[0] - home()[0] > 0.03

        jogged = await cell.perform(JogJoints(velocity_rad_s=(-0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), duration_s=0.3))
        guiding = await cell.begun(GuideArm(), after_s=0.0)
        await cell.until(lambda: modes[-1] == "guiding", within_s=30.0)
        await bus.call(FinishGuiding(), to="left")
        guided = await guiding.result()

        await bus.call(SetCollisionBehavior(force_n=20.0), to="left")
        with bus.topic("left/status", ArmStatus).stream() as told:
            await bus.call(PUSH, to="cell")
            while (status := await told.next()).mode != "reflex":
                pass
        assert "external force limit exceeded" in status.error
        # The hand is gone when nothing is felt any more.
        await cell.until(lambda: float(np.abs(cell.port.sample().wrench).max()) < 1.0, within_s=30.0)
        status = await bus.call(RecoverFromError(), to="left")
        after = await cell.perform(JogJoints(velocity_rad_s=(0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), duration_s=0.2))
    ends = [jogged.status, guided.status, after.status]
    assert ends == [GoalStatus.SUCCEEDED] * 3, (jogged.cause, guided.cause, after.cause)
    assert status.mode == "idle"
    assert [mode for n, mode in enumerate(modes) if n == 0 or modes[n - 1] != mode] == [
        *("direct", "idle", "jogging", "idle", "guiding", "idle", "reflex", "idle", "jogging", "idle", "disconnected")
    ]
