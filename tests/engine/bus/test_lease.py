"""Who may command what: leases, services that command a resource, and what is told when a run gives one back."""

from __future__ import annotations

import pytest

from engine.bus import Holder, LeaseTable, SkillBus
from engine.bus.lease import Lease
from engine.clock import new_clock
from engine.errors import LeaseRefused
from engine.messages import Message
from engine.skill import Service

ONE, TWO = Holder("run-1", "root/a"), Holder("run-2", "root/b")


class Number(Message, frozen=True, kw_only=True):
    """An answer."""

    value: int


class Change(Service[Number], frozen=True, kw_only=True):
    """A service that commands an arm."""


class Take(Service[Number], frozen=True, kw_only=True):
    """A service for which the run that has the arm ends."""

    @property
    def ends_run(self) -> bool:
        return True


async def change(request: Change) -> Number:
    """Answer."""
    return Number(value=1)


async def take(request: Take) -> Number:
    """Answer."""
    return Number(value=1)


async def test_a_service_that_commands_a_resource_is_refused_to_others_while_a_run_holds_it() -> None:
    """Also between the goals of that run; the refusal names it. Nothing is leased by asking."""
    async with SkillBus(new_clock()) as bus:
        bus.advertise_service(Change, change, namespace="left", commands="left")
        assert await bus.call(Change(), to="left") == Number(value=1)
        bus.leases.acquire(("left/gripper",), ONE)
        bus.leases.release(("left/gripper",), ONE)
        assert await bus.call(Change(), to="left", holder=ONE) == Number(value=1)
        for other in (TWO, Holder("nobody")):
            with pytest.raises(LeaseRefused, match="left is commanded by run run-1"):
                await bus.call(Change(), to="left", holder=other)
        bus.leases.release_run("run-1")
        assert await bus.call(Change(), to="left", holder=TWO) == Number(value=1)
        assert bus.leases.listing() == ()


async def test_another_branch_of_the_same_run_is_refused_while_one_commands_the_resource() -> None:
    """As for goals."""
    async with SkillBus(new_clock()) as bus:
        bus.advertise_service(Change, change, namespace="left", commands="left")
        bus.leases.acquire(("left",), ONE)
        with pytest.raises(LeaseRefused, match="in another branch"):
            await bus.call(Change(), to="left", holder=Holder("run-1", "root/b"))


async def test_a_service_that_ends_a_run_waits_for_its_end_and_is_refused_by_who_cannot_be_ended() -> None:
    """One that has not let go by then keeps the resource."""
    async with SkillBus(new_clock()) as bus:
        bus.advertise_service(Take, take, namespace="left", commands="left")
        reasons = list[str]()

        async def end(reason: str) -> None:
            reasons.append(reason)
            if len(reasons) > 1:
                bus.leases.release_run("run-1")

        bus.leases.acquire(("left",), ONE)
        for able in (False, True):
            if able:
                bus.leases.on_claim("run-1", end)
            with pytest.raises(LeaseRefused, match="left is commanded by run run-1"):
                await bus.call(Take(), to="left", holder=TWO)
        assert await bus.call(Take(), to="left", holder=TWO) == Number(value=1)
        assert reasons == ["run-2 called left/take, which ends the run that has left"] * 2


async def test_a_service_that_commands_nothing_is_answered_to_anybody() -> None:
    """Reading disturbs nobody."""
    async with SkillBus(new_clock()) as bus:
        bus.advertise_service(Change, change, namespace="left")
        bus.leases.acquire(("left",), ONE)
        assert await bus.call(Change(), to="left", holder=TWO) == Number(value=1)


def test_who_waits_for_a_resource_is_notified_once_when_its_run_gives_it_back() -> None:
    """Not at the end of a goal, not for another resource, not when nobody holds it."""
    leases, told = LeaseTable(), list[str]()
    leases.when_freed("left", lambda: told.append("nobody held it"))
    leases.acquire(("left", "right/gripper"), ONE)
    leases.acquire(("base",), TWO)
    leases.when_freed("left", lambda: told.append("left"))
    leases.when_freed("base", lambda: told.append("base"))
    leases.release(("left",), ONE)
    assert told == []
    leases.release_run("run-1")
    leases.release_run("run-1")
    assert told == ["left"]


