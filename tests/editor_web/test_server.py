"""Where the server listens, and what it says when it cannot."""

from __future__ import annotations

import asyncio
import signal
from pathlib import Path

import httpx
import pytest

from editor_web.server import Dashboard, dashboard, serve
from engine.errors import FlexcellError
from tests.editor_web.fake_backend import FakeBackend
from tests.editor_web.limits import GUARD_S


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.10", "::", "127.evil.example", "example.org", ""])
async def test_only_loopback_is_served(tmp_path: Path, host: str) -> None:
    """Everything else is refused with the way to do it."""
    with pytest.raises(FlexcellError, match=r"this machine only.*ssh -L"):
        async with dashboard(FakeBackend(), token_file=tmp_path / "tokens", host=host, cell_view=False):
            pass


async def test_a_taken_port_is_named(tmp_path: Path, loopback: str) -> None:
    """And the option to change it."""
    async with dashboard(FakeBackend(), token_file=tmp_path / "t", host=loopback, cell_view=False) as first:
        with pytest.raises(FlexcellError, match=rf"cannot listen on {loopback}:{first.port}.*another --port"):
            async with dashboard(
                FakeBackend(), token_file=tmp_path / "t", host=loopback, port=first.port, cell_view=False
            ):
                pass


async def test_the_printed_address_logs_in(tmp_path: Path, loopback: str) -> None:
    """One click from the terminal to the page."""
    async with (
        dashboard(FakeBackend(), token_file=tmp_path / "tokens", host=loopback, cell_view=False) as running,
        httpx.AsyncClient(trust_env=False, timeout=GUARD_S) as browser,
    ):
        answer = await browser.get(running.new_login_url())
        assert (answer.status_code, answer.headers["location"]) == (303, "/")
        ours = {"Sec-Fetch-Site": "same-origin"}
        assert (await browser.get(f"{running.url}api/v1/session", headers=ours)).json()["role"] == "operator"


async def test_the_licences_of_the_page_are_handed_out(tmp_path: Path, loopback: str) -> None:
    """As text, to whoever may see the page; never kept, since the next version of the page has others."""
    async with (
        dashboard(FakeBackend(), token_file=tmp_path / "tokens", host=loopback, cell_view=False) as running,
        httpx.AsyncClient(base_url=running.url, trust_env=False, timeout=GUARD_S) as browser,
    ):
        assert (await browser.get("THIRD-PARTY-NOTICES.txt")).status_code == 401
        await browser.get(running.new_login_url())
        answer = await browser.get("THIRD-PARTY-NOTICES.txt")
        assert answer.headers["content-type"] == "text/plain; charset=utf-8"
        assert answer.headers["cache-control"] == "no-store"
        assert "@mantine/core" in answer.text


async def test_serving_ends_when_cancelled_and_leaves_the_signals_alone(tmp_path: Path, loopback: str) -> None:
    """Ctrl-C belongs to whoever runs the cell."""
    before = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
    ready: asyncio.Future[Dashboard] = asyncio.get_running_loop().create_future()
    task = asyncio.create_task(
        serve(FakeBackend(), token_file=tmp_path / "tokens", host=loopback, on_ready=ready.set_result)
    )
    running = await ready
    assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)) == before
    task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await task
    async with httpx.AsyncClient(trust_env=False, timeout=GUARD_S) as browser:
        with pytest.raises(httpx.ConnectError):
            await browser.get(running.url)
