"""Drag handles in the 3D view, each for one page of an operator.

A handle does not move anything itself: it is drawn at its frame and reports how it is dragged.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import viser

from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.transforms import WorldPose, is_visible_change, poses_by_frame
from editor_web.cell_view.rendering.viser_gateway import PAGE, ROLE
from editor_web.security.authentication import OPERATOR
from engine.messages import FramePoses

_NODE = "/handle"
_SIZE_M = 0.22
_BALL_M = 0.02
_COLOUR = (37, 99, 235)


@dataclass(frozen=True, kw_only=True)
class HandlePull:
    """A drag of a handle: `pose` is the pose under the mouse, in the world."""

    phase: Literal["start", "update", "end"]
    pose: WorldPose


@dataclass(frozen=True, kw_only=True)
class DragHandle:
    """A handle at a frame, or at a pose `at` in the world; `turns` allows rotation.

    `pulled` is called on viser's thread.
    """

    frame: str = ""
    turns: bool
    pulled: Callable[[HandlePull], None]
    at: WorldPose | None = None


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
        server: The viser server of the pages.
        changed: Called, on any thread, when handles need to be drawn.
    """

    def __init__(self, server: viser.ViserServer, *, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._lock = threading.Lock()
        self._given: dict[str, DragHandle] = {}
        self._clients: dict[int, _Client] = {}
        self._frames: FramePoses | None = None
        self._is_due = False
        # Coroutines, because these run in the context of the connection, where `PAGE` and `ROLE` are.
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)

    def give(self, page: str, handle: DragHandle) -> None:
        """Give a page this handle, instead of its previous one."""
        with self._lock:
            self._given[page] = handle
            self._is_due = True
        self._changed()

    def take(self, page: str, handle: DragHandle) -> None:
        """Remove this handle from a page, unless the page has another one by now."""
        with self._lock:
            if self._given.get(page) is not handle:
                return
            del self._given[page]
            self._is_due = True
        self._changed()

    def draw(self, latest: LatestMessages) -> None:
        """Draw the handles that are not dragged at their frames."""
        with self._lock:
            if latest.frames is self._frames and not self._is_due:
                return
            self._frames, self._is_due = latest.frames, False
            clients = [client for client in self._clients.values() if client.may_operate]
            poses: Mapping[str, WorldPose] = poses_by_frame(latest.frames) if latest.frames is not None else {}
            for client in clients:
                given = self._given.get(client.page)
                self._draw(client, (given.at or poses.get(given.frame)) if given is not None else None)

    def _draw(self, client: _Client, pose: WorldPose | None) -> None:
        given = self._given.get(client.page)
        if client.control is not None and (client.given is not given or pose is None):
            client.control.remove()
            client.control, client.is_held = None, False
        client.given = given
        if given is None or pose is None:
            return
        if client.control is None:
            # Sent atomically: viser sends a node as visible first, and a press before the callback is set is lost.
            with client.handle.atomic():
                client.control = _new_control(client, given, pose, self._pulled)
        elif client.is_held or not is_visible_change(client.placed, pose):
            return
        else:
            client.control.position, client.control.wxyz = pose.xyz, pose.wxyz
        client.placed = pose

    def _pulled(self, client: _Client, given: DragHandle, pull: HandlePull) -> None:
        """Handle a drag, on viser's thread."""
        with self._lock:
            if client.given is not given:
                return
            client.is_held = pull.phase != "end"
            # After the release, it is drawn at its frame again.
            client.placed = None
            self._is_due = True
        given.pulled(pull)
        if pull.phase == "end":
            self._changed()

    async def _connected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients[client.client_id] = _Client(
                handle=client, page=PAGE.get(), may_operate=ROLE.get() == OPERATOR
            )
            self._is_due = True
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

    # A coroutine, because coroutines are called in the order of the events.
    async def on_update(event: viser.TransformControlsEvent) -> None:
        x, y, z = (float(value) for value in event.target.position)
        w, a, b, c = (float(value) for value in event.target.wxyz)
        pulled(client, given, HandlePull(phase=event.phase, pose=WorldPose(xyz=(x, y, z), xyzw=(a, b, c, w))))

    control.on_update(on_update)
    # A visible handle can be dragged.
    control.visible = True
    return control
