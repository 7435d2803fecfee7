"""The data stream: traffic, messages, samples and userdata, only while they are looked at, never waiting for a page."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import AsyncGenerator, Callable
from typing import Any

import pytest
import websockets.asyncio.client
import websockets.exceptions

from editor_web.telemetry.data_frames import DataSubscription
from editor_web.telemetry.page_subscriptions import KEPT_ROWS, PageSubscriptions
from engine.bus import ActiveGoal, Holder, SkillBus
from engine.clock import LoopClock
from engine.messages import JointState, Message
from engine.project.bus_inspector import BusInspector
from engine.skill import Action
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S
from tests.editor_web.served import Served


class Blob(Message, frozen=True, kw_only=True):
    """A large message."""

    points: tuple[float, ...]
    image: bytes


def joints(value: float) -> JointState:
    """The state of a two-joint arm."""
    return JointState(
        time_s=0.0, names=("lift", "turn"), position_rad=(value, 1.0), velocity_rad_s=(0.0, 0.0), effort_nm=(0.0, 2.0)
    )


def backend_on(bus: SkillBus) -> FakeBackend:
    """A backend whose inspector is of this bus."""
    backend = FakeBackend()
    backend.known_inspector = BusInspector(bus)
    return backend


@contextlib.asynccontextmanager
async def data_frames(served: Served) -> AsyncGenerator[Callable[..., Any]]:
    """Open the data stream; gives a function that waits for a frame of a kind, sending a look first where given."""
    async with websockets.asyncio.client.connect(
        f"{served.origin.replace('http', 'ws', 1)}/api/v1/data",
        additional_headers=served.cookie,
        origin=websockets.Origin(served.origin),
        compression=None,
        proxy=None,
    ) as socket:

        async def frame(kind: str, **look: object) -> dict[str, Any]:
            if look:
                await socket.send(json.dumps({"k": "look", **look}))
            while True:
                got = json.loads(await socket.recv())
                if got["k"] == kind:
                    return got

        yield frame


async def test_curves_are_sampled_from_the_latest_messages(serve: Serve) -> None:
    """In the order of the fields; a field that a message has not is a gap."""
    async with SkillBus(LoopClock()) as bus:
        topic = bus.topic("left/joints", JointState)
        topic.publish(joints(0.25))
        async with serve(backend_on(bus)) as served, data_frames(served) as frame:
            fields = ["left/joints:position_rad.0", "left/joints:effort_nm.1", "left/joints:nothing", "gone:x"]
            got = await frame("samples", number=3, fields=fields)
            assert got["number"] == 3
            assert got["rows"][0] == [0.25, 2.0, None, None]
            topic.publish(joints(0.5))
            while got["rows"][-1][0] != 0.5:
                got = await frame("samples")
            assert topic.subscriber_count == 0


async def test_a_message_is_sent_when_it_is_new_and_cut_to_a_size(serve: Serve) -> None:
    """A long row and bytes are told by how much there is of them."""
    async with SkillBus(LoopClock()) as bus:
        topic = bus.topic("cell/blob", Blob)
        async with serve(backend_on(bus)) as served, data_frames(served) as frame:
            assert "no message was published" in (await frame("message", topic="cell/blob"))["problem"]
            topic.publish(Blob(points=tuple(map(float, range(5000))), image=b"x" * 100_000))
            value = (await frame("message"))["value"]
            assert value["image"] == "100000 bytes"
            assert (value["points"][:2], value["points"][-1]) == ([0.0, 1.0], "… 4940 more")
            assert "no such topic" in (await frame("message", topic="cell/blub"))["problem"]


async def test_traffic_tells_rates_ages_leases_and_goals(serve: Serve) -> None:
    """The rate is measured between looks; a lease says who holds it and for how long."""
    async with SkillBus(LoopClock()) as bus:
        topic = bus.topic("left/joints", JointState)
        bus.topic("left/silent", JointState)
        bus.leases.acquire(("left",), Holder("run-7", "root/move"))
        async with serve(backend_on(bus)) as served, data_frames(served) as frame:
            first = await frame("traffic", traffic=True)
            assert first["topics"]["left/silent"]["age_s"] is None
            for _ in range(30):
                topic.publish(joints(0.0))
            later = await frame("traffic")
            assert 10 < later["topics"]["left/joints"]["rate_hz"] < 40
            assert 0 <= later["topics"]["left/joints"]["age_s"] < 5
            lease = later["leases"][0]
            assert (lease["resource"], lease["run"], lease["node"]) == ("left", "run-7", "root/move")
            assert lease["held_s"] > 0
            assert first["shape"] == later["shape"]
            bus.topic("right/new", JointState)
            assert (await frame("traffic"))["shape"] != first["shape"]


async def test_nothing_is_sent_to_who_looks_at_nothing_any_more(serve: Serve) -> None:
    """A tab that is not shown costs nothing."""
    async with SkillBus(LoopClock()) as bus:
        bus.topic("left/joints", JointState).publish(joints(0.0))
        page = PageSubscriptions(backend_on(bus))
        page.look(DataSubscription(traffic=True, fields=("left/joints:position_rad.0",), topic="left/joints"))
        page.sample()
        assert {type(frame).__name__ for frame in page.due()} == {"SamplesFrame", "MessageFrame", "BusMetricsFrame"}
        page.look(DataSubscription())
        assert (page.due(), page.samples, page.begun.is_set()) == ([], False, False)


async def test_a_slow_page_loses_the_oldest_samples_and_learns_how_many() -> None:
    """What waits for it stays bounded."""
    async with SkillBus(LoopClock()) as bus:
        topic = bus.topic("left/joints", JointState)
        page = PageSubscriptions(backend_on(bus), unix_s=lambda: float(topic.count))
        page.look(DataSubscription(number=1, fields=("left/joints:position_rad.0",)))
        for value in range(KEPT_ROWS + 30):
            topic.publish(joints(float(value)))
            page.sample()
        (frame,) = page.due()
        told: Any = frame
        assert (told.dropped, len(told.rows), told.rows[0], told.times_s[0]) == (30, KEPT_ROWS, (30.0,), 31.0)
        assert page.due() == []


async def test_userdata_of_an_unknown_run_is_refused_in_words(serve: Serve) -> None:
    """The page shows them."""
    async with serve() as served, data_frames(served) as frame:
        got = await frame("userdata", run="run-404")
        assert (got["run"], got["scopes"]) == ("run-404", {})
        assert "userdata" in got["problem"]


async def test_what_is_no_look_ends_the_connection(serve: Serve) -> None:
    """And the server stays."""
    async with serve() as served:
        for nonsense in ('{"k": "look", "fields": 7}', "[]", "\x00"):
            async with websockets.asyncio.client.connect(
                f"{served.origin.replace('http', 'ws', 1)}/api/v1/data",
                additional_headers=served.cookie,
                origin=websockets.Origin(served.origin),
                proxy=None,
            ) as socket:
                await socket.send(nonsense)
                async with asyncio.timeout(GUARD_S):
                    await socket.wait_closed()
                assert socket.close_code == 1008


class TravelProgress(Message, frozen=True, kw_only=True):
    """How far a motion is."""

    progress: float


class Rest(Message, frozen=True, kw_only=True):
    """How far a gripper is."""

    width_m: float


class Travel(Action[TravelProgress, TravelProgress], frozen=True, kw_only=True):
    """A motion."""


class Close(Action[Rest, Rest], frozen=True, kw_only=True):
    """A grip."""


class Plant:
    """Carries both out until it is told to end."""

    def __init__(self) -> None:
        self.end = asyncio.Event()
        self.all_begun = asyncio.Event()
        self.goals: list[ActiveGoal[Any]] = []

    async def travel(self, request: Travel, goal: ActiveGoal[TravelProgress]) -> TravelProgress:
        """Move."""
        await self._carry_out(goal)
        return TravelProgress(progress=1.0)

    async def close(self, request: Close, goal: ActiveGoal[Rest]) -> Rest:
        """Grip."""
        await self._carry_out(goal)
        return Rest(width_m=0.0)

    async def _carry_out(self, goal: ActiveGoal[Any]) -> None:
        goal.accept()
        self.goals.append(goal)
        if len(self.goals) == 3:
            self.all_begun.set()
        await self.end.wait()


async def test_goals_under_way_are_reported_by_node_with_their_feedback(serve: Serve) -> None:
    """A share where the feedback has one, else its words; only of the run that is looked at."""
    async with SkillBus(LoopClock()) as bus:
        plant = Plant()
        bus.advertise_action(Travel, plant.travel, namespace="left")
        bus.advertise_action(Close, plant.close, namespace="left/gripper")
        bus.advertise_action(Travel, plant.travel, namespace="right")
        async with serve(backend_on(bus)) as served, data_frames(served) as frame:
            assert (await frame("goals", goals="run-1"))["goals"] == {}
            bus.send_goal(Travel(), to="left", holder=Holder("run-1", "root/move"))
            bus.send_goal(Close(), to="left/gripper", holder=Holder("run-1", "root/grip"))
            bus.send_goal(Travel(), to="right", holder=Holder("run-2", "root/other"))
            got = await frame("goals")
            await plant.all_begun.wait()
            plant.goals[0].feedback(TravelProgress(progress=0.25))
            plant.goals[1].feedback(Rest(width_m=0.0312))
            while not got["goals"].get("root/move", {}).get("share"):
                got = await frame("goals")
            assert got["goals"] == {
                "root/move": {"address": "left/travel", "status": "active", "share": 0.25, "words": ""},
                "root/grip": {
                    "address": "left/gripper/close",
                    "status": "active",
                    "share": None,
                    "words": "width 31.2 mm",
                },
            }
            plant.end.set()
            while got["goals"]:
                got = await frame("goals")


async def test_the_data_is_closed_to_who_is_not_logged_in_and_to_other_pages(serve: Serve) -> None:
    """Browsers let any page open a websocket; the gate does not."""
    async with serve() as served:
        address = f"{served.origin.replace('http', 'ws', 1)}/api/v1/data"
        here, elsewhere = websockets.Origin(served.origin), websockets.Origin("http://elsewhere.example")
        for headers, origin in (({}, here), (served.cookie, elsewhere)):
            with pytest.raises(websockets.exceptions.InvalidStatus, match="403"):
                await websockets.asyncio.client.connect(address, additional_headers=headers, origin=origin, proxy=None)
