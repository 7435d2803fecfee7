"""The 3D view: locked, drawn once, then moved; through our own server only."""

from __future__ import annotations

import asyncio
import struct
import urllib.error
import urllib.request
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager
from typing import Any

import httpx
import msgspec
import pytest
import websockets.asyncio.client
import zstandard
from websockets.exceptions import InvalidStatus
from websockets.typing import Subprotocol

from editor_web.cell_view import KEY_HEADER, PAGE_HEADER, CellView, LayerGroup
from editor_web.cell_view.rendering.viser_gateway import new_viser_server
from engine.errors import FlexcellError
from engine.messages import SceneDescription
from tests.editor_web.conftest import Serve
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.fake_sights import (
    camera,
    depth,
    description,
    detections,
    frames_with_a_person,
    occupancy,
    planned_path,
    planning_scene,
    scene_with_a_person,
)
from tests.editor_web.limits import GUARD_S
from tests.editor_web.viser_page import opened_view

VISER = Subprotocol("viser-v1.1.1")


async def read(socket: websockets.asyncio.client.ClientConnection, *wanted: str) -> None:
    """Read what viser sends until every wanted text has come."""
    missing = set(wanted)
    async with asyncio.timeout(GUARD_S):
        while missing:
            data = unpacked(await socket.recv())
            missing -= {text for text in missing if text.encode() in data}


def unpacked(message: bytes | str) -> bytes:
    """The message with its compressed part opened."""
    data = message if isinstance(message, bytes) else message.encode()
    begin = data.find(b"\x28\xb5\x2f\xfd")
    return zstandard.ZstdDecompressor().decompressobj().decompress(data[begin:]) if begin >= 0 else data


async def test_the_port_of_the_view_refuses_everybody_without_the_key() -> None:
    """Page 403, websocket 403, wrong key 403; with the key both open."""
    async with opened_view(FakeBackend()) as view:
        page, socket = f"http://127.0.0.1:{view.port}/", f"ws://127.0.0.1:{view.port}/"
        async with httpx.AsyncClient(trust_env=False, timeout=GUARD_S) as http:
            assert (await http.get(page)).status_code == 403
            assert (await http.get(page, headers={KEY_HEADER: "wrong"})).status_code == 403
            assert (await http.get(page, headers={KEY_HEADER: view.key})).status_code == 200
        with pytest.raises(InvalidStatus) as refused:
            await websockets.asyncio.client.connect(socket, subprotocols=[VISER], proxy=None)
        assert refused.value.response.status_code == 403
        headers = {KEY_HEADER: view.key}
        async with websockets.asyncio.client.connect(
            socket, subprotocols=[VISER], additional_headers=headers, proxy=None
        ) as inside:
            assert inside.subprotocol == VISER


async def test_scene_and_motion_reach_the_page_through_our_server(serve: Serve) -> None:
    """Shapes by name first, then the poses of what moves."""
    async with serve(cell_view=True) as served:
        assert (await served.http.get("/cell/")).text.count("data-dock-root") >= 1
        async with websockets.asyncio.client.connect(
            f"{served.origin.replace('http', 'ws', 1)}/cell/",
            subprotocols=[VISER],
            additional_headers=served.cookie,
            origin=websockets.Origin(served.origin),
            max_size=None,
            proxy=None,
        ) as socket:
            await read(socket, "/cell/world/0", "/cell/left.fore/", "/cell/right.base/")
            served.backend.publish("cell/frames", frames_at(3.0))
            await read(socket, "/cell/left.fore")


async def test_a_cell_without_a_world_has_an_empty_view() -> None:
    """Topics that nobody publishes are no error."""
    backend = FakeBackend()

    def refuse(topic: str, callback: object) -> None:
        raise FlexcellError("no such topic", where=topic)

    backend.subscribe_topic = refuse  # pyright: ignore[reportAttributeAccessIssue] # a cell without these topics
    async with opened_view(backend) as view:
        assert view.port > 0


