"""Several runs at once in a real browser: their cards, and two of them side by side."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, WebSocketRoute, expect

from engine.event import OperatorChanged
from engine.runtime.run_options import RunOptions
from tests.editor_web.browsing import PHONE, Scheme, opened_page, require_accessible, require_fit, switch
from tests.editor_web.workshop import NAP_ID, SHIFT, Workshop

ASKS = RunOptions(autonomy="low", demand_operator=True)
NIGHT_ID = "behaviors/night.yaml"


@pytest.fixture
def shop(tmp_path: Path, loopback: str) -> Generator[Workshop]:
    """A served session with a third behavior."""
    with Workshop(host=loopback, project=tmp_path) as opened:
        (tmp_path / NIGHT_ID).write_text(SHIFT.replace("name: shift", "name: night"), encoding="utf-8")
        yield opened


def card(page: Page, name: str) -> Locator:
    """The card of a run under way."""
    return page.get_by_role("article", name=f"Run of {name} since ")


def column(page: Page, side: str) -> Locator:
    """The run on one side."""
    return page.get_by_role("region", name=f"Run on the {side}", exact=True)


def command(place: Locator, name: str) -> Locator:
    """A button by its whole name."""
    return place.get_by_role("button", name=name, exact=True)


def run_state(place: Locator, name: str) -> Locator:
    """How a run stands, in words."""
    return place.get_by_role("status", name=f"State of {name}")


def three_runs(shop: Workshop) -> dict[str, str]:
    """One that waits for long, one that asks twice, one that is paused before its first node; by name."""
    return {
        "nap": shop.start(NAP_ID),
        "shift": shop.start(supervision=ASKS),
        "night": shop.start(NIGHT_ID, supervision=RunOptions(start_paused=True)),
    }


def test_a_command_on_a_card_is_for_that_run_only(browser: Browser, shop: Workshop) -> None:
    """Pause, answer, force and stop, each beside runs that go on as they were."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs") as page:
        nap, shift, night = (card(page, name) for name in ("nap", "shift", "night"))
        command(nap, "Pause").click()
        expect(run_state(nap, "nap")).to_have_text("Paused")
        left, right = (
            shift.get_by_role("listitem", name=f"Question of root/both/{side}") for side in ("left", "right")
        )
        command(left, "Agree: a").click()
        expect(run_state(shift, "shift")).to_have_text("Waiting for answer")
        command(right, "Agree: a").click()
        expect(shift.get_by_role("list", name="Active nodes")).to_contain_text("rest")
        expect(run_state(night, "night")).to_have_text("Paused")
        command(nap, "Resume").click()
        expect(run_state(nap, "nap")).to_have_text("Running")
        command(night, "Stop").click()
        expect(night).to_have_count(0)
        ended = page.get_by_role("list", name="Runs that ended last").get_by_role("listitem")
        expect(ended).to_have_count(1)
        expect(ended).to_contain_text("stopped")
        expect(page.get_by_text("2 are active")).to_be_visible()
    statuses = {run.id: run.status for run in shop.session.runs()}
    assert [statuses[runs[name]] for name in ("nap", "shift", "night")] == ["running", "running", "stopped"]


def test_the_page_operates_one_run_at_a_time(browser: Browser, shop: Workshop) -> None:
    """Operating another one leaves the one before; leaving the page of all runs keeps it."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running) as page:
        page.get_by_role("link", name="All active runs").click()
        nap, night = card(page, "nap"), card(page, "night")
        command(nap, "Take control").click()
        expect(nap).to_contain_text("You operate this run")
        command(night, "Take control").click()
        expect(night).to_contain_text("You operate this run")
        expect(nap).to_contain_text("This run has no operator")
        night.get_by_role("link", name="night").click()
        expect(page.get_by_text("You operate this run")).to_be_visible()
    told = [[e.status for e in shop.events(runs[name]) if isinstance(e, OperatorChanged)] for name in ("nap", "night")]
    assert told[0] == ["attached", "detached"]
    assert told[1][0] == "attached"


def test_two_runs_stand_side_by_side(browser: Browser, shop: Workshop) -> None:
    """Each with its own graph, log and commands; after a reload too, and another one can be chosen."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs") as page:
        aside = page.get_by_role("button", name="Side by side")
        expect(aside).to_be_disabled()
        aside.click(force=True)
        expect(page.get_by_role("alert")).to_contain_text("tick Compare at two runs first")
        switch(page.get_by_label("Compare nap"))
        switch(page.get_by_label("Compare shift"))
        aside.click()
        page.reload()
        left, right = column(page, "left"), column(page, "right")
        expect(left.locator("[data-id='root/only'] [data-node]")).to_have_attribute("data-status", "active")
        expect(right.locator("[data-id='root/both'] [data-node]")).to_have_attribute("data-status", "active")
        expect(right.locator("[data-id='root/first'] [data-node]")).to_have_attribute("data-status", "done")
        expect(right.get_by_role("log")).to_contain_text("run started: shift")
        expect(left.get_by_role("log")).to_contain_text("run started: nap")
        expect(left.get_by_role("log")).not_to_contain_text("shift")
        command(left, "Pause").click()
        expect(left.get_by_role("status", name="State of nap on the left")).to_have_text("Paused")
        command(right.get_by_role("listitem", name="Question of root/both/left"), "Agree: a").click()
        expect(right.get_by_role("status", name="State of shift on the right")).to_have_text("Waiting for answer")
        page.get_by_label("Which run on the left").select_option(runs["night"])
        expect(left.get_by_role("list", name="Nodes that wait")).to_have_text("root before its entry: paused")
        command(left, "Step into").click()
        expect(left.get_by_role("list", name="Nodes that wait")).to_have_text("root/first before its entry: paused")
        command(left, "Stop").click()
        expect(left.locator("span[data-status]")).to_have_text("Stopped")
        expect(right.locator("span[data-status]")).to_have_text("Waiting for answer")
        left.get_by_role("link", name="Whole page").click()
        expect(page.locator("h1")).to_have_text("night")


