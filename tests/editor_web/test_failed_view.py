"""A view that fails in a real browser: it says so and tries again, and everything else goes on, STOP first of all."""

from __future__ import annotations

import re

from playwright.sync_api import Browser, Page, Route, expect

from tests.editor_web.browsing import fetched, opened_page, require_accessible
from tests.editor_web.stop_process import stop_button
from tests.editor_web.workshop import SHIFT_ID, Workshop

BEHAVIOR = re.compile(r"/api/v1/behaviors/behaviors/shift\.yaml$")


def damaged(page: Page, changes: dict[str, object]) -> None:
    """Let the page be answered what it cannot read."""

    def answer(route: Route) -> None:
        told = fetched(route)
        route.fulfill(response=told, json={**told.json(), **changes})

    page.route(BEHAVIOR, answer)
    page.reload()


def test_a_tab_that_fails_leaves_the_others(browser: Browser, shop: Workshop) -> None:
    """Try again shows it once it can be shown; the details can be copied."""
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}", quiet=False) as page:
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        finding = {
            "severity": "error",
            "code": "x",
            "message": {"a": 1},
            "path": "",
            "line": 1,
            "column": 1,
            "hint": "",
        }
        damaged(page, {"findings": [finding]})
        failed = page.get_by_role("alert", name="Failure of Problems")
        page.get_by_role("tab", name="Problems").click()
        expect(failed).to_contain_text("Problems cannot be shown")
        expect(failed).to_contain_text("is not a function")
        require_accessible(page, "a view that failed", part="[aria-label^='Failure of']")
        failed.get_by_role("button", name="Copy details").click()
        expect(failed.get_by_role("button", name="Copied")).to_be_visible()
        assert "Problems at /behaviors" in page.evaluate("navigator.clipboard.readText()")
        expect(page.get_by_role("application")).to_be_visible()
        expect(stop_button(page)).to_be_enabled()
        page.get_by_role("tab", name="Start", exact=True).click()
        expect(page.get_by_label("Dwell")).to_be_visible()
        page.get_by_role("tab", name="Problems").click()
        failed.get_by_role("button", name="Try again").click()
        # What it shows is as it was.
        expect(failed).to_be_visible()


def test_a_form_that_fails_leaves_the_run_control(browser: Browser, shop: Workshop) -> None:
    """The run is paused although its form cannot be shown."""
    run = shop.start()
    with opened_page(browser, shop.running, f"/runs/{run}", quiet=False) as page:
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Running")
        damaged(page, {"parameters": None})
        expect(page.get_by_role("alert", name="Failure of Start")).to_be_visible()
        page.get_by_role("button", name="Pause", exact=True).click()
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Paused")


def test_a_page_that_fails_leaves_stop_and_the_way_to_other_pages(browser: Browser, shop: Workshop) -> None:
    """Stop works, another page is shown, and the failed one again once it can be."""
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}", quiet=False) as page:
        damaged(page, {"findings": None})
        failed = page.get_by_role("alert", name="Failure of This page")
        expect(failed).to_be_visible()
        stop_button(page).click()
        expect(page.get_by_text("All arms at rest")).to_be_visible()
        page.get_by_role("link", name="nap").first.click()
        expect(page.get_by_role("heading", name="nap", level=1)).to_be_visible()
        page.unroute_all(behavior="wait")
        page.get_by_role("link", name="shift").first.click()
        expect(page.get_by_role("heading", name="shift", level=1)).to_be_visible()
        expect(failed).to_have_count(0)


def test_code_that_does_not_come_is_fetched_again(browser: Browser, shop: Workshop) -> None:
    """A page whose files could not be loaded is shown by Try again."""
    with opened_page(browser, shop.running, quiet=False) as page:
        page.route("**/assets/TeachPage-*.js", lambda route: route.abort())
        page.get_by_role("link", name="Teach").click()
        failed = page.get_by_role("alert", name="Failure of This page")
        expect(failed).to_contain_text("Failed to fetch dynamically imported module")
        page.unroute_all(behavior="wait")
        failed.get_by_role("button", name="Try again").click()
        expect(page.get_by_role("heading", name="Teach", level=1)).to_be_attached()
