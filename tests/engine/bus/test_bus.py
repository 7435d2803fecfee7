"""The bus as a whole: whose goals are ended, who holds an arm meanwhile, what can be found by its name."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

import pytest

from engine.bus import ActiveGoal, GoalStatus, Holder, SkillBus, Topic
from engine.bus.lease import Lease
from engine.clock import new_clock, run_virtual
from engine.errors import BusError, LeaseRefused, NoSuchSkill, SkillFailed
from engine.messages import GripperState, PartPoses
from engine.skills.gripper import GraspResult, GripperFeedback, GripperMove, GripperOpen, ReadGripper

STATE = GripperState(time_s=1.0, width_m=0.02, force_n=0.0, held=False)
HELD = GraspResult(held=True, width_m=0.03, force_n=20.0)
ONE = Holder("run-1", "root/a")
TWO = Holder("run-2", "root/b")


async def _work(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
    handle.accept()
    await asyncio.get_running_loop().create_future()
    return HELD


async def _move(goal: GripperMove, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
    handle.accept()
    return HELD


def _bus() -> SkillBus:
    bus = SkillBus(new_clock())
    for arm in ("left", "right"):
        bus.advertise_action(GripperOpen, _work, namespace=f"{arm}/gripper")
        bus.advertise_action(GripperMove, _move, namespace=f"{arm}/gripper")
    return bus


async def test_the_goals_of_one_run_are_ended_and_those_of_another_go_on() -> None:
    async with _bus() as bus:
        one = bus.send_goal(GripperOpen(), to="left/gripper", holder=ONE)
        two = bus.send_goal(GripperOpen(), to="right/gripper", holder=TWO)
        await one.accepted()
        await two.accepted()
        assert (bus.goals("run-1"), bus.goals()) == ((one,), (one, two))
        await bus.cancel_goals("nobody's run")
        await bus.cancel_goals("run-1")
        assert (one.finished, one.status) == (True, GoalStatus.CANCELED)
        assert (two.finished, two.status, bus.goals()) == (False, GoalStatus.ACTIVE, (two,))


async def test_a_goal_is_known_by_the_id_of_its_sender_or_by_its_number() -> None:
    async with _bus() as bus:
        first = bus.send_goal(GripperOpen(), to="left/gripper", holder=ONE)
        second = bus.send_goal(GripperMove(width_m=0.02), to="left/gripper", holder=ONE, goal_id="mine")
        third = bus.send_goal(GripperOpen(), to="right/gripper", holder=TWO)
        assert [handle.id for handle in (first, second, third)] == ["g1", "mine", "g3"]
        assert (second.address, second.holder, second.holder_run) == ("left/gripper/gripper_move", ONE, "run-1")


async def test_who_belongs_to_no_run_holds_an_arm_until_the_last_of_their_goals_has_ended() -> None:
    async with _bus() as bus:
        long = bus.send_goal(GripperOpen(), to="left/gripper")
        await bus.send_goal(GripperMove(width_m=0.02), to="left/gripper").result()
        with pytest.raises(LeaseRefused, match="left/gripper is commanded by run nobody"):
            bus.send_goal(GripperMove(width_m=0.02), to="left/gripper", holder=ONE)
        long.cancel()
        await long.result()
        assert bus.leases.held() == ()
        end = await bus.send_goal(GripperMove(width_m=0.02), to="left/gripper", holder=ONE).result()
        assert end.status is GoalStatus.SUCCEEDED


async def test_after_a_goal_its_branch_holds_nothing_and_its_run_still_the_arm() -> None:
    bus = _bus()
    await bus.send_goal(GripperMove(width_m=0.02), to="left/gripper", holder=ONE).result()
    assert [(lease.resource, lease.run, lease.branch) for lease in bus.leases.held()] == [("left", "run-1", "")]


async def test_a_goal_that_nobody_serves_leases_nothing() -> None:
    bus = SkillBus(new_clock())
    with pytest.raises(NoSuchSkill, match="left/gripper/gripper_open: no such service"):
        bus.send_goal(GripperOpen(), to="left/gripper", holder=ONE)
    assert bus.leases.held() == tuple[Lease]()


async def test_an_address_is_served_once() -> None:
    """As a service or as an action; the one that was first answers."""
    bus = _bus()
    with pytest.raises(BusError, match="left/gripper/gripper_open: this address is already served"):
        bus.advertise_action(GripperOpen, _work, namespace="left/gripper")
    state = GripperState(time_s=1.0, width_m=0.02, force_n=0.0, held=False)

    def read(request: ReadGripper) -> GripperState:
        return state

    async def read_later(request: ReadGripper) -> GripperState:
        return state

    bus.advertise_service(ReadGripper, read, namespace="left/gripper")
    with pytest.raises(BusError, match="already served"):
        bus.advertise_service(ReadGripper, read, namespace="left/gripper")
    bus.advertise_service(ReadGripper, read_later, namespace="right/gripper")
    assert await bus.call(ReadGripper(), to="right/gripper") == state


async def test_what_is_served_is_found_by_its_address() -> None:
    bus = _bus()
    assert bus.request_type("left/gripper/gripper_move") is GripperMove
    assert list(bus.skills()) == [
        "left/gripper/gripper_open",
        "left/gripper/gripper_move",
        "right/gripper/gripper_open",
        "right/gripper/gripper_move",
    ]
    with pytest.raises(NoSuchSkill, match="did you mean left/gripper/gripper_move"):
        bus.request_type("left/gripper/gripper_mov")


async def test_a_service_that_refuses_in_its_own_words_is_not_reworded() -> None:
    bus = SkillBus(new_clock())

    def refuse(request: ReadGripper) -> GripperState:
        raise LeaseRefused("the gripper is being changed", where="left/gripper")

    bus.advertise_service(ReadGripper, refuse, namespace="left/gripper")
    with pytest.raises(LeaseRefused, match="the gripper is being changed"):
        await bus.call(ReadGripper(), to="left/gripper")


async def test_who_watches_topics_is_notified_of_each_once_until_they_stop() -> None:
    bus, names, others = SkillBus(new_clock()), list[str](), list[str]()
    bus.topic("a", GripperState)

    def watching(seen: list[str]) -> Callable[[Topic[Any]], None]:
        return lambda topic: seen.append(topic.name)

    stop = bus.watch_topics(watching(names))
    bus.watch_topics(watching(others))
    bus.topic("b", PartPoses)
    bus.topic("b", PartPoses)
    stop()
    bus.topic("c", PartPoses)
    assert (names, others) == (["a", "b"], ["a", "b", "c"])
    assert [topic.name for topic in bus.topics()] == ["a", "b", "c"]


async def test_a_topic_that_is_only_looked_for_is_not_made() -> None:
    bus = SkillBus(new_clock())
    topic = bus.topic("left/gripper/state", GripperState)
    assert bus.find_topic("left/gripper/state") is topic
    with pytest.raises(BusError, match=r"left/gripper/stat: no such topic .*did you mean left/gripper/state"):
        bus.find_topic("left/gripper/stat")
    assert bus.topics() == (topic,)


async def test_topics_that_take_commands_are_listed_with_who_listens() -> None:
    bus = SkillBus(new_clock())
    for name in ("right/jog", "left/jog"):
        bus.topic(name, PartPoses).subscribe_commands(lambda _: None)
    bus.topic("left/state", GripperState).subscribe_passively(lambda _: None)
    assert bus.command_topics() == ("left/jog", "right/jog")
    assert [(row.name, row.type, row.detail) for row in bus.listing()] == [
        ("left/jog", "PartPoses", "0.0 Hz, 1 subscribers, takes commands"),
        ("left/state", "GripperState", "0.0 Hz, 0 subscribers"),
        ("right/jog", "PartPoses", "0.0 Hz, 1 subscribers, takes commands"),
    ]


async def test_the_listing_names_who_keeps_an_action_busy() -> None:
    async with _bus() as bus:
        await bus.send_goal(GripperOpen(), to="left/gripper", holder=ONE).accepted()
        details = {row.name: row.detail for row in bus.listing() if row.kind == "action"}
        assert details == {
            "left/gripper/gripper_open": "busy with left/gripper/gripper_open of run run-1 at root/a",
            "left/gripper/gripper_move": "",
            "right/gripper/gripper_open": "",
            "right/gripper/gripper_move": "",
        }


async def test_another_thread_has_its_work_done_on_the_loop() -> None:
    bus, done = SkillBus(new_clock()), asyncio.Event()
    await asyncio.to_thread(bus.post, done.set)
    await asyncio.wait_for(done.wait(), timeout=30.0)


async def test_what_is_withdrawn_is_found_no_more_and_its_neighbours_are() -> None:
    """A device that is replaced takes its own skills along, not those of one whose name begins alike."""
    bus = _bus()
    bus.advertise_action(GripperOpen, _work, namespace="left/gripper_two")
    bus.withdraw("left/gripper")
    assert list(bus.skills()) == [
        "right/gripper/gripper_open",
        "right/gripper/gripper_move",
        "left/gripper_two/gripper_open",
    ]


class TestTheTimeOfServices:
    """A service that hangs is a failure with its name where the cell limits the time; without, it may take its time."""

    async def _answer(self, after_s: float, *, limit_s: float | None) -> object:
        async def read(_request: ReadGripper) -> GripperState:
            await asyncio.sleep(after_s)
            return STATE

        async with SkillBus(new_clock(), service_timeout_s=limit_s) as bus:
            bus.advertise_service(ReadGripper, read, namespace="left/gripper")
            return await bus.call(ReadGripper(), to="left/gripper")

    @pytest.mark.parametrize("limit_s", [None, 5.0])
    def test_one_that_answers_in_time_is_not_hurried(self, limit_s: float | None) -> None:
        assert run_virtual(self._answer(4.9, limit_s=limit_s)) == STATE

    def test_one_that_takes_longer_has_failed(self) -> None:
        with pytest.raises(SkillFailed) as failure:
            run_virtual(self._answer(1e6, limit_s=5.0))
        assert failure.value.where == "left/gripper/read_gripper"
        assert "has not answered within 5 s" in str(failure.value)
        assert failure.value.hint is not None
        assert "service_timeout_s" in failure.value.hint

    def test_a_timeout_of_the_service_itself_is_its_own(self) -> None:
        async def read(_request: ReadGripper) -> GripperState:
            raise TimeoutError("no answer on the wire")

        async def asked() -> None:
            async with SkillBus(new_clock(), service_timeout_s=5.0) as bus:
                bus.advertise_service(ReadGripper, read, namespace="left/gripper")
                await bus.call(ReadGripper(), to="left/gripper")

        with pytest.raises(SkillFailed, match="TimeoutError: no answer on the wire"):
            run_virtual(asked())