async def test_who_holds_what_is_reported_with_the_time_since_when() -> None:
    """A run keeps the arm after its branch has given its part back; the branch's time is its own."""
    now_s = 1.0
    table = LeaseTable(now_s=lambda: now_s)
    table.acquire(("left/gripper",), ONE)
    now_s = 2.0
    table.acquire(("left", "left/gripper"), ONE)
    told = [(each.resource, each.run, each.branch, each.since_s) for each in table.held()]
    assert told == [("left", "run-1", "root/a", 2.0), ("left/gripper", "run-1", "root/a", 1.0)]
    table.release(("left", "left/gripper"), ONE)
    table.release(("left/gripper",), ONE)
    now_s = 3.0
    assert [(each.resource, each.branch, each.since_s) for each in table.held()] == [("left", "", 1.0)]
    table.release_run("run-1")
    assert table.held() == ()
    table.acquire(("left",), TWO)
    assert [(each.run, each.since_s) for each in table.held()] == [("run-2", 3.0)]


def test_a_run_that_commands_a_part_of_an_arm_owns_all_of_it() -> None:
    """The refusal names who commands it, what asked, and what to do."""
    leases = LeaseTable()
    leases.acquire(("left/gripper",), ONE)
    for resource in ("left", "left/gripper", "left/camera"):
        with pytest.raises(LeaseRefused) as refused:
            leases.acquire((resource,), TWO)
        said = f"run run-2 at root/b: {resource} is commanded by run run-1 at root/a"
        assert str(refused.value) == f"{said} (wait for run run-1 to end or stop it)"
    leases.acquire(("right",), TWO)
    assert (leases.owner("left/gripper"), leases.owner("right/gripper"), leases.owner("base")) == (
        "run-1",
        "run-2",
        None,
    )


def test_of_several_resources_all_are_leased_or_none() -> None:
    leases = LeaseTable()
    leases.acquire(("left",), ONE)
    with pytest.raises(LeaseRefused):
        leases.acquire(("right", "left"), TWO)
    assert leases.listing() == (("left", "run run-1 at root/a"),)
    leases.acquire(("right",), Holder("run-3"))
    assert leases.listing() == (("left", "run run-1 at root/a"), ("right", "run run-3"))


def test_what_a_branch_has_leased_twice_it_gives_back_twice() -> None:
    leases, other = LeaseTable(), Holder("run-1", "root/c")
    leases.acquire(("left",), ONE)
    leases.acquire(("left",), ONE)
    leases.release(("left", "never leased"), ONE)
    leases.release(("left",), other)
    with pytest.raises(LeaseRefused, match="left is commanded by run run-1 at root/a in another branch"):
        leases.acquire(("left",), other)
    leases.release(("left",), ONE)
    leases.acquire(("left",), other)
    assert leases.listing() == (("left", "run run-1 at root/c"),)


def test_a_run_that_ends_gives_back_what_it_holds_and_nothing_else() -> None:
    """Also what its branches have not given back; the next holder's time begins when it leases."""
    now_s = 1.0
    leases = LeaseTable(now_s=lambda: now_s)
    leases.acquire(("left", "left/gripper"), ONE)
    leases.acquire(("right",), TWO)
    now_s = 2.0
    leases.release_run("run-1")
    assert leases.held() == (Lease(resource="right", run="run-2", branch="root/b", since_s=1.0),)
    now_s = 3.0
    leases.acquire(("left/gripper",), TWO)
    leases.release(("left/gripper",), TWO)
    now_s = 4.0
    leases.acquire(("left/gripper",), TWO)
    assert leases.held() == (
        Lease(resource="left", run="run-2", branch="", since_s=3.0),
        Lease(resource="left/gripper", run="run-2", branch="root/b", since_s=4.0),
        Lease(resource="right", run="run-2", branch="root/b", since_s=1.0),
    )


def test_a_run_whose_branches_hold_nothing_is_named_alone() -> None:
    """A refusal names the branch of the resource that it is about, not one of another arm."""
    leases = LeaseTable()
    leases.acquire(("right", "left/gripper"), ONE)
    leases.release(("left/gripper",), ONE)
    with pytest.raises(LeaseRefused, match=r"left is commanded by run run-1 \(wait"):
        leases.acquire(("left",), TWO)
