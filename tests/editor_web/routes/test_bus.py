"""The skill bus over HTTP, as `flexcell bus` reaches it."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator
from typing import Annotated, Any

import httpx
import msgspec
import pytest

from engine.bus import ActiveGoal, Holder, SkillBus
from engine.bus.json_bus import LocalJsonBus
from engine.bus.remote_bus import RemoteJsonBus
from engine.clock import LoopClock
from engine.errors import BusError
from engine.messages import Message
from engine.project.bus_inspector import BusInspector
from engine.skill import Action, Service
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S


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
    backend.known_bus = LocalJsonBus(bus)
    return backend, device


async def test_the_command_lines_bus_works_through_the_server(serve: Serve) -> None:
    """List, echo, call, goal, and the refusals in the bus's own words."""
    async with SkillBus(LoopClock()) as bus:
        backend, _ = wired(bus)
        async with serve(backend) as served:
            remote = RemoteJsonBus(served.http)
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


async def test_commands_reach_the_server_of_their_topic(serve: Serve) -> None:
    """Other topics take no commands; the refusal names those that do."""
    async with SkillBus(LoopClock()) as bus:
        backend, _ = wired(bus)
        heard: list[Number] = []
        bus.topic("left/wanted", Number).subscribe_commands(heard.append)
        async with serve(backend) as served:
            remote = RemoteJsonBus(served.http)
            for value in (1, 2):
                await remote.publish("left/wanted", {"value": value})
            with pytest.raises(BusError, match=r"takes no commands.*commands are taken on left/wanted"):
                await remote.publish("left/number", {"value": 3})
            with pytest.raises(BusError, match="this is not a Number: object contains unknown field"):
                await remote.publish("left/wanted", {"value": 3, "unit": "m"})
            with pytest.raises(BusError, match="left/wandet"):
                await remote.publish("left/wandet", {"value": 3})
    assert heard == [Number(value=1), Number(value=2)]


async def test_a_goal_is_cancelled_when_its_client_goes(serve: Serve) -> None:
    """A lost connection must not leave a robot moving."""
    async with SkillBus(LoopClock()) as bus:
        backend, device = wired(bus)
        async with serve(backend) as served:
            asking = asyncio.create_task(RemoteJsonBus(served.http).perform("left/rest", {}))
            await device.started.wait()
            asking.cancel()
            async with asyncio.timeout(GUARD_S):
                await device.rested.wait()
            with pytest.raises(asyncio.CancelledError):
                await asking


async def test_the_bus_is_closed_to_who_is_not_logged_in(serve: Serve) -> None:
    """It moves robots."""
    async with (
        serve() as served,
        httpx.AsyncClient(base_url=served.running.url, trust_env=False, timeout=GUARD_S) as stranger,
    ):
        assert (await stranger.get("/api/v1/bus")).status_code == 401
        for path in ("call", "goal", "publish"):
            assert (await stranger.post(f"/api/v1/bus/{path}", json={"address": "left/rest"})).status_code == 403


async def _lines(response: httpx.Response) -> AsyncGenerator[dict[str, Any]]:
    async for line in response.aiter_lines():
        yield msgspec.json.decode(line)