async def test_a_shape_that_cannot_be_drawn_leaves_the_others(caplog: pytest.LogCaptureFixture) -> None:
    """It is named in the log, and the view lives on."""
    backend = FakeBackend()
    scene = new_scene()
    odd = msgspec.structs.replace(scene.geometries[0], name="odd_one", kind="torus")
    backend.publish("cell/scene", SceneDescription(geometries=(odd, *scene.geometries)))
    async with (
        opened_view(backend) as view,
        websockets.asyncio.client.connect(
            f"ws://127.0.0.1:{view.port}/",
            subprotocols=[VISER],
            additional_headers={KEY_HEADER: view.key},
            max_size=None,
            proxy=None,
        ) as socket,
    ):
        await read(socket, "/cell/left.fore/")
    assert "odd_one" in caplog.text


def test_a_view_that_is_not_open_says_so() -> None:
    """No port yet."""
    with pytest.raises(FlexcellError, match="not open"):
        assert CellView(FakeBackend()).port


def test_no_public_tunnel_can_be_asked_for() -> None:
    """Whatever a connected page requests."""
    server = new_viser_server("key")
    try:
        assert server.request_share_url() is None
    finally:
        server.stop()


def test_a_closed_view_answers_no_request() -> None:
    """Its port is free again."""
    view = CellView(FakeBackend(), shadows=False)
    view.open()
    view.close()
    with pytest.raises((urllib.error.URLError, FlexcellError)):
        urllib.request.urlopen(f"http://127.0.0.1:{view.port}/", timeout=1)


async def test_a_viewer_that_was_away_gets_the_latest_poses_and_not_all_that_it_missed(serve: Serve) -> None:
    """Thousands of frames while it reads nothing wait nowhere: only the newest ones are kept for it."""
    async with (
        serve(cell_view=True) as served,
        websockets.asyncio.client.connect(
            f"{served.origin.replace('http', 'ws', 1)}/cell/",
            subprotocols=[VISER],
            additional_headers=served.cookie,
            origin=websockets.Origin(served.origin),
            max_size=None,
            max_queue=1,
            proxy=None,
        ) as socket,
    ):
        await read(socket, "/cell/left.fore/")
        for number in range(5000):
            served.backend.publish("cell/frames", frames_at(3.0 + number * 1e-3))
        last, missed = frames_at(7.999), 0
        newest = struct.pack(">d", last.xyz[last.names.index("left/fore")][0])
        async with asyncio.timeout(GUARD_S):
            while newest not in (data := unpacked(await socket.recv())):
                missed += data.count(b"/cell/left.fore")
        assert missed < 500


def sighted() -> FakeBackend:
    """A backend of a cell with cameras, a person, obstacles and a planned way."""
    backend = FakeBackend()
    backend.publish("left/description", description("left"))
    backend.publish("right/description", description("right"))
    backend.publish("cell/scene", scene_with_a_person())
    backend.publish("cell/frames", frames_with_a_person(0.0))
    backend.publish("cell/planning_scene", planning_scene())
    backend.publish("cell/occupancy", occupancy())
    backend.publish("left/planned_path", planned_path("left"))
    backend.publish("above/camera_info", camera())
    backend.publish("above/depth", depth())
    backend.publish("above/detections", detections())
    return backend


@asynccontextmanager
async def viewer(view: CellView, *, page: str = "") -> AsyncGenerator[websockets.asyncio.client.ClientConnection]:
    """A page that is connected to a view, and has told viser of its camera as a browser does."""
    async with websockets.asyncio.client.connect(
        f"ws://127.0.0.1:{view.port}/",
        subprotocols=[VISER],
        additional_headers={KEY_HEADER: view.key, PAGE_HEADER: page},
        max_size=None,
        proxy=None,
    ) as socket:
        await socket.send(CAMERA)
        yield socket


def camera_message() -> bytes:
    """What viser's page says first: where it looks from."""
    fields: dict[str, Any] = {
        "type": "ViewerCameraMessage",
        "wxyz": (1.0, 0.0, 0.0, 0.0),
        "position": (1.0, 1.0, 1.0),
        "fov": 0.8,
        "near": 0.01,
        "far": 1000.0,
        "image_height": 480,
        "image_width": 640,
        "look_at": (0.0, 0.0, 0.0),
        "up_direction": (0.0, 0.0, 1.0),
    }
    return msgspec.msgpack.encode(fields)


