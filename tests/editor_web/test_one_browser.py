"""One browser serves the tests of a process, and tests between them run event loops of their own."""

from __future__ import annotations

import asyncio

import pytest
from playwright.sync_api import Browser

from tests.editor_web.one_browser import OneBrowser


def test_a_loop_runs_between_two_turns_of_the_same_browser(one_browser: OneBrowser) -> None:
    with one_browser.driven() as first:
        assert asyncio.get_running_loop().is_running()
    with pytest.raises(RuntimeError, match="no running event loop"):
        asyncio.get_running_loop()
    assert asyncio.run(asyncio.sleep(0, "slept")) == "slept"
    with one_browser.driven() as second:
        assert second is first
        context = second.new_context()
        assert context.new_page().evaluate("1 + 1") == 2
        context.close()


def test_a_browser_that_has_died_is_replaced(one_browser: OneBrowser) -> None:
    browsers: list[Browser] = []
    for _ in range(2):
        with one_browser.driven() as browser:
            browsers.append(browser)
            browser.close()
    assert browsers[0] is not browsers[1]
