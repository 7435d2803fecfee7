"""Several runs at once in a real browser: their cards, and two of them side by side."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, WebSocketRoute, expect

from editor_web.security.authentication import VIEWER
from engine.bus import Holder
from engine.event import OperatorChanged, RunStarted
from engine.runtime.run_options import RunOptions
from tests.editor_web.browsing import PHONE, Scheme, opened_page, require_accessible, require_fit, switch
from tests.editor_web.workshop import NAP_ID, SHIFT, SHIFT_ID, Workshop

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
    return page.get_by_role("article", name=f"Run of {name}", exact=True)


def column(page: Page, side: str) -> Locator:
    """The run on one side."""
    return page.get_by_role("region", name=f"Run on the {side}", exact=True)


def command(place: Locator, name: str) -> Locator:
    """A button by its whole name."""
    return place.get_by_role("button", name=name, exact=True)


def standing(place: Locator, name: str) -> Locator:
    """How a run stands, in words."""
    return place.get_by_role("status", name=f"State of {name}")


def three_runs(shop: Workshop) -> dict[str, str]:
    """One that waits for long, one that asks twice, one that is paused before its first node; by name."""
    return {
        "nap": shop.start(NAP_ID),
        "shift": shop.start(supervision=ASKS),
        "night": shop.start(NIGHT_ID, supervision=RunOptions(start_paused=True)),
    }


def test_each_card_tells_of_its_own_run(browser: Browser, shop: Workshop) -> None:
    """What is active, what waits and asks, what it holds, and how far it is."""
    runs = three_runs(shop)
    bus = shop.session.cell.bus
    shop.on_loop(lambda: bus.leases.acquire(("left",), Holder(runs["nap"], "root/only")))
    with opened_page(browser, shop.running, "/runs") as page:
        expect(page.get_by_text("3 are under way, one asks")).to_be_visible()
        nap, shift, night = (card(page, name) for name in ("nap", "shift", "night"))
        expect(standing(nap, "nap")).to_have_text("Running")
        expect(nap.get_by_role("list", name="Active nodes")).to_contain_text("only")
        expect(nap.get_by_role("img", name="0 of 1 step done, 1 active")).to_be_visible()
        expect(nap.get_by_role("definition").last).to_have_text("left")
        expect(standing(shift, "shift")).to_have_text("Asks for 2 answers")
        expect(shift.get_by_role("listitem", name="Question of root/both/left")).to_contain_text("which requires high")
        expect(shift.get_by_role("img", name="2 of 5 steps done, 2 wait")).to_be_visible()
        expect(shift.get_by_role("definition").last).to_have_text("no arm or device")
        expect(standing(night, "night")).to_have_text("Paused, everything rests")
        expect(night.get_by_role("list", name="Nodes that wait")).to_have_text("root before its entry: paused")
        expect(night.get_by_role("img", name="0 of 5 steps done")).to_be_visible()


def test_a_command_on_a_card_is_for_that_run_only(browser: Browser, shop: Workshop) -> None:
    """Pause, answer, force and stop, each beside runs that go on as they were."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs") as page:
        nap, shift, night = (card(page, name) for name in ("nap", "shift", "night"))
        command(nap, "Pause").click()
        expect(standing(nap, "nap")).to_have_text("Paused, everything rests")
        left, right = (
            shift.get_by_role("listitem", name=f"Question of root/both/{side}") for side in ("left", "right")
        )
        command(left, "Agree: a").click()
        expect(standing(shift, "shift")).to_have_text("Asks for an answer")
        command(right, "Agree: a").click()
        expect(shift.get_by_role("list", name="Active nodes")).to_contain_text("rest")
        expect(standing(night, "night")).to_have_text("Paused, everything rests")
        command(nap, "Resume").click()
        expect(standing(nap, "nap")).to_have_text("Running")
        command(night, "Stop").click()
        expect(night).to_have_count(0)
        ended = page.get_by_role("list", name="Runs that ended last").get_by_role("listitem")
        expect(ended).to_have_count(1)
        expect(ended).to_contain_text("stopped")
        expect(page.get_by_text("2 are under way")).to_be_visible()
    statuses = {run.id: run.status for run in shop.session.runs()}
    assert [statuses[runs[name]] for name in ("nap", "shift", "night")] == ["running", "running", "stopped"]