CAMERA = camera_message()


async def until(backend: FakeBackend, condition: Callable[[], bool]) -> None:
    """Wait until the topics of a backend are followed so."""
    async with asyncio.timeout(GUARD_S):
        while not condition():
            await backend.listeners_changed.wait()
            backend.listeners_changed.clear()


async def test_everything_that_is_there_to_see_reaches_the_page() -> None:
    """Each in its group; the bodies of people are none of the cell's."""
    async with opened_view(sighted()) as view, viewer(view) as socket:
        await read(
            socket,
            "/voxels/occupied",
            "/paths/left/line",
            "/paths/left/ghost/fore/",
            "/obstacles/post/0",
            "/people/anna.hand/",
            "/cell/left.fore/",
            "/cameras/above",
            "/detections/above/cup.0/body",
            "/frames/world",
        )


async def test_cameras_and_voxels_are_followed_only_while_somebody_looks_at_them() -> None:
    """For cameras take images only while somebody does."""
    backend = sighted()
    costly = ("cell/occupancy", "above/depth", "above/detections")

    def subscribed() -> list[bool]:
        return [backend.listeners(topic) > 0 for topic in costly]

    async with opened_view(backend) as view:
        assert subscribed() == [False, False, False]
        async with viewer(view, page="one"):
            await until(backend, lambda: subscribed() == [True, False, True])
            view.show("one", frozenset[LayerGroup]({"cameras"}))
            await until(backend, lambda: subscribed() == [False, True, False])
            async with viewer(view, page="two"):
                await until(backend, lambda: subscribed() == [True, True, True])
                view.show("two", frozenset())
                await until(backend, lambda: subscribed() == [False, True, False])
        await until(backend, lambda: subscribed() == [False, False, False])
        assert view.shown == frozenset()
    assert [backend.listeners(topic) for topic in ("cell/frames", "left/planned_path")] == [0, 0]


async def test_a_topic_that_is_made_later_is_followed_with_the_next_page() -> None:
    """As that of an arm which plans for the first time."""
    backend = FakeBackend()
    async with opened_view(backend) as view:
        backend.publish("left/planned_path", planned_path("left"))
        assert backend.listeners("left/planned_path") == 0
        async with viewer(view):
            await until(backend, lambda: backend.listeners("left/planned_path") == 1)


async def test_each_page_shows_what_it_wants(serve: Serve) -> None:
    """What it said before its view was loaded counts, and only for itself."""
    async with serve(sighted(), cell_view=True) as served, served.live() as live:
        await live.send({"k": "show", "page": "mine", "groups": ["cameras"]})
        await live.until("snapshot")
        await until(served.backend, lambda: served.backend.listeners("left/planned_path") > 0)
        async with websockets.asyncio.client.connect(
            f"{served.origin.replace('http', 'ws', 1)}/cell/mine",
            subprotocols=[VISER],
            additional_headers=served.cookie,
            origin=websockets.Origin(served.origin),
            max_size=None,
            proxy=None,
        ) as socket:
            await socket.send(CAMERA)
            await until(served.backend, lambda: served.backend.listeners("above/depth") == 1)
            assert served.backend.listeners("cell/occupancy") == 0
            await live.send({"k": "show", "page": "mine", "groups": ["voxels"]})
            await until(served.backend, lambda: served.backend.listeners("cell/occupancy") == 1)
            await until(served.backend, lambda: served.backend.listeners("above/depth") == 0)


@pytest.mark.parametrize("name", ["UPPER", "a%20b", "x" * 41, "a.b"])
async def test_a_page_of_a_name_that_is_none_is_refused(serve: Serve, name: str) -> None:
    """It would go into a header."""
    async with serve(cell_view=True) as served:
        assert (await served.http.get(f"/cell/{name}/")).status_code == 404
        assert (await served.http.get("/cell/a1/")).status_code == 200
