"""Actions: accepted or rejected, fed back, held, and cancelled with confirmation."""

from __future__ import annotations

import asyncio
import logging

import pytest

from engine.bus import ActiveGoal, GoalStatus, Holder, SkillBus
from engine.clock import new_clock
from engine.errors import BusError, GoalRejected, HandlerNotTyped, LeaseRefused, NoSuchSkill, SkillFailed
from engine.messages import GripperState
from engine.skills.gripper import GraspResult, GripperFeedback, GripperGrasp, GripperMove, GripperOpen, ReadGripper

HELD = GraspResult(held=True, width_m=0.03, force_n=20.0)
GRASP = GripperGrasp(width_m=0.03)
ONE = Holder("run-1", "root/a")
TWO = Holder("run-2", "root/b")


class FakeGripper:
    """Works until told to finish; stops only when `stopped` is set after a cancel."""

    def __init__(self) -> None:
        self.finish = asyncio.Event()
        self.stopped = asyncio.Event()
        self.cancelled = asyncio.Event()
        self.log: list[str] = []

    async def grasp(self, goal: GripperGrasp, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        handle.on_cancel(self.cancelled.set)
        handle.on_hold(self._hold)
        handle.on_resume(self._resume)
        handle.feedback(GripperFeedback(width_m=0.05))
        waits = [asyncio.create_task(self.finish.wait()), asyncio.create_task(self.cancelled.wait())]
        await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
        for wait in waits:
            wait.cancel()
        if handle.cancel_requested:
            await self.stopped.wait()
            self.log.append("at rest")
        return HELD

    async def _hold(self) -> None:
        self.log.append("held")

    async def _resume(self) -> None:
        self.log.append("resumed")

    async def open(self, goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        return HELD

    async def move(self, goal: GripperMove, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        if goal.width_m > 0.08:
            raise GoalRejected(f"opens to 0.08 m, not {goal.width_m:g} m", where="left/gripper")
        handle.accept()
        raise SkillFailed("the fingers are blocked", where="left/gripper")


def _bus() -> tuple[SkillBus, FakeGripper]:
    bus, gripper = SkillBus(new_clock()), FakeGripper()
    bus.advertise_action(GripperGrasp, gripper.grasp, namespace="left/gripper", exclusive="left/gripper")
    bus.advertise_action(GripperOpen, gripper.open, namespace="left/gripper", exclusive="left/gripper")
    bus.advertise_action(GripperMove, gripper.move, namespace="left/gripper", exclusive="left/gripper")
    return bus, gripper


async def test_a_goal_succeeds_with_its_result_and_feedback() -> None:
    """Accepted, fed back, finished."""
    bus, gripper = _bus()
    handle = bus.send_goal(GRASP, to="left/gripper", holder=ONE)
    await handle.accepted()
    await asyncio.sleep(0)
    assert (handle.status, handle.feedback) == (GoalStatus.ACTIVE, GripperFeedback(width_m=0.05))
    gripper.finish.set()
    end = await handle.result()
    assert (end.status, end.result, handle.status) == (GoalStatus.SUCCEEDED, HELD, GoalStatus.SUCCEEDED)


async def test_a_cancel_has_happened_only_when_the_server_confirms() -> None:
    """The result arrives after the device is at rest, with what was reached."""
    bus, gripper = _bus()
    handle = bus.send_goal(GRASP, to="left/gripper", holder=ONE)
    await handle.accepted()
    handle.cancel()
    handle.cancel()
    waiting = asyncio.create_task(handle.result())
    await asyncio.sleep(0)
    assert (handle.status, waiting.done()) == (GoalStatus.CANCELING, False)
    gripper.stopped.set()
    end = await waiting
    assert (end.status, end.result, gripper.log) == (GoalStatus.CANCELED, HELD, ["at rest"])


async def test_a_goal_that_is_not_yet_accepted_is_held_as_soon_as_it_is() -> None:
    """A pause that comes while the server still plans must not let the device start."""
    bus, gripper = _bus()
    handle = bus.send_goal(GRASP, to="left/gripper", holder=ONE)
    assert handle.status is GoalStatus.PENDING
    await handle.hold()
    assert (handle.status, gripper.log) == (GoalStatus.HELD, ["held"])
    await handle.resume()
    gripper.finish.set()
    assert ((await handle.result()).status, gripper.log) == (GoalStatus.SUCCEEDED, ["held", "resumed"])


async def test_a_rejection_gives_the_reason_before_anything_moves() -> None:
    """Rejected goals raise at the client with the server's words."""
    bus, _ = _bus()
    handle = bus.send_goal(GripperMove(width_m=0.2), to="left/gripper")
    with pytest.raises(GoalRejected, match=r"opens to 0.08 m, not 0.2 m"):
        await handle.accepted()
    assert (await handle.result()).status is GoalStatus.REJECTED


async def test_a_failure_after_acceptance_aborts_with_its_cause() -> None:
    """SkillFailed becomes the cause of an aborted goal."""
    bus, _ = _bus()
    end = await bus.send_goal(GripperMove(width_m=0.02), to="left/gripper").result()
    assert end.status is GoalStatus.ABORTED
    assert end.cause is not None
    assert (end.cause.kind, end.cause.message) == ("SkillFailed", "the fingers are blocked")


async def test_a_bug_in_a_handler_ends_its_goal_only(caplog: pytest.LogCaptureFixture) -> None:
    """Any exception becomes a cause with file and line; the bus goes on."""
    bus, _ = _bus()

    async def broken(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        raise ZeroDivisionError("oops")

    bus.advertise_action(GripperOpen, broken, namespace="right/gripper")
    with caplog.at_level(logging.CRITICAL, logger="flexcell.bus"):
        end = await bus.send_goal(GripperOpen(), to="right/gripper").result()
    assert end.cause is not None
    assert (end.cause.kind, "test_action.py:" in end.cause.where) == ("ZeroDivisionError", True)


async def test_a_second_goal_of_an_exclusive_group_learns_which_one_runs() -> None:
    """One goal at a time per device, and the refusal names the other."""
    bus, gripper = _bus()
    first = bus.send_goal(GRASP, to="left/gripper", holder=ONE, goal_id="first")
    await first.accepted()
    second = bus.send_goal(GripperOpen(), to="left/gripper", holder=ONE)
    with pytest.raises(GoalRejected, match=r"busy with goal first of run run-1 at root/a"):
        await second.accepted()
    gripper.finish.set()
    await first.result()
    third = bus.send_goal(GripperOpen(), to="left/gripper", holder=ONE)
    assert (await third.result()).status is GoalStatus.SUCCEEDED


async def test_another_run_is_refused_the_resource_and_learns_who_holds_it() -> None:
    """Leases keep two runs from commanding one device."""
    bus, gripper = _bus()
    first = bus.send_goal(GRASP, to="left/gripper", holder=ONE)
    with pytest.raises(LeaseRefused, match=r"left/gripper is commanded by run run-1 at root/a"):
        bus.send_goal(GripperOpen(), to="left/gripper", holder=TWO)
    gripper.finish.set()
    await first.result()
    bus.leases.release_run("run-1")
    assert (await bus.send_goal(GripperOpen(), to="left/gripper", holder=TWO).result()).status is GoalStatus.SUCCEEDED


async def test_hold_and_resume_are_confirmed_by_the_server() -> None:
    """A held goal is at rest and goes on afterwards."""
    bus, gripper = _bus()
    handle = bus.send_goal(GRASP, to="left/gripper")
    await handle.accepted()
    await asyncio.sleep(0)
    await handle.hold()
    held = handle.status
    await handle.resume()
    gripper.finish.set()
    end = await handle.result()
    assert (held, gripper.log, end.status) == (GoalStatus.HELD, ["held", "resumed"], GoalStatus.SUCCEEDED)


async def test_a_skill_without_hold_says_so() -> None:
    """Holding is refused, never pretended."""
    bus = SkillBus(new_clock())
    going = asyncio.Event()

    async def plain(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        await going.wait()
        return HELD

    bus.advertise_action(GripperOpen, plain, namespace="left/gripper")
    handle = bus.send_goal(GripperOpen(), to="left/gripper")
    await handle.accepted()
    with pytest.raises(BusError, match="cannot be held"):
        await handle.hold()
    handle.cancel()
    assert (await handle.result()).status is GoalStatus.CANCELED


async def test_a_goal_cancelled_before_it_began_never_begins() -> None:
    """Nothing is executed and the lease is given back."""
    bus, gripper = _bus()
    handle = bus.send_goal(GRASP, to="left/gripper", holder=ONE)
    handle.cancel()
    assert (await handle.result()).status is GoalStatus.CANCELED
    assert gripper.log == []
    bus.leases.release_run("run-1")
    assert bus.leases.listing() == ()


async def test_closing_the_bus_cancels_and_awaits_what_runs() -> None:
    """No goal outlives the bus."""
    bus, gripper = _bus()
    async with bus:
        handle = bus.send_goal(GRASP, to="left/gripper")
        await handle.accepted()
        gripper.stopped.set()
    assert (gripper.log, handle.status) == (["at rest"], GoalStatus.CANCELED)


async def test_a_handler_without_annotations_is_refused() -> None:
    """Nothing untyped can reach a device; the message shows the signature that is due."""
    bus = SkillBus(new_clock())

    async def untyped(goal, handle):  # noqa: ANN001, ANN202 # pyright: ignore[reportUnknownParameterType, reportMissingParameterType]
        return HELD

    with pytest.raises(HandlerNotTyped, match=r"handler\(goal: GripperOpen, handle: ActiveGoal\[GripperFeedback\]\)"):
        bus.advertise_action(GripperOpen, untyped, namespace="left/gripper")  # pyright: ignore[reportUnknownArgumentType]


async def test_a_handler_of_another_type_is_refused() -> None:
    """A wrong result type is found at registration, not at the first call."""
    bus = SkillBus(new_clock())

    async def wrong(request: ReadGripper) -> GraspResult:
        return HELD

    with pytest.raises(HandlerNotTyped, match=r"ReadGripper.*GripperState"):
        bus.advertise_service(ReadGripper, wrong, namespace="left/gripper")


async def test_services_answer_plain_and_async() -> None:
    """Both kinds of handler work, and an unknown address suggests near ones."""
    bus = SkillBus(new_clock())
    answer = GripperState(time_s=1.0, width_m=0.02, force_n=0.0, held=False)

    def read(request: ReadGripper) -> GripperState:
        return answer

    bus.advertise_service(ReadGripper, read, namespace="left/gripper")
    assert await bus.call(ReadGripper(), to="left/gripper") == answer
    with pytest.raises(NoSuchSkill, match="did you mean left/gripper/read_gripper"):
        await bus.call(ReadGripper(), to="lef/gripper")


async def test_a_service_bug_reaches_the_caller_as_skill_failed() -> None:
    """The cause is chained."""
    bus = SkillBus(new_clock())

    def broken(request: ReadGripper) -> GripperState:
        raise KeyError("register 7")

    bus.advertise_service(ReadGripper, broken, namespace="left/gripper")
    with pytest.raises(SkillFailed, match="KeyError: 'register 7'") as caught:
        await bus.call(ReadGripper(), to="left/gripper")
    assert isinstance(caught.value.__cause__, KeyError)


async def test_the_listing_shows_everything_on_the_bus() -> None:
    """Introspection for people: topics, services, actions, parameters and leases."""
    bus, gripper = _bus()
    bus.parameters.declare("left/speed", float, 0.5)
    bus.topic("left/gripper/state", GripperState)
    handle = bus.send_goal(GRASP, to="left/gripper", holder=ONE)
    await handle.accepted()
    kinds = [(entry.kind, entry.name) for entry in bus.listing()]
    gripper.finish.set()
    await handle.result()
    assert kinds == [
        ("action", "left/gripper/gripper_grasp"),
        ("action", "left/gripper/gripper_move"),
        ("action", "left/gripper/gripper_open"),
        ("lease", "left"),
        ("lease", "left/gripper"),
        ("parameter", "left/speed"),
        ("topic", "left/gripper/state"),
    ]


async def test_parameters_are_validated_at_every_change() -> None:
    """A wrong type is refused and the old value stays."""
    bus = SkillBus(new_clock())
    seen: list[object] = []
    bus.parameters.declare("left/speed", float, 0.5)
    bus.parameters.watch("left/speed", seen.append)
    bus.parameters.set("left/speed", 0.7)
    with pytest.raises(BusError, match="expected number, got text"):
        bus.parameters.set("left/speed", "fast")
    assert (bus.parameters.get("left/speed"), seen) == (0.7, [0.7])


async def test_a_cancel_callback_that_raises_still_ends_the_goal(caplog: pytest.LogCaptureFixture) -> None:
    """A driver's bug in its stop path must not keep the others from stopping."""
    bus = SkillBus(new_clock())

    def broken() -> None:
        raise RuntimeError("driver bug")

    async def handler(goal: GripperOpen, handle: ActiveGoal[GripperFeedback]) -> GraspResult:
        handle.accept()
        handle.on_cancel(broken)
        await asyncio.get_running_loop().create_future()
        return HELD

    bus.advertise_action(GripperOpen, handler, namespace="left/gripper")
    handle = bus.send_goal(GripperOpen(), to="left/gripper")
    await handle.accepted()
    with caplog.at_level(logging.CRITICAL, logger="flexcell.bus"):
        await bus.cancel_goals()
    assert handle.status is GoalStatus.CANCELED
