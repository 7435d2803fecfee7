"""Servers with a fake engine, on an address of their own for each test process."""

from __future__ import annotations

import os
from collections.abc import AsyncGenerator, Callable, Generator
from contextlib import AbstractAsyncContextManager, asynccontextmanager
from pathlib import Path

import httpx
import pytest
from playwright.sync_api import Browser, expect

from editor_web.security.authentication import load_access_tokens
from editor_web.server import Dashboard, dashboard
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S
from tests.editor_web.one_browser import OneBrowser
from tests.editor_web.served import Served
from tests.editor_web.workshop import Workshop

Serve = Callable[..., AbstractAsyncContextManager[Served]]

# How long a page takes depends on what else the machine does; a page that never does it still fails.
expect.set_options(timeout=60_000)


@pytest.fixture(scope="session")
def loopback() -> str:
    """A loopback address that no other test process uses."""
    worker = os.environ.get("PYTEST_XDIST_WORKER", "gw0").removeprefix("gw")
    return f"127.0.0.{20 + int(worker)}"


@pytest.fixture(scope="session")
def one_browser() -> Generator[OneBrowser]:
    """The browser of this test process: to start one takes a second of processor time."""
    opened = OneBrowser()
    yield opened
    opened.close()


@pytest.fixture
def browser(one_browser: OneBrowser) -> Generator[Browser]:
    """The same browser for every test; what a failed one leaves open is closed."""
    with one_browser.driven() as running:
        yield running
        for context in running.contexts if running.is_connected() else ():
            context.close()


@pytest.fixture
def shop(tmp_path: Path, loopback: str) -> Generator[Workshop]:
    """A served session of its own."""
    with Workshop(host=loopback, project=tmp_path) as opened:
        yield opened


@pytest.fixture
def serve(tmp_path: Path, loopback: str) -> Serve:
    """Open a real server around a fake backend: `async with serve() as served`."""

    @asynccontextmanager
    async def opened(backend: FakeBackend | None = None, *, cell_view: bool = False) -> AsyncGenerator[Served]:
        behind = backend or FakeBackend(step_s=0.02)
        token_file = tmp_path / "tokens"
        async with (
            dashboard(behind, token_file=token_file, host=loopback, cell_view=cell_view, shadows=False) as running,
            _client(running, load_access_tokens(token_file).operator) as http,
        ):
            try:
                yield Served(backend=behind, running=running, access=load_access_tokens(token_file), http=http)
            finally:
                await behind.close()

    return opened


def _client(running: Dashboard, token: str) -> httpx.AsyncClient:
    headers = {"Authorization": f"Bearer {token}"}
    return httpx.AsyncClient(base_url=running.url, headers=headers, trust_env=False, timeout=GUARD_S)
