"""From a stopped cell back to a run in a real browser, with a part in the hand; the clicks are counted."""

from __future__ import annotations

import re
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, Locator, Page, expect

from editor_web.security.authentication import VIEWER
from engine.store import Joints, SqliteStore
from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import PHONE, opened_page, require_accessible, require_fit, tab_to, until
from tests.editor_web.stop_process import stop_button, stop_status
from tests.editor_web.workshop import NAP_ID, Workshop
from tests.engine.project.holding_arm import HOME, HoldingArm, put_into

CLICKS = 11
"""Stop, keep, reset; and home, release of the part, release of the stop and resume, which are confirmed."""


class Clicks:
    """Clicks, and counts them."""

    def __init__(self) -> None:
        self.count = 0

    def on(self, button: Locator) -> None:
        button.click()
        self.count += 1


@contextmanager
def holding_arm(shop: Workshop, project: Path) -> Generator[HoldingArm]:
    """The cell of the shop has an arm that holds a part and knows its home."""
    store = SqliteStore.open(project / "cell.db")
    shop.call(store.put("joints", "left_home", Joints(joints=HOME), by="test"))
    shop.session.cell.store = store
    try:
        yield shop.on_loop(lambda: put_into(shop.session.cell))
    finally:
        shop.call(store.close())


def guide(page: Page) -> Locator:
    """The recovery guide."""
    return page.get_by_role("region", name="Recovery guide")


def confirm(page: Page, clicks: Clicks, name: str) -> None:
    """Press a button of the guide and say yes to its question."""
    clicks.on(guide(page).get_by_role("button", name=name, exact=True))
    clicks.on(page.get_by_role("dialog").get_by_role("button", name=name, exact=True))


def step(page: Page, title: str, state: str) -> Locator:
    """The head of a step in this state."""
    return guide(page).get_by_role("button", name=re.compile(f"{title}.*{state}"))


def test_a_stop_with_a_part_in_the_hand_leads_back_to_the_run(browser: Browser, shop: Workshop, tmp_path: Path) -> None:
    """Step by step, over a reload, seen by a second page that is logged in as a viewer."""
    clicks = Clicks()
    shop.start(NAP_ID)
    viewer = shop.running.new_login_url(role=VIEWER)
    with (
        holding_arm(shop, tmp_path) as arm,
        opened_page(browser, shop.running) as page,
        opened_page(browser, shop.running, "/past", login=viewer, quiet=False) as other,
    ):
        clicks.on(stop_button(page))
        expect(stop_status(page)).to_contain_text("All arms at rest")
        expect(page.get_by_role("region", name="Stopped cell")).to_contain_text("left at rest after ")
        clicks.on(guide(page).get_by_role("button", name="Keep", exact=True))
        expect(step(page, "What the arms hold", "done")).to_be_visible()
        require_accessible(page, "the recovery guide")
        other.get_by_role("button", name="Recovery guide").click()
        expect(step(other, "What the arms hold", "done")).to_be_visible()
        expect(guide(other).get_by_role("button", name="Go home", exact=True)).to_be_disabled()
        confirm(page, clicks, "Go home")
        expect(step(page, "Go home", "done")).to_be_visible()
        page.reload()
        expect(step(page, "Go home", "done")).to_be_visible()
        step(page, "What the arms hold", "done").click()
        confirm(page, clicks, "Release")
        expect(step(page, "What the arms hold", "not needed")).to_be_visible()
        clicks.on(guide(page).get_by_role("button", name="Reset parts", exact=True))
        expect(step(page, "Reset the parts", "done")).to_be_visible()
        confirm(page, clicks, "Release the stop")
        expect(step(other, "Release the stop", "done")).to_be_visible()
        confirm(page, clicks, "Resume")
        expect(page).to_have_url(re.compile("/runs/"))
        for each in (page, other):
            expect(each.get_by_role("region", name="Stopped cell")).to_have_count(0)
    assert arm.scene == [("attach", "cube"), ("attach", "cube"), ("detach", "cube")]
    assert clicks.count == CLICKS


def test_a_stopped_cell_is_recovered_by_keyboard_alone(browser: Browser, shop: Workshop, tmp_path: Path) -> None:
    """Stop by its key; every step and its question by Tab and Enter."""

    def press(name: str, *, is_asked: bool = True) -> None:
        tab_to(page, guide(page).get_by_role("button", name=name, exact=True))
        page.keyboard.press("Enter")
        if is_asked:
            expect(page.get_by_role("dialog").get_by_role("button", name=name, exact=True)).to_be_focused()
            page.keyboard.press("Enter")

    shop.start(NAP_ID)
    with holding_arm(shop, tmp_path) as arm, opened_page(browser, shop.running) as page:
        expect(stop_button(page)).to_be_visible()
        page.keyboard.press("Control+Shift+Backspace")
        press("Keep", is_asked=False)
        expect(step(page, "What the arms hold", "done")).to_be_visible()
        require_unique_names(page, "the recovery guide")
        press("Go home")
        expect(step(page, "Go home", "done")).to_be_visible()
        press("Reset parts", is_asked=False)
        expect(step(page, "Reset the parts", "done")).to_be_visible()
        press("Release the stop")
        expect(step(page, "Release the stop", "done")).to_be_visible()
        press("Resume")
        expect(page).to_have_url(re.compile("/runs/"))
    assert arm.joints == HOME


def test_stop_is_above_a_question_of_the_guide_and_fits_a_phone(
    browser: Browser, shop: Workshop, tmp_path: Path
) -> None:
    """A dialog keeps the keyboard, and Stop can be clicked above it; the guide can be closed again."""
    with holding_arm(shop, tmp_path), opened_page(browser, shop.running, size=PHONE) as page:
        stop_button(page).click()
        guide(page).get_by_role("button", name="Release", exact=True).click()
        expect(page.get_by_role("dialog")).to_be_visible()
        stop_button(page).click()
        until(page, lambda: _number(shop) == 2)
        page.keyboard.press("Control+Shift+Backspace")
        until(page, lambda: _number(shop) == 3)
        page.get_by_role("dialog").get_by_role("button", name="Cancel").click()
        require_fit(page, PHONE[0])
        page.get_by_role("button", name="Close the recovery guide").click()
        expect(guide(page)).to_have_count(0)
        expect(page.get_by_role("button", name="Recovery guide")).to_be_visible()
        require_fit(page, PHONE[0])


def _number(shop: Workshop) -> int:
    stop = shop.call(shop.session.recovery.state())
    assert stop is not None
    return stop.number
