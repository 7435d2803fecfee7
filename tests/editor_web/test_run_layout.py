"""Layouts of the page of a run in a real browser: what is large, what stays in its place, what is kept."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Browser, Locator, Page, expect

from tests.editor_web.browsing import opened_page, require_accessible, require_fit, until
from tests.editor_web.fake_planner import CONFIRMED_ID
from tests.editor_web.test_planned_paths import ASKED, Shop
from tests.editor_web.workshop import SHIFT_ID, Workshop

SMALL = (1280, 800)


def area(part: Locator) -> float:
    """Square pixels."""
    box = part.bounding_box()
    assert box is not None
    return box["width"] * box["height"]


def places(page: Page) -> tuple[float, ...]:
    """Height of the status row, and the top of what follows it."""
    row = page.get_by_role("region", name="Status of the run").bounding_box()
    graph = page.get_by_role("region", name="Graph").bounding_box()
    assert row is not None
    assert graph is not None
    return row["y"], row["height"], graph["y"]


def state(page: Page) -> Locator:
    """The word for the state of the run."""
    return page.get_by_role("status", name="State of the run")


def test_nothing_moves_as_the_state_of_the_run_changes(browser: Browser, shop: Workshop) -> None:
    """Without a run, running, paused, asking, refused, stopped: the row is as high, and what follows as low."""
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}", size=SMALL) as page:
        expect(state(page)).to_have_text("No run")
        expect(page.get_by_role("application")).to_be_visible()
        before = places(page)
        shop.start(SHIFT_ID, supervision=ASKED)
        expect(state(page)).to_have_text("Waiting for answer")
        assert places(page) == before
        page.get_by_role("button", name="Step into").press("Enter")
        expect(page.get_by_role("alert")).to_contain_text("was refused")
        assert places(page) == before
        questions = page.get_by_role("listitem", name=re.compile("^Question of"))
        for left in (1, 0):
            questions.first.get_by_role("button", name=re.compile("^Agree")).click()
            expect(questions).to_have_count(left)
        expect(state(page)).to_have_text("Running")
        page.get_by_role("button", name="Pause", exact=True).click()
        expect(state(page)).to_have_text("Paused")
        assert places(page) == before
        page.get_by_role("button", name="Stop this run").click()
        expect(state(page)).to_have_text("Stopped")
        assert places(page) == before


def test_layouts_are_chosen_kept_and_in_the_address(browser: Browser, tmp_path: Path, loopback: str) -> None:
    """The 3D view has half of the page to operate, most of it at a question about a path, and is never loaded anew."""
    with (
        Shop(host=loopback, project=tmp_path, cell_view=True) as shop,
        opened_page(browser, shop.running, f"/behaviors/{CONFIRMED_ID}", size=SMALL) as page,
    ):
        view = page.locator("iframe[title='3D view of the cell']")
        cell, space = page.get_by_role("region", name="Cell", exact=True), page.locator("[data-work-space]")
        expect(view).to_be_visible()
        view.evaluate("(frame) => { frame.isTheSame = true }")
        assert area(cell) > 0.5 * area(space)
        page.get_by_text("Debug", exact=True).click()
        expect(page.get_by_role("tab", name="Timeline")).to_be_visible()
        expect(page.get_by_role("log")).to_be_visible()
        expect(page).to_have_url(re.compile(r"\?layout=debug$"))
        require_fit(page, *SMALL)
        width = page.get_by_role("separator", name="Width of the graph")
        width.press("ArrowLeft")
        dragged = area(cell)
        page.get_by_text("3D only", exact=True).click()
        expect(page.get_by_role("application")).to_have_count(0)
        assert area(cell) > 0.95 * area(space)
        page.get_by_text("Debug", exact=True).click()
        until(page, lambda: abs(area(cell) - dragged) < 0.01 * dragged)
        page.get_by_text("Operate", exact=True).click()
        shop.start(CONFIRMED_ID, supervision=ASKED)
        expect(page.get_by_role("slider", name="Along the path of left")).to_be_visible()
        until(page, lambda: area(cell) > 0.7 * area(space))
        page.get_by_role("slider", name="Along the path of left").press("ArrowRight")
        expect(page.get_by_text("1 %", exact=True)).to_be_visible()
        assert view.evaluate("(frame) => frame.isTheSame")
        # It is loaded anew with the other theme.
        require_accessible(page, "a question about a path")
        page.get_by_text("Operate", exact=True).click()
        until(page, lambda: area(cell) < 0.7 * area(space))
