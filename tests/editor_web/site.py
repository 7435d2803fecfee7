"""A server in a thread of its own, for tests that drive a browser; it can be restarted."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Coroutine
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any, Self, TypeVar

from editor_web.server import Dashboard, dashboard
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S

T = TypeVar("T")


class Site:
    """`with Site(…) as site`: the page is at `site.running.url`."""

    def __init__(self, *, host: str, folder: Path, step_s: float = 1.0, cell_view: bool = False) -> None:
        self.backend = FakeBackend(step_s=step_s)
        self._host, self._token_file, self._cell_view = host, folder / "tokens", cell_view
        self._port = 0
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, name="site")
        self._open: AsyncExitStack | None = None
        self._running: Dashboard | None = None

    @property
    def running(self) -> Dashboard:
        """Where it is."""
        assert self._running is not None
        return self._running

    def call(self, work: Coroutine[Any, Any, T]) -> T:
        """Run a coroutine on the server's loop."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(timeout=GUARD_S)

    def up(self) -> None:
        """Serve, on the same port as before."""
        self.call(self._up())

    def down(self, *, forget: bool = False) -> None:
        """End the server; `forget` also throws its tokens away."""
        self.call(self._down())
        if forget:
            self._token_file.unlink()

    def __enter__(self) -> Self:
        self._thread.start()
        self.up()
        return self

    def __exit__(self, *_: object) -> None:
        self.down()
        self.call(self.backend.close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _up(self) -> None:
        self._open = AsyncExitStack()
        self._running = await self._open.enter_async_context(
            dashboard(
                self.backend,
                token_file=self._token_file,
                host=self._host,
                port=self._port,
                cell_view=self._cell_view,
                shadows=False,
            )
        )
        self._port = self._running.port

    async def _down(self) -> None:
        if self._open is not None:
            await self._open.aclose()
            self._open = None
