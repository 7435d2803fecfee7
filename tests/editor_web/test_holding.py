"""Holding a run at its nodes in a real browser: breakpoints, locks, forced outcomes, repeats, and what it asks."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

from playwright.sync_api import Browser, Locator, Page, expect

from engine.event import NodeExited
from engine.runtime.run_options import RunOptions
from tests.editor_web.browsing import Size, opened_page, until
from tests.editor_web.workshop import SHIFT_ID, Workshop

LAPTOP: Size = (1280, 800)
BREAKPOINTS = "behaviors/shift.breakpoints.yaml"


@contextmanager
def at_shift(browser: Browser, shop: Workshop, *, quiet: bool = True) -> Generator[Page]:
    """The page of the behavior `shift`."""
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}", size=LAPTOP, quiet=quiet) as page:
        expect(node(page, "root/first")).to_be_visible()
        yield page


def node(page: Page, path: str) -> Locator:
    """A node of the graph."""
    return page.locator(f".react-flow__node[data-id='{path}'] [data-node]")


def dot(page: Page, path: str) -> Locator:
    """The dot of a node by which the mouse sets a breakpoint."""
    return page.get_by_role("button", name=f"Breakpoint before {path}", exact=True)


def card(page: Page, path: str) -> Locator:
    """What can be done with a node, once it is chosen."""
    node(page, path).click()
    return page.get_by_role("region", name=f"Node {path}")


def waits(page: Page) -> Locator:
    """Where the run waits, in words."""
    return page.get_by_role("list", name="Nodes that wait")


def test_a_breakpoint_is_set_by_a_click_and_kept_beside_the_file(browser: Browser, shop: Workshop) -> None:
    """It stops the next run, is marked on the node, listed, and taken away with its file."""
    with at_shift(browser, shop) as page:
        node(page, "root/set").hover()
        with page.expect_response("**/api/v1/breakpoints/**"):
            dot(page, "root/set").click()
        expect(dot(page, "root/set")).to_have_attribute("aria-pressed", "true")
        assert "root/set" in (shop.project / BREAKPOINTS).read_text(encoding="utf-8")
        page.get_by_role("button", name="Start").click()
        expect(waits(page)).to_have_text("root/set before its entry: paused")
        expect(page.get_by_role("log")).to_contain_text("breakpoint before root/set")
        page.reload()
        expect(dot(page, "root/set")).to_have_attribute("aria-pressed", "true")
        page.get_by_role("tab", name="Breakpoints").click()
        with page.expect_response("**/api/v1/breakpoints/**"):
            page.get_by_role("button", name="Remove the breakpoint before root/set").click()
        expect(page.get_by_text("Nothing holds this behavior")).to_be_visible()
        expect(dot(page, "root/set")).to_have_attribute("aria-pressed", "false")
        (run,) = shop.session.runs()
        until(page, lambda: shop.on_loop(lambda: shop.session.control(run.id).view().breakpoints) == ())
    assert not (shop.project / BREAKPOINTS).exists()


def test_a_breakpoint_has_a_condition_and_a_count(browser: Browser, shop: Workshop) -> None:
    """A condition that does not compile is refused; one that does stops the run where it holds."""
    run = shop.start(supervision=RunOptions(start_paused=True))
    with at_shift(browser, shop, quiet=False) as page:
        chosen = card(page, "root/rest")
        chosen.get_by_label("Pause before its entry").click()
        chosen.get_by_role("combobox", name="Only if").fill("value >")
        chosen.get_by_role("combobox", name="Only if").press("Enter")
        expect(page.get_by_role("alert")).to_contain_text("Breakpoint was refused")
        chosen.get_by_role("combobox", name="Only if").fill("value == 1")
        chosen.get_by_label("From time").fill("1")
        chosen.get_by_role("combobox", name="Only if").press("Enter")
        expect(page.get_by_role("alert")).to_have_count(0)
        # The one before may still be on its way.
        with page.expect_response(lambda answer: '"after"' in (answer.request.post_data or "")):
            chosen.get_by_label("Pause after its outcome").click()
        page.get_by_role("tab", name="Breakpoints").click()
        expect(page.get_by_text("before, if value == 1")).to_be_visible()
        page.get_by_role("button", name="Resume", exact=True).click()
        expect(waits(page)).to_have_text("root/rest before its entry: paused")
    points = shop.on_loop(lambda: shop.session.control(run).view().breakpoints)
    assert [(each.path, each.when, each.condition) for each in points] == [
        ("root/rest", "before", "value == 1"),
        ("root/rest", "after", None),
    ]
    assert shop.on_loop(lambda: shop.session.breakpoints(SHIFT_ID)) == points


def test_a_locked_node_is_held_with_its_reason_until_it_is_unlocked(browser: Browser, shop: Workshop) -> None:
    """All pages read the reason, also after a reload."""
    shop.start(supervision=RunOptions(start_paused=True))
    with at_shift(browser, shop) as page:
        chosen = card(page, "root/set")
        chosen.get_by_label("Reason of the lock").fill("the tray is being changed")
        chosen.get_by_role("button", name="Lock", exact=True).click()
        expect(chosen).to_contain_text("Locked: the tray is being changed")
        expect(node(page, "root/set").locator('[data-mark="lock"]')).to_be_visible()
        page.get_by_role("button", name="Resume", exact=True).click()
        expect(waits(page)).to_have_text("root/set with done: locked")
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Waiting at lock")
        page.reload()
        page.get_by_role("tab", name="Breakpoints").click()
        expect(page.get_by_text("locked: the tray is being changed")).to_be_visible()
        page.get_by_role("button", name="Unlock root/set").click()
        expect(node(page, "root/rest")).to_have_attribute("data-status", "active")


def test_what_the_run_asks_is_answered_by_keyboard(browser: Browser, shop: Workshop) -> None:
    """Several at once, each with its ways; one is agreed to, one ended otherwise."""
    run = shop.start(supervision=RunOptions(autonomy="low", demand_operator=True))
    with at_shift(browser, shop) as page:
        asked = page.get_by_role("region", name="The run asks")
        expect(asked.get_by_role("listitem")).to_have_count(2)
        expect(asked.get_by_role("listitem", name="Question of root/both/left")).to_contain_text(
            "root/both/left wants to end with a, which requires high"
        )
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Waiting for answer")
        expect(node(page, "root/both/left")).to_contain_text("asks: a")
        expect(page.get_by_role("navigation", name="Runs")).to_contain_text("Waiting for answer")
        page.keyboard.press("a")
        expect(asked.get_by_role("button", name="Agree: a").first).to_be_focused()
        page.keyboard.press("Enter")
        expect(asked.get_by_role("listitem")).to_have_count(1)
        asked.get_by_role("button", name="Force outcome: b").click()
        expect(asked).to_have_count(0)
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Failed: bad")
    ends = {event.path: event.outcome for event in shop.events(run) if isinstance(event, NodeExited)}
    assert ends["root/both"] == "odd"


def test_a_page_that_starts_a_run_below_full_autonomy_operates_it(browser: Browser, shop: Workshop) -> None:
    """The form says who is asked and what a loss means."""
    with at_shift(browser, shop) as page:
        page.get_by_role("button", name="Operation").click()
        page.get_by_role("combobox", name="Autonomy at the start").click()
        page.get_by_role("option", name="high").click()
        expect(page.get_by_label("Take control of it from this page")).to_be_checked()
        page.get_by_role("combobox", name="When the operator is lost").click()
        page.get_by_role("option", name="stop the run").click()
        page.get_by_label("After").fill("7")
        page.get_by_role("button", name="Start").click()
        expect(
            page.get_by_text("You operate this run. If this page is lost, 7 s later the run is stopped.")
        ).to_be_visible()
        expect(page.get_by_role("listitem", name="Question of root/both/left")).to_be_visible()
        expect(page.get_by_role("region", name="The run asks").get_by_role("listitem")).to_have_count(1)
