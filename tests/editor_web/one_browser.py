"""The browser of a test process: started once, and out of the way of tests that run an event loop of their own."""

from __future__ import annotations

import asyncio
from asyncio import events
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

from playwright.sync_api import Browser, sync_playwright

from tests.editor_web.browsing import browser_program

# Playwright leaves its loop running between two calls, and asyncio then runs no other one in the thread. This
# function, which is there for those who write loops, is the only way to say that the loop pauses.
_set_running_loop: Any = getattr(events, "_set_running_loop")  # noqa: B009 - pyright knows it as private


class OneBrowser:
    """A browser that is used in turns: `with one.driven() as browser`; `close` ends it."""

    def __init__(self) -> None:
        self._playwright = sync_playwright().start()
        self._loop = asyncio.get_running_loop()
        self._browser: Browser | None = None
        _set_running_loop(None)

    @contextmanager
    def driven(self) -> Generator[Browser]:
        """Let Playwright's loop run meanwhile; a browser that has died is replaced."""
        with self._turn():
            if self._browser is None or not self._browser.is_connected():
                self._browser = self._playwright.chromium.launch(
                    executable_path=browser_program(), args=["--no-sandbox"]
                )
            yield self._browser

    def close(self) -> None:
        """End the browser and its driver."""
        with self._turn():
            if self._browser is not None:
                self._browser.close()
            self._playwright.stop()

    @contextmanager
    def _turn(self) -> Generator[None]:
        _set_running_loop(self._loop)
        try:
            yield
        finally:
            _set_running_loop(None)
