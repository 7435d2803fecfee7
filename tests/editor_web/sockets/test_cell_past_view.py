"""The connection over which a page asks for past moments in its 3D view."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
import websockets.asyncio.client
from websockets.exceptions import ConnectionClosed, InvalidStatus

from editor_web.security.authentication import VIEWER
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.limits import GUARD_S
from tests.editor_web.past_recording import write_recording
from tests.editor_web.served import Served, session_cookie
from tests.editor_web.viser_page import VISER, ViserPage

PAGE = "a1b2"


@pytest.fixture
def backend(tmp_path: Path) -> FakeBackend:
    """With a recording of ten seconds."""
    fake = FakeBackend()
    frames = [(at / 10, frames_at(at / 10)) for at in range(101)]
    content = {"cell/scene": [(0.0, new_scene())], "cell/frames": frames}
    fake.recorded["run"] = (write_recording(tmp_path / "run.mcap", content),)
    return fake


@asynccontextmanager
async def past_of(
    served: Served, page: str = PAGE, *, cookie: dict[str, str] | None = None
) -> AsyncGenerator[websockets.asyncio.client.ClientConnection]:
    """The connection as the page opens it."""
    async with websockets.asyncio.client.connect(
        f"{served.origin.replace('http', 'ws', 1)}/api/v1/cell/past/{page}",
        additional_headers=served.cookie if cookie is None else cookie,
        origin=websockets.Origin(served.origin),
        proxy=None,
    ) as socket:
        yield socket


@asynccontextmanager
async def shown(served: Served) -> AsyncGenerator[ViserPage]:
    """The 3D view of the page, through our own server."""
    async with websockets.asyncio.client.connect(
        f"{served.origin.replace('http', 'ws', 1)}/cell/{PAGE}/",
        subprotocols=[VISER],
        additional_headers=served.cookie,
        origin=websockets.Origin(served.origin),
        max_size=None,
        proxy=None,
    ) as socket:
        view = ViserPage(socket=socket)
        await view.send_camera()
        await view.until(lambda: view.is_seen("/cell/left.fore"))
        yield view


async def ask(socket: websockets.asyncio.client.ClientConnection, time_s: float | None, run: str = "run") -> None:
    """Ask for a moment."""
    await socket.send(json.dumps({"run": run, "time_s": time_s}))


async def state_at(socket: websockets.asyncio.client.ClientConnection, time_s: float) -> dict[str, Any]:
    """What the page is told of a moment."""
    async with asyncio.timeout(GUARD_S):
        while (state := json.loads(await socket.recv()))["time_s"] != time_s:
            pass
    return state


async def test_a_moment_is_shown_and_reported_and_null_shows_the_present(serve: Serve, backend: FakeBackend) -> None:
    async with serve(backend, cell_view=True) as served, shown(served) as view, past_of(served) as past:
        await ask(past, 4.0)
        assert await state_at(past, 4.0) == {
            "run": "run",
            "time_s": 4.0,
            "from_s": 0.0,
            "until_s": 10.0,
            "problem": "",
            "ghost_problem": "",
        }
        await view.until(lambda: view.is_seen("/past/cell/left.fore") and not view.is_seen("/cell/left.fore"))
        await ask(past, None)
        await view.until(lambda: view.is_seen("/cell/left.fore") and not view.is_seen("/past/cell/left.fore"))


async def test_a_page_whose_connection_ends_sees_the_present(serve: Serve, backend: FakeBackend) -> None:
    async with serve(backend, cell_view=True) as served, shown(served) as view:
        async with past_of(served) as past:
            await ask(past, 4.0)
            await view.until(lambda: view.is_seen("/past/cell/left.fore"))
        await view.until(lambda: view.is_seen("/cell/left.fore") and not view.is_seen("/past/cell/left.fore"))


async def test_of_many_instants_the_latest_is_shown(serve: Serve, backend: FakeBackend) -> None:
    async with serve(backend, cell_view=True) as served, shown(served), past_of(served) as past:
        for step in range(300):
            await ask(past, step / 40)
        await state_at(past, 299 / 40)


async def test_a_run_without_a_recording_is_reported_in_words(serve: Serve, backend: FakeBackend) -> None:
    async with serve(backend, cell_view=True) as served, shown(served) as view, past_of(served) as past:
        await ask(past, 1.0, run="other")
        assert (await state_at(past, 1.0))["problem"] == "this run has no recording"
        assert view.is_seen("/cell/left.fore")


async def test_a_viewer_may_look_at_the_past_too(serve: Serve, backend: FakeBackend) -> None:
    async with serve(backend, cell_view=True) as served:
        cookie = session_cookie(served.running, VIEWER)
        async with shown(served), past_of(served, cookie=cookie) as past:
            await ask(past, 2.0)
            assert (await state_at(past, 2.0))["problem"] == ""


@pytest.mark.parametrize(
    "message", ["", "[]", '{"run": "run"}', '{"run": "", "time_s": 1}', '{"run": 3, "time_s": 1}', '{"time_s": 1e999}']
)
async def test_what_is_no_order_ends_the_connection(serve: Serve, backend: FakeBackend, message: str) -> None:
    async with serve(backend, cell_view=True) as served, past_of(served) as past:
        await past.send(message)
        with pytest.raises(ConnectionClosed) as closed:
            await past.recv()
        assert closed.value.rcvd is not None
        assert closed.value.rcvd.code == 1008


async def test_nobody_asks_without_a_token_or_from_elsewhere(serve: Serve, backend: FakeBackend) -> None:
    async with serve(backend, cell_view=True) as served:
        with pytest.raises(InvalidStatus):
            async with past_of(served, cookie={}):
                pass
        for page in ("UPPER", "x" * 41, "a.b"):
            with pytest.raises((InvalidStatus, ConnectionClosed)):
                async with past_of(served, page) as past:
                    await past.recv()


async def test_a_server_without_a_view_refuses(serve: Serve, backend: FakeBackend) -> None:
    async with serve(backend, cell_view=False) as served:
        with pytest.raises((InvalidStatus, ConnectionClosed)):
            async with past_of(served) as past:
                await past.recv()
