"""A page that jogs an arm dies in every way there is: the arm comes to rest."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncGenerator, Generator
from contextlib import asynccontextmanager
from typing import Any

import pytest
import websockets.asyncio.client

from editor_web.security.authentication import VIEWER
from tests.editor_web.teach_site import TeachSite, fastest

REST_S = 0.3
Socket = websockets.asyncio.client.ClientConnection
DOWN = [0.0, 0.0, -0.15, 0.0, 0.0, 0.0]


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    """An arm in physics, in real time."""
    with TeachSite(host=loopback, project=tmp_path_factory.mktemp("taught")) as opened:
        yield opened


async def send(socket: Socket, **message: object) -> None:
    await socket.send(json.dumps(message))


async def until(socket: Socket, *kinds: str) -> dict[str, Any]:
    while True:
        frame = json.loads(await socket.recv())
        if frame["k"] in kinds:
            return frame


async def begun(socket: Socket) -> None:
    """Begin to jog; the page before may just be letting go."""
    while True:
        await send(socket, k="jog", arm="left", space="tool", frame="world")
        if (await until(socket, "jogging", "refused"))["k"] == "jogging":
            return


@asynccontextmanager
async def jogging(site: TeachSite) -> AsyncGenerator[tuple[Socket, asyncio.Task[None]]]:
    """The tool goes down at 15 cm/s, as long as the task repeats it."""
    await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(site.go_home(), site.loop))
    async with site.socket() as socket:
        await begun(socket)

        async def repeat() -> None:
            while True:
                await send(socket, k="go", velocity=DOWN)
                await asyncio.sleep(0.05)

        task = asyncio.create_task(repeat())
        try:
            await site.seen(lambda state: fastest(state) > 0.2)
            yield socket, task
        finally:
            task.cancel()
            await asyncio.wait({task})


async def rest_after(site: TeachSite) -> float:
    """Return how long, of the time of the simulated world, a joint still moves."""
    began = await site.seen(lambda _: True)
    moving = await asyncio.wrap_future(asyncio.run_coroutine_threadsafe(site.last_moving(), site.loop))
    return moving.time_s - began.time_s


async def test_an_arm_rests_when_the_key_is_let_go(site: TeachSite) -> None:
    async with jogging(site) as (socket, task):
        task.cancel()
        await send(socket, k="rest")
        assert await rest_after(site) < REST_S
        assert (await until(socket, "jogging"))["arm"] == ""


async def test_an_arm_rests_when_the_page_falls_silent(site: TeachSite) -> None:
    """The connection stays open, as of a page that hangs; nobody but the arm itself stops it."""
    async with jogging(site) as (_, task):
        task.cancel()
        assert await rest_after(site) < REST_S


async def test_an_arm_rests_when_the_connection_is_cut(site: TeachSite) -> None:
    """Without a word, as when a browser is killed."""
    async with jogging(site) as (socket, task):
        task.cancel()
        socket.transport.abort()
        assert await rest_after(site) < REST_S


async def test_one_page_jogs_an_arm_at_a_time(site: TeachSite) -> None:
    """The other is told so, and what it sends moves nothing."""
    async with jogging(site), site.socket() as other:
        await send(other, k="jog", arm="left", space="joints", frame="world")
        refused = await until(other, "refused")
    assert (refused["what"], refused["message"]) == ("jog", "another page jogs this arm")


async def test_what_is_far_too_fast_or_of_nobody_is_refused(site: TeachSite) -> None:
    async with site.socket() as socket:
        await begun(socket)
        await send(socket, k="go", velocity=[0.0, 0.0, 3.0, 0.0, 0.0, 0.0])
        assert "exceeds the limit of 0.25" in (await until(socket, "refused"))["message"]
        await send(socket, k="jog", arm="middle", space="tool")
        assert (await until(socket, "refused"))["what"] == "jog"


async def test_a_viewer_may_only_look(site: TeachSite) -> None:
    async with site.socket(VIEWER) as socket:
        assert [arm["name"] for arm in (await until(socket, "arms"))["arms"]] == ["left"]
        assert len((await until(socket, "now"))["arms"]["left"]["joints"]) == 7
        await send(socket, k="jog", arm="left", space="tool")
        assert (await until(socket, "refused"))["message"] == "you may look only"
        await send(socket, k="button", source="keyboard", button="next", value=True)
        assert (await until(socket, "refused"))["message"] == "you may look only"


async def test_what_is_no_message_ends_the_connection(site: TeachSite) -> None:
    async with site.socket() as socket:
        await socket.send('{"k": "go", "velocity": "fast"}')
        with pytest.raises(websockets.exceptions.ConnectionClosed) as closed:
            await until(socket, "never")
    assert closed.value.rcvd is not None
    assert closed.value.rcvd.code == 1008
