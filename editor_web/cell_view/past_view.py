"""Past states of runs in the 3D view of single pages, while all other pages show the live cell."""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated

import msgspec
import viser

from editor_web.cell_view.layers.run_ghost import RunGhost
from editor_web.cell_view.layers.scene_layers import SceneLayers
from editor_web.cell_view.recorded_scene import RecordedScene
from editor_web.cell_view.rendering.canvas import PAST
from editor_web.cell_view.rendering.latest_messages import LatestMessages
from editor_web.cell_view.rendering.layer_groups import ClientLayerGroups
from editor_web.cell_view.rendering.viser_gateway import PAGE
from engine.errors import FlexcellError

FindFiles = Callable[[str], Sequence[Path]]
PERIOD_S = 1.0 / 30.0
_KEPT_RUNS = 4
_KEPT_PAGES = 200
_log = logging.getLogger("flexcell.cell_view")


class GhostRequest(msgspec.Struct, frozen=True, kw_only=True):
    """Another run whose arms are shown as ghosts, at a time of its own clock."""

    run: Annotated[str, msgspec.Meta(min_length=1, max_length=500)]
    time_s: float


class PastViewState(msgspec.Struct, frozen=True, kw_only=True):
    """What a page shows: a run at a time of its recording; or a `problem`, and the live cell.

    `ghost_problem` says why the arms of the other run are not shown.
    """

    run: str
    time_s: float
    from_s: float = 0.0
    until_s: float = 0.0
    problem: str = ""
    ghost_problem: str = ""


StateListener = Callable[[PastViewState], None]


@dataclass(frozen=True, kw_only=True)
class _ViewRequest:
    run: str
    time_s: float
    ghost: GhostRequest | None
    report: StateListener


@dataclass(kw_only=True)
class _Client:
    """One connected page; its own drawing exists from its first past view on."""

    handle: viser.ClientHandle
    page: str
    latest: LatestMessages = field(default_factory=LatestMessages)
    drawing: SceneLayers | None = None
    other: LatestMessages = field(default_factory=LatestMessages)
    ghost: RunGhost | None = None
    """The arms of another run, and what they are drawn from."""
    wish: _ViewRequest | None = None
    due_s: float | None = None


