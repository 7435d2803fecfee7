"""Handles to pull at in the 3D view, each for one page whose person may operate.

A handle moves nothing by itself: it stands where its frame is, and tells how it is pulled.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import viser

from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.transforms import WorldPose, poses_by_frame
from editor_web.cell_view.rendering.viser_gateway import PAGE, ROLE
from editor_web.security.authentication import OPERATOR
from engine.messages import FramePoses

_NODE = "/handle"
_SIZE_M = 0.22
_BALL_M = 0.02
_COLOUR = (37, 99, 235)


@dataclass(frozen=True, kw_only=True)
class HandlePull:
    """How a handle is pulled: `pose` is where the mouse has it, in the world."""

    phase: Literal["start", "update", "end"]
    pose: WorldPose


@dataclass(frozen=True, kw_only=True)
class DragHandle:
    """A handle at a frame; `turns` where it can be turned too. `pulled` is called on viser's thread."""

    frame: str
    turns: bool
    pulled: Callable[[HandlePull], None]


@dataclass(kw_only=True)
class _Client:
    handle: viser.ClientHandle
    page: str
    may_operate: bool
    given: DragHandle | None = None
    control: viser.TransformControlsHandle | None = None
    is_held: bool = False
    placed: WorldPose | None = None


class DragHandles:
    """The handles of all pages.

    Args:
        server: Of the pages.
        changed: Called, on any thread, when handles are to be placed.
    """

    def __init__(self, server: viser.ViserServer, *, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._lock = threading.Lock()
        self._given: dict[str, DragHandle] = {}
        self._clients: dict[int, _Client] = {}
        self._frames: FramePoses | None = None
        # Coroutines, because these run in the context of the connection, where `PAGE` and `ROLE` are.
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)

    def give(self, page: str, handle: DragHandle) -> None:
        """Give a page this handle, instead of the one that it has."""
        with self._lock:
            self._given[page] = handle
            self._frames = None
        self._changed()

    def take(self, page: str, handle: DragHandle) -> None:
        """Take this handle away from a page, which may have got another one since."""
        with self._lock:
            if self._given.get(page) is not handle:
                return
            del self._given[page]
            self._frames = None
        self._changed()

    def draw(self, newest: LatestMessages) -> None:
        """Place the handles that nobody holds where their frames are."""
        with self._lock:
            if newest.frames is None or newest.frames is self._frames:
                return
            self._frames = newest.frames
            clients = [client for client in self._clients.values() if client.may_operate]
            poses = poses_by_frame(newest.frames)
            for client in clients:
                self._draw(client, poses.get(given.frame) if (given := self._given.get(client.page)) else None)

    def _draw(self, client: _Client, pose: WorldPose | None) -> None:
        given = self._given.get(client.page)
        if client.control is not None and (client.given is not given or pose is None):
            client.control.remove()
            client.control, client.is_held = None, False
        client.given = given
        if given is None or pose is None:
            return
        if client.control is None:
            # Sent as one: viser sends a node as seen first, and a press before somebody listens to it is lost.
            with client.handle.atomic():
                client.control = _new_control(client, given, pose, self._pulled)
        elif not client.is_held and pose != client.placed:
            client.control.position, client.control.wxyz = pose.xyz, pose.wxyz
        client.placed = pose

    def _pulled(self, client: _Client, given: DragHandle, pull: HandlePull) -> None:
        """On viser's thread."""
        with self._lock:
            if client.given is not given:
                return
            client.is_held = pull.phase != "end"
            # Let go, it stands at its frame again.
            client.placed = None
            self._frames = None
        given.pulled(pull)
        if pull.phase == "end":
            self._changed()

    async def _connected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients[client.client_id] = _Client(
                handle=client, page=PAGE.get(), may_operate=ROLE.get() == OPERATOR
            )
            self._frames = None
        self._changed()

    async def _disconnected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients.pop(client.client_id, None)


def _new_control(
    client: _Client, given: DragHandle, pose: WorldPose, pulled: Callable[[_Client, DragHandle, HandlePull], None]
) -> viser.TransformControlsHandle:
    scene = client.handle.scene
    control = scene.add_transform_controls(
        _NODE,
        scale=_SIZE_M,
        disable_rotations=not given.turns,
        depth_test=False,
        position=pose.xyz,
        wxyz=pose.wxyz,
        visible=False,
    )
    scene.add_icosphere(f"{_NODE}/ball", radius=_BALL_M, color=_COLOUR, cast_shadow=False)

    # A coroutine, because those are called in the order of what happened.
    async def on_update(event: viser.TransformControlsEvent) -> None:
        x, y, z = (float(value) for value in event.target.position)
        w, a, b, c = (float(value) for value in event.target.wxyz)
        pulled(client, given, HandlePull(phase=event.phase, pose=WorldPose(xyz=(x, y, z), xyzw=(a, b, c, w))))

    control.on_update(on_update)
    # Whoever can see it can pull at it.
    control.visible = True
    return control
