"""The timeline in a real browser: scrubbing, marks, the failure, past runs after a restart, recordings."""

from __future__ import annotations

import json
import re
from collections.abc import Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from engine.clock import run_virtual
from engine.event import Event, NodeExited
from tests.editor_web.browsing import DESK, PHONE, Scheme, Size, opened_page, require_accessible
from tests.editor_web.workshop import NAP_ID, SHIFT_ID, Workshop
from tests.engine.replay.rig import record_run
from tests.tiers import nightly

SORT_ID = "behaviors/sort.yaml"
SORT = """
flexcell: 1
name: sort
outcomes: [good, bad]
success: [good]
userdata: {value: 0}
root:
  machine:
    initial: approach
    states:
      approach: {state: test.Give, with: {after_s: 2.0}, transitions: {a: both, b: bad, c: bad}}
      both:
        concurrency:
          states:
            left: {state: test.Give, with: {after_s: 0.3}}
            right: {state: test.Give, with: {after_s: 0.2}}
          conditions:
            - {finished: {left: a, right: a}}
            - {odd: {left: b}}
            - {odd: {left: c}}
            - {odd: {right: b}}
            - {odd: {right: c}}
        transitions: {finished: mark, odd: bad}
      mark: {state: flow.SetValue, with: {value: 1}, out: {value: value}, transitions: {done: look}}
      look: {state: test.Raise, transitions: {done: good}}
"""
RECORDED = """
root:
  machine:
    initial: it
    states:
      it: {state: bench.Work, with: {for_s: 2}, transitions: {a: good, b: bad, c: bad}}
"""