class PastViews:
    """Draws past states, each for its page only, on a separate thread; the latest of several requests wins.

    Args:
        server: The viser server of the pages.
        groups: The layer groups of each page.
        find: Returns the recordings of a run, oldest first; called on any thread.
    """

    def __init__(self, server: viser.ViserServer, groups: ClientLayerGroups, *, find: FindFiles) -> None:
        self._groups = groups
        self._find = find
        self._lock = threading.Lock()
        self._wishes: OrderedDict[str, _ViewRequest] = OrderedDict()
        self._clients: dict[int, _Client] = {}
        self._runs: OrderedDict[str, RecordedScene] = OrderedDict()
        self._wake = threading.Event()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._work, name="cell-past", daemon=True)
        # Coroutines, because these run in the context of the connection, where `PAGE` is.
        server.on_client_connect(self._connected)
        server.on_client_disconnect(self._disconnected)
        self._thread.start()

    def show(
        self, page: str, run: str, time_s: float, *, report: StateListener, ghost: GhostRequest | None = None
    ) -> None:
        """Show a run at a time of its clock to a page, and the arms of another one as ghosts.

        `report` is called, on another thread, when it is drawn.
        """
        with self._lock:
            self._wishes.pop(page, None)
            self._wishes[page] = _ViewRequest(run=run, time_s=time_s, ghost=ghost, report=report)
            while len(self._wishes) > _KEPT_PAGES:
                self._wishes.popitem(last=False)
        self._wake.set()

    def leave(self, page: str) -> None:
        """Show the live cell to a page again."""
        with self._lock:
            self._wishes.pop(page, None)
            self._groups.show_past(self._groups.past - {page})

    def close(self) -> None:
        """End the thread and close the recordings; blocks, so call it off the event loop."""
        self._ending.set()
        self._wake.set()
        self._thread.join()

    async def _connected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients[client.client_id] = _Client(handle=client, page=PAGE.get())
        self._wake.set()

    async def _disconnected(self, client: viser.ClientHandle) -> None:
        with self._lock:
            self._clients.pop(client.client_id, None)

    def _work(self) -> None:
        wait_s: float | None = None
        while not self._ending.is_set():
            self._wake.wait(wait_s)
            self._wake.clear()
            due_s = self._draw_all()
            wait_s = None if due_s is None else max(0.0, due_s - time.monotonic())
            self._ending.wait(PERIOD_S)
        for run in self._runs.values():
            run.close()

    def _draw_all(self) -> float | None:
        """Draw the requests; return the monotonic time at which to draw again without a new request."""
        with self._lock:
            wishes = dict(self._wishes)
            clients = [client for client in self._clients.values() if client.page in wishes]
        due: list[float] = []
        for client in clients:
            wish = wishes[client.page]
            try:
                self._draw(client, wish)
            except Exception as error:
                # Whatever the file contains: this page shows the live cell again, the others keep their view.
                expected = isinstance(error, FlexcellError)
                level = logging.INFO if expected else logging.ERROR
                _log.log(level, "cannot show a past state of %s: %s", wish.run, error, exc_info=not expected)
                problem = error.message if expected else "its recording cannot be shown"
                self._end(client.page, wish)
                wish.report(PastViewState(run=wish.run, time_s=wish.time_s, problem=problem))
                continue
            if client.due_s is not None:
                due.append(client.due_s)
        return min(due, default=None)

    def _end(self, page: str, wish: _ViewRequest) -> None:
        with self._lock:
            if self._wishes.get(page) is wish:
                del self._wishes[page]
            self._groups.show_past(self._groups.past - {page})

    def _draw(self, client: _Client, wish: _ViewRequest) -> None:
        before, is_new = client.wish, client.wish is not wish
        if is_new:
            is_another_run = before is None or before.run != wish.run
            run = self._opened(wish.run, is_another=is_another_run)
            if is_another_run or client.drawing is None:
                self._groups.clear_past(client.handle.client_id)
                client.latest, client.drawing = LatestMessages(), SceneLayers(client.handle, under=PAST)
                client.other, client.ghost = LatestMessages(), RunGhost(client.handle)
            run.show(client.latest, wish.time_s)
            client.wish = wish
        elif client.due_s is None:
            return
        if client.drawing is not None:
            # No animation: unlike in the live view, ghosts do not move in a loop.
            client.due_s = client.drawing.all(client.latest, frozenset())
        if is_new:
            # Before the other run is opened, which may close this one.
            from_s, until_s = self._runs[wish.run].span_s
            ghost_problem = self._draw_ghost(client, wish, before)
            with self._lock:
                # Only after drawing; meanwhile the page may have returned to the live view.
                if client.page in self._wishes:
                    self._groups.show_past(self._groups.past | {client.page})
            wish.report(
                PastViewState(
                    run=wish.run, time_s=wish.time_s, from_s=from_s, until_s=until_s, ghost_problem=ghost_problem
                )
            )

    def _draw_ghost(self, client: _Client, wish: _ViewRequest, before: _ViewRequest | None) -> str:
        """Draw the ghosts that are requested; return why they are not drawn, empty if they are."""
        ghost, known = client.ghost, before.ghost if before is not None else None
        if ghost is None:
            return ""
        if wish.ghost is None or known is None or known.run != wish.ghost.run:
            ghost.clear()
            client.other = LatestMessages()
        if wish.ghost is None:
            return ""
        try:
            other = self._opened(wish.ghost.run, is_another=known is None or known.run != wish.ghost.run)
            other.show(client.other, wish.ghost.time_s)
        except FlexcellError as error:
            # The run itself is shown all the same.
            ghost.clear()
            return error.message
        ghost.draw(client.other)
        return ""

    def _opened(self, run: str, *, is_another: bool) -> RecordedScene:
        known = self._runs.pop(run, None)
        # A resumed run has one more file; an ended run has been moved, but the open file remains valid.
        if known is None or (is_another and len(self._find(run)) != len(known.files)):
            if known is not None:
                known.close()
            known = RecordedScene(self._find(run))
        self._runs[run] = known
        while len(self._runs) > _KEPT_RUNS:
            self._runs.popitem(last=False)[1].close()
        return known
