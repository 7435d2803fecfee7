"""The skill bus over HTTP, as `flexcell bus` reaches it."""

from __future__ import annotations

import asyncio

import httpx
import msgspec
import pytest

from engine.bus import ActiveGoal, SkillBus
from engine.bus.access import LocalBus
from engine.bus.remote import RemoteBus
from engine.clock import LoopClock
from engine.errors import BusError
from engine.messages import Message
from engine.skill import Action, Service
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend


class Number(Message, frozen=True, kw_only=True):
    """A message."""

    value: int


class Double(Service[Number], frozen=True, kw_only=True):
    """A service."""

    value: int


class Rest(Action[Number, Number], frozen=True, kw_only=True):
    """An action that lasts until it is cancelled."""

    until: str = "cancelled"


class Device:
    """Answers both, and notes what became of its goal."""

    def __init__(self) -> None:
        self.started = asyncio.Event()
        self.rested = asyncio.Event()

    async def double(self, request: Double) -> Number:
        """Answer the service."""
        return Number(value=2 * request.value)

    async def rest(self, request: Rest, goal: ActiveGoal[Number]) -> Number:
        """Work until cancelled."""
        goal.accept()
        self.started.set()
        if request.until == "now":
            return Number(value=1)
        try:
            await asyncio.Event().wait()
        finally:
            self.rested.set()
        return Number(value=0)


def wired(bus: SkillBus) -> tuple[FakeBackend, Device]:
    """A backend on this bus, with one device."""
    device, backend = Device(), FakeBackend()
    bus.advertise_service(Double, device.double, namespace="left")
    bus.advertise_action(Rest, device.rest, namespace="left")
    bus.topic("left/number", Number).publish(Number(value=7))
    backend.known_bus = LocalBus(bus)
    return backend, device


async def test_the_command_lines_bus_works_through_the_server(serve: Serve) -> None:
    """List, echo, call, goal, and the refusals in the bus's own words."""
    async with SkillBus(LoopClock()) as bus:
        backend, _ = wired(bus)
        async with serve(backend) as served:
            remote = RemoteBus(served.http)
            assert {"left/number", "left/double", "left/rest"} <= {entry.name for entry in await remote.listing()}
            assert msgspec.json.decode(await remote.call("left/double", {"value": 21})) == {"value": 42}
            end = await remote.perform("left/rest", {"until": "now"})
            assert (end.status.value, end.result) == ("succeeded", {"value": 1})
            echo = remote.echo("left/number")
            assert msgspec.json.decode(await anext(echo)) == {"value": 7}
            bus.topic("left/number", Number).publish(Number(value=8))
            assert msgspec.json.decode(await anext(echo)) == {"value": 8}
            await echo.aclose()
            with pytest.raises(BusError, match="left/dobule"):
                await remote.call("left/dobule", {})
            with pytest.raises(BusError, match="not an action"):
                await remote.perform("left/double", {"value": 1})
            with pytest.raises(BusError, match="nowhere"):
                await anext(remote.echo("nowhere"))


async def test_messages_reach_the_server_that_obeys_their_topic(serve: Serve) -> None:
    """Other topics only tell; the refusal names those that take commands."""
    async with SkillBus(LoopClock()) as bus:
        backend, _ = wired(bus)
        heard: list[Number] = []
        bus.topic("left/wanted", Number).obey(heard.append)
        async with serve(backend) as served:
            remote = RemoteBus(served.http)
            for value in (1, 2):
                await remote.publish("left/wanted", {"value": value})
            with pytest.raises(BusError, match=r"it only tells.*commands are taken on left/wanted"):
                await remote.publish("left/number", {"value": 3})
            with pytest.raises(BusError, match="this is not a Number: Object contains unknown field"):
                await remote.publish("left/wanted", {"value": 3, "unit": "m"})
            with pytest.raises(BusError, match="left/wandet"):
                await remote.publish("left/wandet", {"value": 3})
    assert heard == [Number(value=1), Number(value=2)]


async def test_a_goal_is_cancelled_when_its_client_goes(serve: Serve) -> None:
    """A lost connection must not leave a robot moving."""
    async with SkillBus(LoopClock()) as bus:
        backend, device = wired(bus)
        async with serve(backend) as served:
            asking = asyncio.create_task(RemoteBus(served.http).perform("left/rest", {}))
            await device.started.wait()
            asking.cancel()
            async with asyncio.timeout(5):
                await device.rested.wait()
            with pytest.raises(asyncio.CancelledError):
                await asking


async def test_the_bus_is_closed_to_who_is_not_logged_in(serve: Serve) -> None:
    """It moves robots."""
    async with serve() as served, httpx.AsyncClient(base_url=served.running.url, trust_env=False) as stranger:
        assert (await stranger.get("/api/v1/bus")).status_code == 401
        for path in ("call", "goal", "publish"):
            assert (await stranger.post(f"/api/v1/bus/{path}", json={"address": "left/rest"})).status_code == 403
