"""What an operator does most, by keyboard alone: start and approve a run, find why one failed, compare two.

Recovery after a stop is in `test_stop_recovery.py`, building in `test_editor_building.py`, teaching in
`test_teach_entries.py` and `test_value_wizards.py`.
"""

from __future__ import annotations

import re
from collections.abc import Generator

import pytest
from playwright.sync_api import Browser, Page, expect

from engine.event import NodeExited
from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import opened_page, tab_to
from tests.editor_web.test_timeline_page import SORT, SORT_ID, node
from tests.editor_web.workshop import SHIFT_ID, Workshop


@pytest.fixture(scope="module")
def shop(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[Workshop]:
    """One server for all tasks, with two runs that failed."""
    project = tmp_path_factory.mktemp("tasks")
    (project / "behaviors").mkdir()
    (project / SORT_ID).write_text(SORT, encoding="utf-8")
    with Workshop(host=loopback, project=project) as opened:
        for run in (opened.start(SORT_ID), opened.start(SORT_ID)):
            opened.call(opened.session.wait(run))
        yield opened


def choose_option(page: Page, name: str) -> None:
    """Choose by the arrow keys in the box that has the keyboard."""
    page.keyboard.press("ArrowDown")
    option = page.get_by_role("option", name=name)
    expect(option).to_be_visible()
    for _ in range(page.get_by_role("option").count()):
        if option.get_attribute("data-combobox-selected"):
            break
        page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    expect(option).to_have_count(0)


def test_a_run_is_started_and_what_it_asks_is_approved(browser: Browser, shop: Workshop) -> None:
    """With a low autonomy; each question is gone to by its key."""
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}") as page:
        tab_to(page, page.get_by_role("button", name="Operation"))
        page.keyboard.press("Enter")
        tab_to(page, page.get_by_role("combobox", name="Autonomy at the start"))
        choose_option(page, "low")
        tab_to(page, page.get_by_role("button", name="Start", exact=True))
        page.keyboard.press("Enter")
        asked = page.get_by_role("region", name="The run asks").get_by_role("listitem")
        expect(asked).to_have_count(2)
        for left in (1, 0):
            page.keyboard.press("a")
            expect(page.get_by_role("button", name="Agree: a").first).to_be_focused()
            page.keyboard.press("Enter")
            expect(asked).to_have_count(left)
        expect(node(page, "root/rest")).to_have_attribute("data-status", "active")
        page.keyboard.press("Shift+S")
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Stopped")
    run = shop.session.runs()[0]
    assert (run.behavior, run.status) == (SHIFT_ID, "stopped")
    ends = {event.path: event.outcome for event in shop.events(run.id) if isinstance(event, NodeExited)}
    assert ends["root/both"] == "finished"


def test_why_a_run_failed_is_found_from_the_first_page(browser: Browser, shop: Workshop) -> None:
    """Its cause, the node, and the moment on the timeline."""
    with opened_page(browser, shop.running) as page:
        tab_to(page, page.get_by_role("region", name="Table of the latest runs").get_by_role("link", name="sort").first)
        page.keyboard.press("Enter")
        tab_to(page, page.get_by_role("button", name="Show failure"))
        page.keyboard.press("Enter")
        failed = page.get_by_role("region", name="How the run failed")
        expect(failed.get_by_role("heading", name="division by zero")).to_be_visible()
        require_unique_names(page, "a failure")
        tab_to(page, page.get_by_role("button", name="Show the moment"))
        page.keyboard.press("Enter")
        expect(page.get_by_role("navigation", name="Path of the selection")).to_contain_text("look")
        expect(page.locator("[data-past-line]")).to_be_visible()
        tab_to(page, failed.get_by_role("button", name="root", exact=True))
        page.keyboard.press("Enter")
        expect(page.get_by_role("navigation", name="Path of the selection")).not_to_contain_text("look")


def test_two_runs_are_compared(browser: Browser, shop: Workshop) -> None:
    """Ticked in the list of past runs; a visit is selected, and each tab is gone to by the arrow keys."""
    with opened_page(browser, shop.running, "/past") as page:
        ticks = page.get_by_role("list", name="Past runs").get_by_role("checkbox", name=re.compile("^Compare sort"))
        expect(ticks).to_have_count(2)
        for tick in ticks.all():
            tab_to(page, tick)
            page.keyboard.press("Space")
        tab_to(page, page.get_by_role("group", name="Selected runs").get_by_role("button", name="Compare"))
        page.keyboard.press("Enter")
        visit = page.get_by_role("button", name="root/both, visit 1")
        tab_to(page, visit)
        page.keyboard.press("Enter")
        expect(visit).to_have_attribute("aria-pressed", "true")
        expect(page.get_by_role("tabpanel", name="Visit")).to_contain_text("root/both")
        tab_to(page, page.get_by_role("tab", name="Visit"))
        for name in ("Durations", "Settings", "Curves", "3D"):
            page.keyboard.press("ArrowRight")
            expect(page.get_by_role("tab", name=name)).to_have_attribute("aria-selected", "true")
