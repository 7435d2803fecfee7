"""The bus for people and other processes: by name, in JSON; what is wrong is refused before anything moves."""

from __future__ import annotations

import asyncio

import pytest

from engine.bus import ActiveGoal, GoalStatus, Holder, SkillBus
from engine.bus.json_bus import LocalJsonBus
from engine.clock import new_clock
from engine.errors import BusError, LeaseRefused, NoSuchSkill
from engine.messages import GripperState
from engine.skills.gripper import GraspResult, GripperFeedback, GripperMove, GripperOpen, ReadGripper

HELD = GraspResult(held=True, width_m=0.03, force_n=20.0)
STATE = GripperState(time_s=1.0, width_m=0.02, force_n=0.0, held=False)
PLAIN = {"time_s": 1.0, "width_m": 0.02, "force_n": 0.0, "held": False}
ONE = Holder("run-1", "root/a")


async def _work(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
    handle.accept()
    await asyncio.get_running_loop().create_future()
    return HELD


async def _move(goal: GripperMove, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
    handle.accept()
    return HELD


def _read(request: ReadGripper) -> GripperState:
    return STATE


def _buses() -> tuple[SkillBus, LocalJsonBus]:
    bus = SkillBus(new_clock())
    bus.advertise_action(GripperOpen, _work, namespace="left/gripper")
    bus.advertise_action(GripperMove, _move, namespace="left/gripper")
    bus.advertise_service(ReadGripper, _read, namespace="left/gripper", commands="left/gripper")
    return bus, LocalJsonBus(bus)


async def test_a_command_is_published_on_topics_that_take_commands_and_on_no_others() -> None:
    bus, people = _buses()
    taken: list[GripperState] = []
    bus.topic("left/state", GripperState).subscribe(taken.append)
    with pytest.raises(BusError, match=r"left/state: this topic takes no commands \(no topic of this bus takes"):
        await people.publish("left/state", PLAIN)
    for name in ("left/jog", "right/jog"):
        bus.topic(name, GripperState).subscribe_commands(taken.append)
    with pytest.raises(BusError, match="commands are taken on left/jog, right/jog"):
        await people.publish("left/state", PLAIN)
    with pytest.raises(BusError, match="left/jog: this is not a GripperState: `width_m`: expected number, got text"):
        await people.publish("left/jog", {**PLAIN, "width_m": "wide"})
    assert taken == []
    await people.publish("left/jog", PLAIN)
    assert taken == [STATE]


async def test_a_topic_is_echoed_from_its_latest_message_on() -> None:
    bus, people = _buses()
    topic = bus.topic("left/state", GripperState)
    topic.publish(STATE)
    echo = people.echo("left/state")
    assert '"width_m":0.02' in await anext(echo)
    following = asyncio.ensure_future(anext(echo))
    await asyncio.sleep(0)
    topic.publish(GripperState(time_s=2.0, width_m=0.05, force_n=0.0, held=False))
    assert '"width_m":0.05' in await following
    await echo.aclose()
    assert topic.subscriber_count == 0


async def test_services_are_called_and_actions_performed_and_not_the_other_way_round() -> None:
    bus, people = _buses()
    assert '"width_m":0.02' in await people.call("left/gripper/read_gripper", {})
    with pytest.raises(BusError, match="this is an action, not a service"):
        await people.call("left/gripper/gripper_open", {})
    with pytest.raises(BusError, match="this is a service, not an action"):
        await people.perform("left/gripper/read_gripper", {})
    with pytest.raises(BusError, match="this is not a GripperMove: "):
        await people.perform("left/gripper/gripper_move", {"width_m": "wide"})
    with pytest.raises(NoSuchSkill):
        await people.call("left/gripper/nothing", {})
    assert bus.leases.held() == ()


async def test_people_are_refused_what_a_run_commands() -> None:
    bus, people = _buses()
    bus.leases.acquire(("left",), ONE)
    with pytest.raises(LeaseRefused):
        await people.perform("left/gripper/gripper_move", {"width_m": 0.02})
    with pytest.raises(LeaseRefused):
        await people.call("left/gripper/read_gripper", {})


async def test_people_hold_an_arm_until_the_last_of_their_goals_has_ended() -> None:
    bus, people = _buses()
    long = people.send("left/gripper/gripper_open", {})
    end = await people.perform("left/gripper/gripper_move", {"width_m": 0.02})
    assert (end.status, end.result, bus.leases.owner("left")) == (GoalStatus.SUCCEEDED, HELD, "cli")
    waiting = asyncio.ensure_future(people.ended(long))
    await asyncio.sleep(0)
    waiting.cancel()
    with pytest.raises(asyncio.CancelledError):
        await waiting
    assert (long.status, bus.leases.held()) == (GoalStatus.CANCELED, ())


async def test_who_goes_away_gives_the_arm_back_only_when_it_is_at_rest() -> None:
    bus = SkillBus(new_clock())
    at_rest = asyncio.Event()

    async def stop_slowly(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        handle.on_cancel(lambda: None)
        await at_rest.wait()
        return HELD

    bus.advertise_action(GripperOpen, stop_slowly, namespace="left/gripper")
    people = LocalJsonBus(bus)
    performing = asyncio.ensure_future(people.perform("left/gripper/gripper_open", {}))
    await asyncio.sleep(0)
    performing.cancel()
    for _ in range(5):
        await asyncio.sleep(0)
    assert (performing.done(), bus.leases.owner("left")) == (False, "cli")
    at_rest.set()
    with pytest.raises(asyncio.CancelledError):
        await performing
    assert bus.leases.held() == ()
