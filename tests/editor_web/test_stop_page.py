"""STOP of the cell in a real browser: with the engine frozen and dead, over dialogs, by its key."""

from __future__ import annotations

import os
import signal
import subprocess
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Frame, Page, Request, Route, expect

import hatch_build
from engine.event import StopRequested
from tests.editor_web.browsing import PHONE, opened_page, require_accessible, require_fit, until
from tests.editor_web.real_server import dashboard_of
from tests.editor_web.stop_process import StopProcess, connect_stop, stop_button, stop_status
from tests.editor_web.workshop import NAP, NAP_ID, SHIFT_ID, Workshop
from tests.engine.cli.process import started
from tests.tiers import nightly

KEY = "Control+Shift+Backspace"


@contextmanager
def served_page(
    browser: Browser, folder: Path, loopback: str
) -> Generator[tuple[Page, StopProcess, subprocess.Popen[str]]]:
    """The page of a server in a process of its own, which knows a stop process."""
    (folder / "behaviors").mkdir()
    (folder / NAP_ID).write_text(NAP, encoding="utf-8")
    with started("serve", "--host", loopback, "--port", "0", cwd=folder) as server:
        served = dashboard_of(server, folder / ".flexcell")
        with (
            StopProcess(host=loopback, origin=served.url.rstrip("/")) as stop,
            opened_page(browser, served, f"/behaviors/{NAP_ID}", quiet=False) as page,
        ):
            connect_stop(page, stop)
            require_live(page)
            yield page, stop, server


def require_live(page: Page) -> None:
    """The page has heard of the engine, and can say since when it has not."""
    expect(page.locator("[data-connection]")).to_have_text("Live")


def test_stop_goes_through_while_the_engine_is_frozen(browser: Browser, tmp_path: Path, loopback: str) -> None:
    """The stop process acknowledges it, the page says how it stands, and the engine does it when it goes on."""
    with served_page(browser, tmp_path, loopback) as (page, stop, server):
        stop.at_rest = False
        server.send_signal(signal.SIGSTOP)
        try:
            stop_button(page).click()
            expect(stop_status(page)).to_contain_text("Stop acknowledged")
            expect(stop_status(page)).to_contain_text("rest: world")
            until(page, lambda: any(each.path == "/stop/status" for each in stop.asked))
            stop.at_rest = True
            expect(stop_status(page)).to_contain_text("All arms at rest")
            expect(stop_status(page)).to_contain_text("Engine does not answer (silent since ")
            expect(stop_status(page)).to_contain_text("arms are stopped by their controller")
            require_accessible(page, "a stop without the engine", part="[aria-label='Stop of the cell']")
        finally:
            os.kill(server.pid, signal.SIGCONT)
        expect(stop_status(page)).not_to_contain_text("Engine does not answer")
    first = stop.stops()[0]
    assert (first.method, first.content_type) == ("POST", "text/plain")
    assert first.body == {"token": stop.token, "reason": "the cell was stopped in the dashboard"}
    assert {each.method for each in stop.asked} == {"POST"}