async def test_the_page_gets_what_there_is_with_words_and_forms(serve: Serve) -> None:
    """Docstrings, schemas, numbers to plot, parameters."""
    async with SkillBus(LoopClock()) as bus:
        backend, _ = wired(bus)
        backend.known_inspector = BusInspector(bus)
        bus.parameters.declare("left/gain", Annotated[float, msgspec.Meta(ge=0)], 0.5, description="How stiff it is")
        async with serve(backend) as served:
            board = (await served.http.get("/api/v1/bus/board")).json()
            assert [(each["kind"], each["name"], each["doc"]) for each in board["skills"]] == [
                ("service", "left/double", "A service."),
                ("action", "left/rest", "An action that lasts until it is cancelled."),
            ]
            assert board["topics"] == [
                {"name": "left/number", "type": "Number", "doc": "A message.", "takes_commands": False}
            ]
            assert [(each["name"], each["value"], each["schema"]["minimum"]) for each in board["parameters"]] == [
                ("left/gain", 0.5, 0)
            ]
            form = (await served.http.get("/api/v1/bus/form", params={"address": "left/double"})).json()["schema"]
            assert form["$defs"]["Double"]["properties"] == {"value": {"type": "integer"}}
            fields = (await served.http.get("/api/v1/bus/fields")).json()["topics"]
            assert fields == [
                {"topic": "left/number", "type": "Number", "fields": [{"path": "value", "label": "value", "unit": ""}]}
            ]
            changed = await served.http.put("/api/v1/bus/parameter", json={"name": "left/gain", "value": 2.0})
            assert (changed.status_code, changed.json(), bus.parameters.get("left/gain")) == (200, 2.0, 2.0)
            for path, problem in (("form?address=left/dobule", "no such service"), ("form?topic=x", "no such topic")):
                refused = await served.http.get(f"/api/v1/bus/{path}")
                assert (refused.status_code, problem in refused.json()["message"]) == (422, True)
            wrong = await served.http.put("/api/v1/bus/parameter", json={"name": "left/gain", "value": -1})
            assert (wrong.status_code, wrong.json()["where"]) == (422, "left/gain")


async def test_a_goal_of_the_page_tells_its_course_and_can_be_cancelled(serve: Serve) -> None:
    """The end comes when the device rests; the lease is given back."""
    async with SkillBus(LoopClock()) as bus:
        backend, device = wired(bus)
        backend.known_inspector = BusInspector(bus)
        async with serve(backend) as served:
            body = {"address": "left/rest"}
            async with served.http.stream("POST", "/api/v1/bus/goals", json=body) as response:
                lines = _lines(response)
                sent = await anext(lines)
                assert sent["k"] == "sent"
                while (line := await anext(lines))["status"] != "active":
                    pass
                assert [each.run for each in bus.leases.held()] == ["cli"]
                cancelled = await served.http.post(f"/api/v1/bus/goals/{sent['goal']}/cancel")
                assert cancelled.status_code == 202
                *_, line = [each async for each in lines]
                assert (line["end"]["status"], device.rested.is_set()) == ("canceled", True)
            assert bus.leases.held() == ()
            gone = await served.http.post(f"/api/v1/bus/goals/{sent['goal']}/cancel")
            assert (gone.status_code, gone.json()["message"]) == (422, "no such active goal")
            refused = await served.http.post(
                "/api/v1/bus/goals", json={"address": "left/rest", "request": {"until": 7}}
            )
            assert (refused.status_code, refused.json()["where"]) == (422, "left/rest")


async def test_a_goal_whose_page_goes_is_cancelled_and_one_of_a_run_is_not_for_the_page(serve: Serve) -> None:
    """Closing the tab must not leave a robot moving."""
    async with SkillBus(LoopClock()) as bus:
        backend, device = wired(bus)
        backend.known_inspector = BusInspector(bus)
        async with serve(backend) as served:
            body = {"address": "left/rest"}
            async with served.http.stream("POST", "/api/v1/bus/goals", json=body) as response:
                await anext(_lines(response))
                await device.started.wait()
            async with asyncio.timeout(GUARD_S):
                await device.rested.wait()
                await bus.cancel_goals()
            device.rested.clear()
            mine = bus.send_goal(Rest(), to="left", holder=Holder("run-1", "root"), goal_id="root#1.1")
            refused = await served.http.post("/api/v1/bus/goals/root%231.1/cancel")
            assert (refused.status_code, refused.json()["hint"]) == (422, "stop run run-1")
            assert not mine.finished


async def test_viewers_see_the_bus_and_change_nothing(serve: Serve) -> None:
    """Every change is refused to them."""
    async with serve() as served:
        headers = {"Authorization": f"Bearer {served.access.viewer}"}
        url = served.running.url
        async with httpx.AsyncClient(base_url=url, headers=headers, trust_env=False, timeout=GUARD_S) as viewer:
            for path in ("board", "fields"):
                assert (await viewer.get(f"/api/v1/bus/{path}")).status_code == 200
            for path in ("goals", "goals/g1/cancel", "call", "publish"):
                assert (await viewer.post(f"/api/v1/bus/{path}", json={})).status_code == 403
            assert (await viewer.put("/api/v1/bus/parameter", json={})).status_code == 403
