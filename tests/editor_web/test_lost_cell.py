"""A cell that has lost its world, in a real browser: why, connecting it again, and what is refused meanwhile."""

from __future__ import annotations

from typing import Any

from playwright.sync_api import Browser, Page, Route, expect

from tests.editor_web.browsing import opened_page, require_accessible
from tests.editor_web.workshop import Workshop

REASON = "the world's process ended with signal 9"
REFUSAL = {"message": "the world cannot be started", "where": "cell", "hint": "see the log of the server"}


class Cell:
    """What the server tells of the connection of its cell, and what it answers to connecting it."""

    def __init__(self, page: Page) -> None:
        self.state: dict[str, Any] = {"connected": False, "reason": REASON}
        self.refuses = True
        self.connects = 0
        page.route("**/api/v1/cell/connection", lambda route: route.fulfill(json=self.state))
        page.route("**/api/v1/cell/connect", self._connect)

    def _connect(self, route: Route) -> None:
        assert route.request.post_data_json == {}
        self.connects += 1
        if self.refuses:
            route.fulfill(status=409, json=REFUSAL)
            return
        self.state = {"connected": True, "reason": ""}
        route.fulfill(json=self.state)


def test_a_lost_cell_says_why_and_is_connected_again(browser: Browser, shop: Workshop) -> None:
    """An arm's fault makes the page ask; a refusal is shown; once connected the words are gone."""
    with opened_page(browser, shop.running, quiet=False) as page:
        cell = Cell(page)
        expect(page.get_by_role("listitem", name="Arm left")).to_be_visible()
        shop.on_loop(lambda: shop.arm.become("fault", error=REASON))
        banner = page.get_by_role("alert").filter(has_text="The cell is not connected")
        expect(banner).to_contain_text(REASON)
        require_accessible(page, "a lost cell", part="[role=alert]")
        banner.get_by_role("button", name="Connect again").click()
        expect(banner).to_contain_text("the world cannot be started – see the log of the server")
        assert cell.connects == 1
        cell.refuses = False
        banner.get_by_role("button", name="Connect again").click()
        expect(banner).to_have_count(0)