def test_the_relay_of_a_frozen_server_answers_its_page(browser: Browser, tmp_path: Path, loopback: str) -> None:
    """The real one, under the real policy of the page: nothing stands in."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / NAP_ID).write_text(NAP, encoding="utf-8")
    with started("serve", "--host", loopback, "--port", "0", cwd=tmp_path) as server:
        served = dashboard_of(server, tmp_path / ".flexcell")
        with opened_page(browser, served, f"/behaviors/{NAP_ID}", quiet=False) as page:
            expect(stop_button(page)).to_be_visible()
            require_live(page)
            server.send_signal(signal.SIGSTOP)
            try:
                stop_button(page).click()
                expect(stop_status(page)).to_contain_text("All arms at rest")
                expect(stop_status(page)).to_contain_text("Engine does not answer (silent since ")
            finally:
                os.kill(server.pid, signal.SIGCONT)
            expect(stop_status(page)).not_to_contain_text("Engine does not answer")


def test_stop_goes_through_after_the_engine_has_died(browser: Browser, tmp_path: Path, loopback: str) -> None:
    """With nobody left to ask it says what to do instead; both say it as an alert."""
    with served_page(browser, tmp_path, loopback) as (page, stop, server):
        server.kill()
        expect(page.get_by_text("The server does not answer", exact=True)).to_be_visible()
        expect(stop_button(page)).to_be_enabled()
        stop_button(page).click()
        expect(stop_status(page)).to_contain_text("All arms at rest")
        expect(stop_status(page)).to_contain_text("Engine does not answer")
        assert len(stop.stops()) == 1
        stop.end()
        stop_button(page).click()
        alarm = stop_status(page).get_by_role("alert")
        expect(alarm).to_contain_text("STOP has failed")
        expect(alarm).to_contain_text("Press the emergency stop at the cell")
        require_accessible(page, "a stop that failed", part="[aria-label='Stop of the cell']")


def test_a_page_that_is_left_before_the_answer_gives_stop_again(
    browser: Browser, shop: Workshop, loopback: str
) -> None:
    """What a browser still sends then outlives the page; the first request may end with it."""
    with (
        StopProcess(host=loopback, origin=shop.running.url.rstrip("/")) as stop,
        opened_page(browser, shop.running) as page,
    ):
        connect_stop(page, stop)
        stop.answers.clear()
        try:
            stop_button(page).click()
            until(page, lambda: len(stop.stops()) == 1)
            page.goto("about:blank")
            until(page, lambda: len(stop.stops()) == 2)
        finally:
            stop.answers.set()
    first, again = stop.stops()
    assert first.body == again.body
    assert again.content_type.startswith("text/plain")


def test_stop_by_the_engine_alone_ends_every_run(browser: Browser, shop: Workshop) -> None:
    """Where the server names no stop process; the words go away by themselves, or are put away."""
    run = shop.start()
    with opened_page(browser, shop.running, "/teach") as page:
        stop_button(page).click()
        expect(stop_status(page)).to_contain_text("All arms at rest")
        page.get_by_role("button", name="Put the words about the stop away").click()
        expect(stop_status(page)).to_have_text("")
    assert [each.reason for each in shop.events(run) if isinstance(each, StopRequested)] == [
        "the cell was stopped in the dashboard"
    ]


@pytest.mark.parametrize(
    "address", ["/", "/teach", f"/edit/{SHIFT_ID}", *map(nightly, ("/runs", "/past", f"/behaviors/{SHIFT_ID}"))]
)
def test_stop_stands_on_every_page_of_an_operator(browser: Browser, shop: Workshop, address: str) -> None:
    """It is what a click at its place hits, on a small screen too."""
    for size in ((1366, 768), PHONE):
        with opened_page(browser, shop.running, address, size=size) as page:
            expect(stop_button(page)).to_be_in_viewport(ratio=1)
            stop_button(page).click(trial=True)
            require_fit(page, size[0])


def test_stop_is_above_a_dialog_and_its_key_works_there(browser: Browser, shop: Workshop) -> None:
    """By the mouse, by Tab inside the dialog, and by its key also while somebody writes."""
    stops: list[str] = []

    def count(route: Route) -> None:
        if route.request.method != "POST":
            route.continue_()
            return
        stops.append(route.request.url)
        route.fulfill(status=204)

    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}") as page:
        page.route("**/api/v1/cell/stop", count)
        page.get_by_role("button", name="Keys").click()
        dialog = page.get_by_role("dialog", name="Keyboard")
        expect(dialog).to_be_visible()
        stop_button(page).click()
        until(page, lambda: len(stops) == 1)
        for _ in range(200):
            page.keyboard.press("Tab")
            if page.evaluate("document.activeElement.ariaKeyShortcuts") == KEY:
                break
        page.keyboard.press("Enter")
        until(page, lambda: len(stops) == 2)
        expect(dialog).to_be_visible()
        page.keyboard.press(KEY)
        until(page, lambda: len(stops) == 3)
        page.get_by_role("button", name="Close", exact=True).click()
        dwell = page.get_by_label("Dwell")
        dwell.focus()
        page.keyboard.press(KEY)
        until(page, lambda: len(stops) == 4)
        expect(dwell).to_have_value("0")
        expect(stop_button(page)).to_be_visible()


def test_a_3d_view_that_hangs_holds_up_neither_stop_nor_the_page(
    browser: Browser, tmp_path: Path, loopback: str
) -> None:
    """A picture without a graphics card takes a second; the view has a process of its own."""
    with (
        Workshop(host=loopback, project=tmp_path, cell_view=True) as shop,
        opened_page(browser, shop.running, quiet=False) as page,
    ):
        hangs_until_ms: int = view_of(page).evaluate(
            """() => {
              const end = Date.now() + 120_000
              setTimeout(() => { while (Date.now() < end); })
              return end
            }"""
        )
        stop_button(page).click()
        expect(stop_status(page)).to_contain_text("All arms at rest")
        assert page.evaluate("Date.now()") < hangs_until_ms


def is_stop(request: Request) -> bool:
    """Is it an order to stop? The same address tells of the latest stop."""
    return request.method == "POST" and request.url.endswith("/cell/stop")


def test_the_key_of_stop_works_in_the_3d_view_and_for_nobody_else(
    browser: Browser, tmp_path: Path, loopback: str
) -> None:
    """Only that frame of the page is believed."""
    with (
        Workshop(host=loopback, project=tmp_path, cell_view=True) as shop,
        opened_page(browser, shop.running, quiet=False) as page,
    ):
        stops: list[str] = []
        page.on("request", lambda request: stops.append(request.url) if is_stop(request) else None)
        page.evaluate("window.postMessage({ cellView: 'stop' }, '*')")
        page.evaluate("() => new Promise(requestAnimationFrame)")
        assert stops == []
        view_of(page).locator("body").press(KEY)
        expect(stop_status(page)).to_contain_text("All arms at rest")
        assert len(stops) == 1


def view_of(page: Page) -> Frame:
    """The frame that draws the cell, once it is there."""
    element = page.wait_for_selector("iframe[title='3D view of the cell']")
    assert element is not None
    frame = element.content_frame()
    assert frame is not None
    frame.wait_for_load_state()
    return frame


def test_every_modal_dialog_lets_stop_through() -> None:
    """Only one place opens dialogs, and it tells STOP of them."""
    sources = [path for path in (hatch_build.SOURCE / "src").rglob("*.ts*") if "showModal" in path.read_text("utf-8")]
    assert [path.name for path in sources] == ["modal.ts"]
