"""The 3D view of one cell: viser's server, the drawing thread, and the subscribed topics."""

from __future__ import annotations

import asyncio
import logging
import secrets
import threading
import time
from collections.abc import Sequence

import msgspec
import viser

from editor_web.cell_view.handles import DragHandle, DragHandles
from editor_web.cell_view.layers.marks import Marks
from editor_web.cell_view.layers.path_view import interpolate_joints
from editor_web.cell_view.layers.scene_layers import SceneLayers
from editor_web.cell_view.page_cameras import PageCameras
from editor_web.cell_view.page_ghosts import PageGhosts
from editor_web.cell_view.past_view import GhostRequest, PastViews, StateListener
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import ClientLayerGroups, LayerGroup
from editor_web.cell_view.rendering.transforms import poses_by_frame
from editor_web.cell_view.rendering.viser_gateway import new_viser_server
from editor_web.cell_view.topic_subscriptions import TopicSource, TopicSubscriptions
from engine.errors import FlexcellError
from engine.skills.planning import PathPreview

PERIOD_S = 1.0 / 30.0
_log = logging.getLogger("flexcell.cell_view")


class CellView:
    """Draws the bodies, planned paths, obstacles, voxels and cameras of the backend's cell.

    Meshes are sent once; afterwards only changes are sent, at most 30 times a second.

    Args:
        backend: The source of the topics.
        shadows: Whether lights cast shadows; slow without a graphics card.
    """

    def __init__(self, backend: TopicSource, *, shadows: bool = True) -> None:
        self._shadows = shadows
        self.key = secrets.token_urlsafe(32)
        self._server: viser.ViserServer | None = None
        self._groups: ClientLayerGroups | None = None
        self._past: PastViews | None = None
        self._handles: DragHandles | None = None
        self._ghosts: PageGhosts | None = None
        self._cameras: PageCameras | None = None
        self._backend = backend
        self._thread: threading.Thread | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._ending = threading.Event()
        self._latest = LatestMessages()
        self._follower = TopicSubscriptions(backend, self._latest, shown=lambda: self.shown)

    @property
    def port(self) -> int:
        """Viser's loopback port; the view must be open."""
        if self._server is None:
            raise FlexcellError("the cell view is not open", hint="open it first")
        return self._server.get_port()

    @property
    def shown(self) -> frozenset[LayerGroup]:
        """The groups that at least one connected page shows now."""
        return self._groups.shown if self._groups is not None else frozenset()

    def open(self) -> None:
        """Start viser and the drawing thread; takes about 20 ms, call it off the event loop."""
        server = self._server = new_viser_server(self.key)
        server.scene.set_up_direction("+z")
        server.scene.configure_default_lights(cast_shadow=self._shadows)
        self._groups = ClientLayerGroups(server, changed=self._on_shown)
        self._past = PastViews(server, self._groups, find=self._backend.recording_files)
        handles = self._handles = DragHandles(server, changed=self._latest.arrived.set)
        ghosts = self._ghosts = PageGhosts(server, changed=self._latest.arrived.set)
        self._cameras = PageCameras(server)
        self._thread = threading.Thread(
            target=self._write, args=(server, handles, ghosts), name="cell-view", daemon=True
        )
        self._thread.start()

    def show(self, page: str, groups: frozenset[LayerGroup]) -> None:
        """Show exactly these groups on a page; the page's name is in the path from which it loads the view."""
        if self._groups is not None:
            self._groups.show(page, groups)

    def show_past(
        self, page: str, run: str, time_s: float, *, report: StateListener, ghost: GhostRequest | None = None
    ) -> None:
        """Show a run at a time of its clock to a page, and the arms of another one as ghosts.

        `report` is called, on another thread, when it is drawn.
        """
        if self._past is not None:
            self._past.show(page, run, time_s, report=report, ghost=ghost)

    def show_present(self, page: str) -> None:
        """Show the live cell to a page again."""
        if self._past is not None:
            self._past.leave(page)

    def give_handle(self, page: str, handle: DragHandle) -> None:
        """Give an operator's page this drag handle."""
        if self._handles is not None:
            self._handles.give(page, handle)

    def take_handle(self, page: str, handle: DragHandle) -> None:
        """Remove this handle from a page, unless the page has another one by now."""
        if self._handles is not None:
            self._handles.take(page, handle)

    def show_ghost(self, page: str, preview: PathPreview, *, place: int = 0) -> None:
        """Show a preview of an arm to a page, until another one has the same place; the state `none` hides it."""
        if self._ghosts is not None:
            self._ghosts.put(page, preview, place=place)

    def show_marks(self, page: str, marks: Marks) -> None:
        """Show points, a box or axes to a page, in the place of those before."""
        if self._ghosts is not None:
            self._ghosts.mark(page, marks)

    def scrub_path(self, page: str, robot: str, share: float | None) -> None:
        """Show on a page where an arm is at a share, 0 to 1, of its proposed path; None shows nothing more.

        The page hides the group of planned paths meanwhile: its own ghost has the line as well.
        """
        preview = self._latest.paths.get(robot)
        if share is None or preview is None or preview.state != "proposed" or not preview.joints:
            self.show_ghost(page, PathPreview(robot=robot, state="none"))
            return
        # One configuration is a ghost that stands.
        joints = (interpolate_joints(preview.joints, share),)
        self.show_ghost(page, msgspec.structs.replace(preview, joints=joints))

    def look_at(self, page: str, names: Sequence[str]) -> None:
        """Turn the camera of a page to the first of these parts, frames or arms that the cell shows."""
        poses = poses_by_frame(self._latest.frames)
        arms = self._latest.descriptions
        frames = (arms[name].tool_frame if name in arms else name for name in names)
        found = next((poses[frame] for frame in frames if frame in poses), None)
        if found is not None and self._cameras is not None:
            self._cameras.look_at(page, found.xyz)

    async def subscribe(self) -> None:
        """Subscribe to the cell's topics, on the event loop's thread."""
        self._loop = asyncio.get_running_loop()
        await self._follower.open()

    async def unsubscribe(self) -> None:
        """Unsubscribe, on the event loop's thread."""
        self._loop = None
        await self._follower.close()

    def close(self) -> None:
        """End the threads; may take a second, call it off the event loop."""
        self._ending.set()
        self._latest.arrived.set()
        if self._thread is not None:
            self._thread.join()
            self._thread = None
        if self._past is not None:
            self._past.close()
            self._past = None
        if self._server is not None:
            self._server.stop()
            self._server = None

    def _on_shown(self) -> None:
        """Redraw and update the subscriptions after a change of the shown groups; called on any thread."""
        self._latest.arrived.set()
        loop = self._loop
        if loop is not None:
            try:
                loop.call_soon_threadsafe(self._follower.ask)
            except RuntimeError:
                # The loop has just been closed: the subscriptions have ended.
                _log.debug("the last page left after the event loop had ended")

    def _write(self, server: viser.ViserServer, handles: DragHandles, ghosts: PageGhosts) -> None:
        draw = SceneLayers(server)
        wait_s: float | None = None
        while not self._ending.is_set():
            self._latest.arrived.wait(wait_s)
            self._latest.arrived.clear()
            due = (draw.all(self._latest, self.shown), ghosts.draw(self._latest, time.monotonic()))
            handles.draw(self._latest)
            self._ending.wait(PERIOD_S)
            next_s = min((each for each in due if each is not None), default=None)
            wait_s = None if next_s is None else max(0.0, next_s - time.monotonic())