def test_a_run_that_is_over_is_compared_with_one_under_way(browser: Browser, shop: Workshop) -> None:
    """And a run that the server does not know is not made up."""
    over = shop.start(NAP_ID)
    shop.call(shop.session.stop(over, reason="enough"))
    nap = shop.start(NAP_ID)
    with opened_page(browser, shop.running, "/runs") as page:
        page.get_by_role("list", name="Runs that ended last").get_by_role("checkbox").press("Space")
        switch(page.get_by_label("Compare nap", exact=True))
        page.get_by_role("button", name="Side by side").click()
        expect(column(page, "left").locator("[data-id='root/only'] [data-node]")).to_have_attribute(
            "data-status", "stopped"
        )
        expect(column(page, "right").locator("[data-id='root/only'] [data-node]")).to_have_attribute(
            "data-status", "active"
        )
        page.goto(f"{shop.running.url.rstrip('/')}/beside/{nap}/nothing")
        expect(column(page, "right")).to_contain_text("This server knows no such run")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_both_pages_are_accessible(browser: Browser, shop: Workshop, scheme: Scheme) -> None:
    """With questions, pauses and a run that is over, in both themes."""
    shop.call(shop.session.stop(shop.start(NAP_ID), reason="enough"))
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs", scheme=scheme) as page:
        expect(page.get_by_role("button", name="Agree: a")).to_have_count(2)
        expect(run_state(card(page, "night"), "night")).to_have_text("Paused")
        require_accessible(page, "all runs")
    with opened_page(browser, shop.running, f"/beside/{runs['shift']}/{runs['nap']}", scheme=scheme) as page:
        expect(page.get_by_role("button", name="Agree: a")).to_have_count(2)
        expect(column(page, "right").locator("[data-id='root/only'] [data-node]")).to_be_visible()
        require_accessible(page, "two runs side by side")


def test_on_a_phone_nothing_stands_out_to_the_side(browser: Browser, shop: Workshop) -> None:
    """Cards and columns stand below one another."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs", size=PHONE) as page:
        for path, shown in (
            ("/runs", "article"),
            (f"/beside/{runs['shift']}/{runs['nap']}", "section[aria-label='Run on the left'] [data-node]"),
        ):
            page.goto(shop.running.url.rstrip("/") + path)
            expect(page.locator(shown).first).to_be_visible()
            require_fit(page, PHONE[0])
        page.wait_for_function(
            "([left, right]) => left.getBoundingClientRect().bottom <= right.getBoundingClientRect().top",
            arg=[column(page, side).element_handle() for side in ("left", "right")],
        )


def test_a_card_whose_connection_is_lost_comes_back(browser: Browser, shop: Workshop) -> None:
    """With the truth of what has happened meanwhile; nothing can be pressed until then."""
    runs = three_runs(shop)
    sockets: list[WebSocketRoute] = []
    is_cut = False

    def through(socket: WebSocketRoute) -> None:
        if is_cut:
            socket.close()
            return
        socket.connect_to_server()
        sockets.append(socket)

    with opened_page(browser, shop.running, quiet=False) as page:
        page.route_web_socket("**/api/v1/live", through)
        page.goto(f"{shop.running.url}runs")
        nap = card(page, "nap")
        expect(run_state(nap, "nap")).to_have_text("Running")
        is_cut = True
        for socket in sockets:
            socket.close()
        expect(command(nap, "Pause")).to_have_attribute("title", "Not possible: the server does not answer")
        expect(page.get_by_role("alert")).to_contain_text("The server does not answer")
        require_accessible(page, "all runs without a server")
        shop.on_loop(lambda: shop.session.control(runs["nap"]).pause())
        is_cut = False
        expect(run_state(nap, "nap")).to_have_text("Paused")
        expect(command(nap, "Resume")).to_be_enabled()