def test_a_refusal_names_the_run(browser: Browser, shop: Workshop) -> None:
    """A page that is behind by a moment asks for what is not possible any more."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs", quiet=False) as page:
        page.route(
            "**/control/answer",
            lambda route: (
                shop.on_loop(lambda: shop.session.control(runs["shift"]).answer("root/both/left")),
                route.continue_(),
            ),
        )
        question = card(page, "shift").get_by_role("listitem", name="Question of root/both/left")
        command(question, "Agree: a").click()
        expect(page.get_by_role("alert")).to_contain_text("shift: Agree was refused")


def test_the_page_operates_one_run_at_a_time(browser: Browser, shop: Workshop) -> None:
    """Operating another one leaves the one before; leaving the page of all runs keeps it."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs") as page:
        nap, night = card(page, "nap"), card(page, "night")
        command(nap, "Operate").click()
        expect(nap).to_contain_text("You operate this run")
        command(night, "Operate").click()
        expect(night).to_contain_text("You operate this run")
        expect(nap).to_contain_text("Nobody operates this run")
        night.get_by_role("link", name="night").click()
        expect(page.get_by_text("You operate this run")).to_be_visible()
    told = [[e.status for e in shop.events(runs[name]) if isinstance(e, OperatorChanged)] for name in ("nap", "night")]
    assert told[0] == ["attached", "detached"]
    assert told[1][0] == "attached"


def test_a_viewer_sees_all_runs_and_commands_none(browser: Browser, shop: Workshop) -> None:
    """Each button says why."""
    three_runs(shop)
    login = shop.running.new_login_url(VIEWER)
    with opened_page(browser, shop.running, "/runs", login=login) as page:
        shift = card(page, "shift")
        expect(standing(shift, "shift")).to_have_text("Asks for 2 answers")
        for name in ("Pause", "Operate", "Stop"):
            expect(command(shift, name)).to_have_attribute(
                "title", "Not possible: you may look only; log in with the operator token"
            )
        expect(shift.get_by_role("button", name="Agree: a").first).to_be_disabled()
        expect(page.get_by_role("button", name="Stop the cell")).to_have_count(0)