@pytest.fixture(scope="module")
def sorted_shop(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[tuple[Workshop, str]]:
    """A server with one run that went wrong, and that run."""
    project = tmp_path_factory.mktemp("sorted")
    (project / "behaviors").mkdir()
    (project / SORT_ID).write_text(SORT, encoding="utf-8")
    with Workshop(host=loopback, project=project) as shop:
        run = shop.start(SORT_ID)
        shop.call(shop.session.wait(run))
        yield shop, run


@contextmanager
def at_timeline(
    browser: Browser, shop: Workshop, path: str, *, size: Size = DESK, scheme: Scheme = "light"
) -> Generator[Page]:
    """A page with the tab of the timeline open."""
    with opened_page(browser, shop.running, path, size=size, scheme=scheme) as page:
        page.get_by_role("tab", name="Timeline").click()
        expect(slider(page)).to_be_visible()
        yield page


def slider(page: Page) -> Locator:
    """The ruler, which is a slider to the keyboard."""
    return page.get_by_role("slider", name="Moment of the run")


def node(page: Page, path: str) -> Locator:
    """A node of the graph."""
    return page.locator(f".react-flow__node[data-id='{path}'] [data-node]")


def point_at(page: Page, events: list[Event], time_s: float) -> None:
    """Press the ruler at a time of a run that is over."""
    box = slider(page).bounding_box()
    assert box is not None
    slider(page).click(position={"x": box["width"] * time_s / events[-1].time_s, "y": 8})


def share_of(events: list[Event], share: float) -> str:
    """How a moment of a run that is over is told."""
    whole_s = events[-1].time_s
    return " of ".join(f"{time_s:.2f} s" if time_s < 10 else f"{time_s:.1f} s" for time_s in (share * whole_s, whole_s))


def named(*nodes: str) -> list[re.Pattern[str]]:
    """Rows of nodes, each after the words of its icon."""
    return [re.compile(rf"{node}$") for node in nodes]


def end_of(events: list[Event], path: str) -> float:
    """When a node ended."""
    return next(event.time_s for event in events if isinstance(event, NodeExited) and event.path == path)


def test_scrubbing_shows_what_was_active_then(browser: Browser, sorted_shop: tuple[Workshop, str]) -> None:
    """On the graph and in the log; and one press leads back to what is live."""
    shop, run = sorted_shop
    events = shop.events(run)
    with at_timeline(browser, shop, f"/runs/{run}") as page:
        expect(node(page, "root/look")).to_have_attribute("data-status", "failed")
        point_at(page, events, (end_of(events, "root/approach") + end_of(events, "root/both/right")) / 2)
        expect(node(page, "root/both/left")).to_have_attribute("data-status", "active")
        expect(node(page, "root/both/right")).to_have_attribute("data-status", "active")
        expect(node(page, "root/approach")).to_have_attribute("data-status", "done")
        expect(node(page, "root/look")).to_have_attribute("data-status", "idle")
        expect(page.locator("[data-past-line]")).to_contain_text("of the past")
        page.get_by_role("tab", name="Log").click()
        expect(page.get_by_role("log")).not_to_contain_text("run errored")
        page.get_by_role("button", name="Back to live").click()
        expect(node(page, "root/look")).to_have_attribute("data-status", "failed")
        expect(page.get_by_role("log")).to_contain_text("run errored")
        expect(page.locator("[data-past-line]")).to_have_count(0)


def test_the_data_is_that_of_the_moment(browser: Browser, sorted_shop: tuple[Workshop, str]) -> None:
    """What was written later is not there yet."""
    shop, run = sorted_shop
    with at_timeline(browser, shop, f"/runs/{run}") as page:
        page.get_by_role("tab", name="Data").click()
        data = page.get_by_role("region", name="Userdata")
        expect(data).to_contain_text("root/mark")
        page.get_by_role("tab", name="Timeline").click()
        slider(page).press("Home")
        page.get_by_role("tab", name="Data").click()
        expect(data).to_contain_text("from the start")
        expect(data).not_to_contain_text("root/mark")


def test_the_keyboard_reaches_every_moment(browser: Browser, sorted_shop: tuple[Workshop, str]) -> None:
    """By steps, to the ends, from mark to mark; a screen reader is told where it is."""
    shop, run = sorted_shop
    with at_timeline(browser, shop, f"/runs/{run}") as page:
        slider(page).press("Home")
        expect(slider(page)).to_have_attribute("aria-valuetext", share_of(shop.events(run), 0.0))
        expect(node(page, "root/look")).to_have_attribute("data-status", "idle")
        slider(page).press("Shift+ArrowRight")
        expect(slider(page)).to_have_attribute("aria-valuetext", share_of(shop.events(run), 0.1))
        expect(node(page, "root/approach")).to_have_attribute("data-status", "active")
        slider(page).press("PageDown")
        expect(node(page, "root/look")).to_have_attribute("data-status", "failed")
        slider(page).press("Escape")
        expect(page.locator("[data-past-line]")).to_have_count(0)


def test_zooming_keeps_the_cursor_visible_and_rows_close(browser: Browser, sorted_shop: tuple[Workshop, str]) -> None:
    """By keys and by the wheel; the names are a tree."""
    shop, run = sorted_shop
    with at_timeline(browser, shop, f"/runs/{run}") as page:
        rows = page.get_by_role("tree", name="Nodes of the timeline").get_by_role("treeitem")
        expect(rows).to_have_text(named("root", "approach", "both", "left", "right", "mark", "look"))
        both = rows.filter(has_text="both")
        both.press("ArrowLeft")
        expect(both).to_have_attribute("aria-expanded", "false")
        expect(rows).to_have_text(named("root", "approach", "both", "mark", "look"))
        both.press("Enter")
        expect(page.get_by_role("navigation", name="Path of the selection")).to_contain_text("both")
        slider(page).press("Home")
        slider(page).press("+")
        slider(page).press("+")
        slider(page).press("ArrowRight")
        # A step is a hundredth of what is seen, which is a quarter of the run now.
        expect(slider(page)).to_have_attribute("aria-valuetext", share_of(shop.events(run), 0.01 / 4))
        slider(page).press("0")
        slider(page).press("Home")
        slider(page).press("ArrowRight")
        expect(slider(page)).to_have_attribute("aria-valuetext", share_of(shop.events(run), 0.01))


def test_playing_goes_to_the_end(browser: Browser, sorted_shop: tuple[Workshop, str]) -> None:
    """At the chosen speed; then it stops."""
    shop, run = sorted_shop
    with at_timeline(browser, shop, f"/runs/{run}") as page:
        slider(page).press("Home")
        page.get_by_label("Speed of playing").select_option("0.25")
        page.get_by_role("button", name="Play").click()
        expect(page.get_by_role("button", name="Stop playing")).to_be_visible()
        page.get_by_label("Speed of playing").select_option("8")
        expect(node(page, "root/look")).to_have_attribute("data-status", "failed")
        expect(page.get_by_role("button", name="Play")).to_be_visible()


def test_a_failure_is_traced_to_its_node_and_moment(browser: Browser, sorted_shop: tuple[Workshop, str]) -> None:
    """The chain of causes, the node on the graph, the moment on the timeline."""
    shop, run = sorted_shop
    with opened_page(browser, shop.running, f"/runs/{run}") as page:
        page.get_by_role("tab", name="Failure").click()
        told = page.get_by_role("region", name="How the run failed")
        expect(told.get_by_role("heading", name="division by zero")).to_be_visible()
        expect(told).to_contain_text("ZeroDivisionError")
        page.get_by_role("button", name="Show the moment").click()
        expect(page.get_by_role("navigation", name="Path of the selection")).to_contain_text("look")
        expect(page.locator("[data-past-line]")).to_be_visible()
        told.get_by_role("button", name="root", exact=True).click()
        expect(page.get_by_role("navigation", name="Path of the selection")).not_to_contain_text("look")


def test_the_present_goes_on_while_the_past_is_shown(browser: Browser, shop: Workshop) -> None:
    """A run under way can be commanded; what it does shows when one is back."""
    run = shop.start(SHIFT_ID)
    with at_timeline(browser, shop, f"/runs/{run}") as page:
        expect(node(page, "root/rest")).to_have_attribute("data-status", "active")
        slider(page).press("Home")
        expect(node(page, "root/rest")).to_have_attribute("data-status", "idle")
        page.get_by_role("button", name="Pause").click()
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Paused")
        expect(node(page, "root/rest")).to_have_attribute("data-status", "idle")
        shop.call(shop.session.stop(run, reason="enough"))
        expect(page.get_by_role("status", name="State of the run")).to_contain_text("Stopped")
        page.get_by_role("button", name="Back to live").click()
        expect(node(page, "root/rest")).to_have_attribute("data-status", "stopped")


def test_the_3d_view_gets_the_moment(browser: Browser, tmp_path: Path, loopback: str) -> None:
    """Where this server has one."""
    with Workshop(host=loopback, project=tmp_path, cell_view=True) as shop:
        run = shop.start(NAP_ID)
        with at_timeline(browser, shop, f"/runs/{run}?layout=debug") as page:
            with page.expect_websocket(lambda socket: "/cell/past/" in socket.url) as opened:
                slider(page).press("Home")
            with opened.value.expect_event("framesent") as sent:
                slider(page).press("Shift+ArrowRight")
            assert json.loads(str(sent.value))["run"] == run
        shop.call(shop.session.stop(run, reason="enough"))


def test_a_past_run_is_found_and_seen_after_a_restart(browser: Browser, tmp_path: Path, loopback: str) -> None:
    """Failures are one press away; what is opened is read-only and begins at its end."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / SORT_ID).write_text(SORT, encoding="utf-8")
    with Workshop(host=loopback, project=tmp_path) as before:
        run = before.start(SORT_ID)
        before.call(before.session.wait(run))
        events = before.events(run)
    (tmp_path / SORT_ID).unlink()
    with Workshop(host=loopback, project=tmp_path) as shop, opened_page(browser, shop.running, "/") as page:
        page.get_by_role("link", name="Past runs and recordings").click()
        page.get_by_role("button", name=re.compile(r"^Failed 1")).click()
        page.get_by_label("Find a run").fill("zero")
        page.get_by_role("list", name="Past runs").get_by_role("link").click()
        expect(page.get_by_role("heading", name="sort")).to_be_visible()
        expect(page).to_have_url(re.compile(re.escape(run)))
        expect(page.get_by_role("button", name="Start")).to_have_count(0)
        expect(node(page, "root/look")).to_have_attribute("data-status", "failed")
        expect(page.get_by_role("region", name="How the run failed")).to_contain_text("division by zero")
        page.get_by_role("tab", name="Timeline").click()
        point_at(page, events, end_of(events, "root/approach") / 2)
        expect(node(page, "root/approach")).to_have_attribute("data-status", "active")
        page.get_by_role("button", name="To the end").first.click()
        expect(node(page, "root/look")).to_have_attribute("data-status", "failed")


def test_a_recording_is_opened(browser: Browser, shop: Workshop) -> None:
    """With the behavior that is inside it, in the same view."""
    with ThreadPoolExecutor() as other:
        # The browser's loop runs on this thread.
        other.submit(run_virtual, record_run(RECORDED, shop.project / "one.mcap", rate_hz=0)).result()
    with opened_page(browser, shop.running, "/past") as page:
        page.get_by_role("list", name="Recordings").get_by_role("link").click()
        expect(node(page, "root/it")).to_have_attribute("data-status", "done")
        page.get_by_role("tab", name="Timeline").click()
        slider(page).press("Home")
        slider(page).press("Shift+ArrowRight")
        expect(node(page, "root/it")).to_have_attribute("data-status", "active")


def test_a_run_that_nobody_knows_is_said_to_be_none(browser: Browser, shop: Workshop) -> None:
    """With the way to those that are known."""
    with opened_page(browser, shop.running, "/runs/nobody", quiet=False) as page:
        expect(page.get_by_text("This run cannot be opened")).to_be_visible()
        page.get_by_role("button", name="All past runs").click()
        expect(page.get_by_text("No past runs")).to_be_visible()


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [DESK, nightly(PHONE)])
def test_everything_is_accessible(
    browser: Browser, sorted_shop: tuple[Workshop, str], scheme: Scheme, size: Size
) -> None:
    """The timeline at a moment of the past, and the failure."""
    shop, run = sorted_shop
    with at_timeline(browser, shop, f"/runs/{run}", size=size, scheme=scheme) as page:
        slider(page).press("Home")
        expect(page.locator("[data-past-line]")).to_be_visible()
        require_accessible(page, "timeline")
        page.get_by_role("tab", name="Failure").click()
        expect(page.get_by_role("region", name="How the run failed")).to_be_visible()
        require_accessible(page, "failure")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_lists_are_accessible(browser: Browser, sorted_shop: tuple[Workshop, str], scheme: Scheme) -> None:
    """Past runs and recordings, two runs compared at a visit of the address, and the last runs of a behavior."""
    shop, run = sorted_shop
    with opened_page(browser, shop.running, "/past", scheme=scheme) as page:
        expect(page.get_by_role("list", name="Past runs").get_by_role("link")).to_be_visible()
        require_accessible(page, "lists")
        page.goto(f"{shop.running.url}compare/{run}/{run}#root/approach@1")
        expect(page.get_by_role("button", name="root/approach, visit 1")).to_have_attribute("aria-pressed", "true")
        require_accessible(page, "comparison")
        page.goto(f"{shop.running.url}trends/sort")
        expect(page.get_by_role("list", name="Last runs")).to_be_visible()
        require_accessible(page, "trend")
