"""A page of the 3D view without a browser: what viser sends it, folded into the nodes that it would show."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncGenerator, Callable, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass, field
from typing import Any

import msgspec
import websockets.asyncio.client
import zstandard
from websockets.typing import Subprotocol

from editor_web.cell_view import KEY_HEADER, PAGE_HEADER, CellView
from editor_web.security.authentication import OPERATOR, Role
from editor_web.security.middleware import cookie_name
from editor_web.server import Dashboard
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S

VISER = Subprotocol("viser-v1.1.1")
_MAGIC = b"\x28\xb5\x2f\xfd"


@dataclass(kw_only=True)
class Node:
    """A node as one scope, everybody or this page, has it."""

    props: dict[str, Any]
    position: tuple[float, ...] = (0.0, 0.0, 0.0)
    visible: bool = True


@dataclass(kw_only=True)
class ViserPage:
    """The page's end of a connection; `nodes` are by name, then by the scope that has them."""

    socket: websockets.asyncio.client.ClientConnection
    nodes: dict[str, dict[str, Node]] = field(default_factory=dict[str, dict[str, Node]])
    messages: int = 0

    async def until(self, condition: Callable[[], bool]) -> None:
        """Take what comes until this is so."""
        async with asyncio.timeout(GUARD_S):
            while not condition():
                self._take(await self.socket.recv())

    async def idle(self) -> None:
        """Take what is there, until nothing has come for a while."""
        try:
            while True:
                self._take(await asyncio.wait_for(self.socket.recv(), 0.3))
        except TimeoutError:
            return

    async def send(self, kind: str, **fields: object) -> None:
        """Send what a browser sends."""
        await self.socket.send(msgspec.msgpack.encode({"type": kind, **fields}))

    async def send_camera(self) -> None:
        """Say where the page looks from, as a browser does first; only then it counts as connected."""
        await self.send("ViewerCameraMessage", **_CAMERA)

    def node(self, name: str) -> Node | None:
        """The node as this page shows it: its own stands in the place of everybody's."""
        scopes = self.nodes.get(name, {})
        own = [node for owner, node in scopes.items() if owner]
        return own[0] if own else scopes.get("")

    def owner(self, name: str) -> str:
        """The scope that the node is shown of."""
        return next((owner for owner in self.nodes[name] if owner), "")

    def is_seen(self, name: str) -> bool:
        """Whether the node is there and neither it nor what it is below is hidden."""
        parts = name.strip("/").split("/")
        above = [self.node("/" + "/".join(parts[:depth])) for depth in range(1, len(parts) + 1)]
        return above[-1] is not None and all(node is None or node.visible for node in above)

    def _take(self, data: bytes | str) -> None:
        for message in _messages(data):
            self.messages += 1
            name, owner = str(message.get("name", "")), str(message.get("owner", ""))
            scopes = self.nodes.setdefault(name, {}) if name else {}
            if "props" in message and "owner" in message:
                scopes[owner] = Node(props=message["props"])
            elif message["type"] == "RemoveSceneNodeMessage":
                for below in [each for each in self.nodes if each == name or each.startswith(f"{name}/")]:
                    self.nodes[below].pop(owner, None)
            elif owner in scopes:
                node = scopes[owner]
                node.position = tuple(message.get("position", node.position))
                node.visible = message.get("visible", node.visible)
                node.props.update(message.get("updates", {}))


@asynccontextmanager
async def opened_view(backend: FakeBackend) -> AsyncGenerator[CellView]:
    """An open view of a backend's cell."""
    view = CellView(backend, shadows=False)
    await asyncio.to_thread(view.open)
    await view.subscribe()
    try:
        yield view
    finally:
        await view.unsubscribe()
        await asyncio.to_thread(view.close)


@asynccontextmanager
async def viser_page(
    view: CellView, page: str = "", *, headers: Mapping[str, str] | None = None
) -> AsyncGenerator[ViserPage]:
    """Connect a page to a view, with what our own server tells of it in the headers."""
    opening = {KEY_HEADER: view.key, PAGE_HEADER: page, **(headers or {})}
    async with _connected(f"ws://127.0.0.1:{view.port}/", opening) as opened:
        yield opened


@asynccontextmanager
async def served_view(running: Dashboard, page: str, *, role: Role = OPERATOR) -> AsyncGenerator[ViserPage]:
    """Connect as a browser does whose page has this name, through the server and with the cookie of a log-in."""
    origin = running.url.rstrip("/")
    cookie = {"Cookie": f"{cookie_name(running.port)}={running.sessions.begin(role)}"}
    address = f"{origin.replace('http', 'ws', 1)}/cell/{page}/"
    async with _connected(address, cookie, origin=websockets.Origin(origin)) as opened:
        yield opened


@asynccontextmanager
async def _connected(
    address: str, headers: Mapping[str, str], *, origin: websockets.Origin | None = None
) -> AsyncGenerator[ViserPage]:
    async with websockets.asyncio.client.connect(
        address, subprotocols=[VISER], additional_headers=headers, origin=origin, max_size=None, proxy=None
    ) as socket:
        opened = ViserPage(socket=socket)
        await opened.send_camera()
        yield opened


_CAMERA: Mapping[str, object] = {
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


def _messages(data: bytes | str) -> list[dict[str, Any]]:
    raw = data if isinstance(data, bytes) else data.encode()
    packed = zstandard.ZstdDecompressor().decompressobj().decompress(raw[raw.index(_MAGIC) :])
    return msgspec.msgpack.decode(packed)["messages"]
