"""A goal that is idle gives way to the next one: its resource is free at once, its end is waited for."""

from __future__ import annotations

import asyncio

import pytest

from engine.bus import ActiveGoal, GoalStatus, Holder, SkillBus
from engine.bus.json_bus import CLI_HOLDER
from engine.clock import new_clock
from engine.errors import LeaseRefused
from engine.skills.gripper import GraspResult, GripperFeedback, GripperMove, GripperOpen

HELD = GraspResult(held=True, width_m=0.03, force_n=20.0)
RUN = Holder("run-1", "root/a")


class Device:
    """Idles until it is cancelled, and then takes until the test lets it rest."""

    def __init__(self, *, idle: bool) -> None:
        self.idle = idle
        self.may_rest = asyncio.Event()
        self.steps: list[str] = []

    async def open(self, goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        cancelled = asyncio.Event()
        handle.on_cancel(cancelled.set)
        handle.accept()
        handle.replaceable = self.idle
        await cancelled.wait()
        self.steps.append("brakes")
        await self.may_rest.wait()
        self.steps.append("rests")
        return HELD

    async def move(self, goal: GripperMove, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        self.steps.append("moves")
        return HELD


def served(device: Device) -> SkillBus:
    bus = SkillBus(new_clock())
    bus.advertise_action(GripperOpen, device.open, namespace="left", exclusive="left")
    bus.advertise_action(GripperMove, device.move, namespace="left", exclusive="left")
    return bus


@pytest.mark.parametrize("holder", [CLI_HOLDER, RUN])
async def test_an_idle_goal_of_a_person_ends_for_the_next_which_begins_when_it_rests(holder: Holder) -> None:
    device = Device(idle=True)
    async with served(device) as bus:
        idle = bus.send_goal(GripperOpen(), to="left", holder=CLI_HOLDER)
        await idle.accepted()
        following = bus.send_goal(GripperMove(width_m=0.02), to="left", holder=holder)
        assert bus.leases.owner("left") == holder.run
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        assert device.steps == ["brakes"]
        device.may_rest.set()
        assert (await following.result()).status is GoalStatus.SUCCEEDED
        assert (await idle.result()).status is GoalStatus.CANCELED
        assert device.steps == ["brakes", "rests", "moves"]
        assert bus.leases.owner("left") == holder.run


async def test_a_goal_that_is_not_idle_gives_way_to_nobody() -> None:
    device = Device(idle=False)
    async with served(device) as bus:
        busy = bus.send_goal(GripperOpen(), to="left", holder=CLI_HOLDER)
        await busy.accepted()
        refused = await bus.send_goal(GripperMove(width_m=0.02), to="left", holder=CLI_HOLDER).result()
        assert refused.status is GoalStatus.REJECTED
        with pytest.raises(LeaseRefused):
            bus.send_goal(GripperMove(width_m=0.02), to="left", holder=RUN)
        device.may_rest.set()


async def test_an_idle_goal_of_a_run_gives_way_within_its_run_only() -> None:
    """What a run has leased stays with it."""
    device = Device(idle=True)
    async with served(device) as bus:
        idle = bus.send_goal(GripperOpen(), to="left", holder=RUN)
        await idle.accepted()
        with pytest.raises(LeaseRefused):
            bus.send_goal(GripperMove(width_m=0.02), to="left", holder=CLI_HOLDER)
        assert not device.steps
        following = bus.send_goal(GripperMove(width_m=0.02), to="left", holder=RUN)
        device.may_rest.set()
        assert (await following.result()).status is GoalStatus.SUCCEEDED
