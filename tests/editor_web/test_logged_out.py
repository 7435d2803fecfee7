"""A page whose session has ended, in a real browser: it keeps what stands in it, STOP works, it goes on."""

from __future__ import annotations

import re
from collections.abc import Generator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from tests.editor_web.browsing import opened_page, require_accessible
from tests.editor_web.fake_behaviors import TRANSFER
from tests.editor_web.site import Site
from tests.editor_web.stop_process import StopProcess, connect_stop, stop_button, stop_status

ADDRESS = f"/behaviors/{TRANSFER.id}"


@pytest.fixture
def site(tmp_path: Path, loopback: str) -> Generator[Site]:
    """A server whose keys can be thrown away."""
    with Site(host=loopback, folder=tmp_path) as opened:
        yield opened


def renew(site: Site) -> None:
    """Restart the server with new keys: no session of before is known any more."""
    site.down(forget=True)
    site.up()


def test_a_logged_out_page_takes_a_token_and_goes_on(browser: Browser, site: Site) -> None:
    """A wrong one is refused in words; what was typed before still stands there."""
    with opened_page(browser, site.running, ADDRESS, quiet=False) as page:
        page.get_by_label("Speed").fill("0.7")
        renew(site)
        overlay = page.get_by_role("dialog", name="You are logged out")
        expect(overlay).to_contain_text("flexcell login")
        require_accessible(page, "a page that is logged out", part="dialog")
        overlay.get_by_label("Token").fill("wrong")
        overlay.get_by_role("button", name="Log in").click()
        expect(overlay.get_by_role("alert")).to_have_text("That token is not valid for this server.")
        overlay.get_by_label("Token").fill(site.running.new_login_url().partition("t=")[2])
        overlay.get_by_role("button", name="Log in").click()
        expect(overlay).to_have_count(0)
        expect(page.locator("[data-connection]")).to_have_text("Live")
        expect(page.get_by_label("Speed")).to_have_value("0.7")


def test_a_log_in_on_another_tab_is_enough(browser: Browser, site: Site) -> None:
    """Nothing is loaded again; the overlay can be put away meanwhile to look at what stands there."""
    with opened_page(browser, site.running, ADDRESS, quiet=False) as page:
        page.get_by_label("Speed").fill("0.7")
        renew(site)
        overlay = page.get_by_role("dialog", name="You are logged out")
        overlay.get_by_role("button", name="Close").click()
        bar = page.get_by_role("alert").filter(has_text="You are logged out")
        expect(bar.get_by_role("button", name="Log in")).to_be_visible()
        expect(page.get_by_label("Speed")).to_have_value("0.7")
        other = page.context.new_page()
        other.goto(site.running.new_login_url())
        expect(other.locator("[data-connection]")).to_have_text("Live")
        expect(bar).to_have_count(0)
        expect(page.locator("[data-connection]")).to_have_text("Live")
        expect(page.get_by_label("Speed")).to_have_value("0.7")


def test_stop_works_from_a_page_that_is_logged_out(browser: Browser, site: Site, loopback: str) -> None:
    """By the stop process, whose token the page has kept; over the overlay too."""
    origin = site.running.url.rstrip("/")
    with (
        StopProcess(host=loopback, origin=origin) as stop,
        opened_page(browser, site.running, ADDRESS, quiet=False) as page,
    ):
        connect_stop(page, stop)
        renew(site)
        expect(page.get_by_role("dialog", name="You are logged out")).to_be_visible()
        stop_button(page).click()
        expect(stop_status(page)).to_contain_text("All arms at rest")
        assert len(stop.stops()) == 1
        assert stop.stops()[0].body["token"] == stop.token


def test_the_stop_token_is_kept_nowhere_but_in_memory(browser: Browser, site: Site, loopback: str) -> None:
    """Neither in storage nor in the document, where another page or an extension could read it later."""
    with (
        StopProcess(host=loopback, origin=site.running.url.rstrip("/")) as stop,
        opened_page(browser, site.running, ADDRESS) as page,
    ):
        connect_stop(page, stop)
        kept = page.evaluate("JSON.stringify([{...localStorage}, {...sessionStorage}, document.cookie])")
        assert stop.token not in kept
        assert not re.search(stop.token, page.content())