def test_with_several_runs_the_header_stops_only_the_one_of_the_page(browser: Browser, shop: Workshop) -> None:
    """Elsewhere it leads to all of them."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running, f"/runs/{runs['nap']}") as page:
        header = page.get_by_role("banner")
        expect(header.get_by_role("button", name="Stop")).to_be_visible()
        header.get_by_role("link", name="+ 2 others").click()
        expect(page.get_by_role("article")).to_have_count(3)
        expect(header.get_by_role("button", name="Stop")).to_have_count(0)
        page.get_by_role("link", name="flexcell").click()
        header.get_by_role("link", name="3 runs under way").click()
        expect(page.get_by_role("heading", name="Runs", level=1)).to_be_visible()


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
        expect(left.locator("[data-id='root/only'] .step")).to_have_attribute("data-status", "active")
        expect(right.locator("[data-id='root/both'] .step")).to_have_attribute("data-status", "active")
        expect(right.locator("[data-id='root/first'] .step")).to_have_attribute("data-status", "done")
        expect(right.get_by_role("log")).to_contain_text("run started: shift")
        expect(left.get_by_role("log")).to_contain_text("run started: nap")
        expect(left.get_by_role("log")).not_to_contain_text("shift")
        command(left, "Pause").click()
        expect(left.get_by_role("status", name="State of nap on the left")).to_have_text("Paused, everything rests")
        command(right.get_by_role("listitem", name="Question of root/both/left"), "Agree: a").click()
        expect(right.get_by_role("status", name="State of shift on the right")).to_have_text("Asks for an answer")
        page.get_by_label("Which run on the left").select_option(runs["night"])
        expect(left.get_by_role("list", name="Nodes that wait")).to_have_text("root before its entry: paused")
        command(left, "Step into").click()
        expect(left.get_by_role("list", name="Nodes that wait")).to_have_text("root/first before its entry: paused")
        command(left, "Stop").click()
        expect(left.locator(".badge")).to_have_text("stopped")
        expect(right.locator(".badge")).to_have_text("running")
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
        expect(column(page, "left").locator("[data-id='root/only'] .step")).to_have_attribute("data-status", "stopped")
        expect(column(page, "right").locator("[data-id='root/only'] .step")).to_have_attribute("data-status", "active")
        page.goto(f"{shop.running.url.rstrip('/')}/beside/{nap}/nothing")
        expect(column(page, "right")).to_contain_text("This server knows no such run")


def test_no_run_under_way_says_what_to_do(browser: Browser, shop: Workshop) -> None:
    """On the way to the list from anywhere."""
    with opened_page(browser, shop.running) as page:
        page.get_by_role("link", name="All runs under way").click()
        expect(page.get_by_text("Choose a behavior in the menu and start it")).to_be_visible()
        expect(page.get_by_text("None is under way")).to_be_visible()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_both_pages_are_accessible(browser: Browser, shop: Workshop, scheme: Scheme) -> None:
    """With questions, pauses and a run that is over, in both themes."""
    shop.call(shop.session.stop(shop.start(NAP_ID), reason="enough"))
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs", scheme=scheme) as page:
        expect(page.get_by_role("button", name="Agree: a")).to_have_count(2)
        expect(standing(card(page, "night"), "night")).to_have_text("Paused, everything rests")
        require_accessible(page, "all runs")
    with opened_page(browser, shop.running, f"/beside/{runs['shift']}/{runs['nap']}", scheme=scheme) as page:
        expect(page.get_by_role("button", name="Agree: a")).to_have_count(2)
        expect(column(page, "right").locator("[data-id='root/only'] .step")).to_be_visible()
        require_accessible(page, "two runs side by side")


def test_on_a_phone_nothing_stands_out_to_the_side(browser: Browser, shop: Workshop) -> None:
    """Cards and columns stand below one another."""
    runs = three_runs(shop)
    with opened_page(browser, shop.running, "/runs", size=PHONE) as page:
        for path, shown in (("/runs", "article"), (f"/beside/{runs['shift']}/{runs['nap']}", ".run-column .step")):
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
        expect(standing(nap, "nap")).to_have_text("Running")
        is_cut = True
        for socket in sockets:
            socket.close()
        expect(command(nap, "Pause")).to_have_attribute("title", "Not possible: the server does not answer")
        expect(page.get_by_role("alert")).to_contain_text("The server does not answer")
        require_accessible(page, "all runs without a server")
        shop.on_loop(lambda: shop.session.control(runs["nap"]).pause())
        is_cut = False
        expect(standing(nap, "nap")).to_have_text("Paused, everything rests")
        expect(command(nap, "Resume")).to_be_enabled()


def test_a_run_is_started_once_more_as_it_was(browser: Browser, shop: Workshop) -> None:
    """The form takes over the parameters, the userdata and the seed of the run that is shown."""
    first = shop.call(shop.session.start(SHIFT_ID, parameters={"dwell": 0.25}, inputs={"value": 5}, seed=77))
    shop.call(shop.session.stop(first, reason="enough"))
    with opened_page(browser, shop.running, f"/runs/{first}") as page:
        dwell = page.get_by_label("dwell")
        expect(dwell).to_have_value("0")
        page.get_by_role("button", name="Same as the shown run").click()
        expect(dwell).to_have_value("0.25")
        page.get_by_role("button", name="Start", exact=True).click()
        expect(page.locator(".page-head .badge")).to_have_text("running")
    (again,) = (run.id for run in shop.session.runs() if run.status == "running")
    started = [event for event in shop.events(again) if isinstance(event, RunStarted)]
    assert [(event.parameters, event.inputs, event.seed) for event in started] == [({"dwell": 0.25}, {"value": 5}, 77)]


def test_a_run_begins_with_the_userdata_of_the_form(browser: Browser, shop: Workshop) -> None:
    """What is no JSON object is not sent; a key that the document does not have is refused in words."""
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}", quiet=False) as page:
        page.get_by_role("button", name="Initial userdata").click()
        data = page.get_by_label("Userdata", exact=True)
        start = page.get_by_role("button", name="Start", exact=True)
        data.fill("[1]")
        expect(page.get_by_text("This is not a JSON object")).to_be_visible()
        start.click()
        data.fill('{"valu": 1}')
        start.click()
        expect(page.get_by_role("alert")).to_contain_text("there is no userdata key 'valu'")
        data.fill('{"value": 9}')
        start.click()
        expect(page.locator(".page-head .badge")).to_have_text("running")
    (run,) = (run.id for run in shop.session.runs())
    assert [e.inputs for e in shop.events(run) if isinstance(e, RunStarted)] == [{"value": 9}]
