"""Targets that an arm of the document's cell cannot be at are problems in the editor, and marks on their nodes."""

from __future__ import annotations

import os
from pathlib import Path

from playwright.sync_api import Browser, Page, Request, expect

from tests.editor_web.browsing import require_accessible
from tests.editor_web.editing import at_editor, card, file_text, idle
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.workshop import Workshop
from tests.engine.editing.target_texts import FAR, ID, IN_POST, REACH, written

SHOTS = os.environ.get("FLEXCELL_SHOTS", "")
"""A folder for pictures, for who wants to look."""


def target(page: Page, text: str) -> None:
    """Give the motion another target."""
    box = page.get_by_role("textbox", name="Text of the behavior")
    expect(box).to_be_visible()
    page.evaluate("(text) => navigator.clipboard.writeText(text)", text)
    box.focus()
    page.keyboard.press("Control+a")
    page.keyboard.press("Control+v")


def test_a_target_out_of_reach_is_a_problem_and_marks_its_node(browser: Browser, shop: Workshop) -> None:
    """It comes after the edit is drawn, follows the text, counts as one says, and is not looked for when off."""
    written(shop.project, FAR)
    with at_editor(browser, shop, ID) as page:
        count = page.locator("[data-problem-count]")
        expect(count).to_have_text("1 warning", timeout=GUARD_MS)
        expect(card(page, "root/go").locator("[data-severity='warning']")).to_be_visible()
        count.click()
        problems = page.get_by_role("list", name="Problems")
        expect(problems).to_contain_text("line 12")
        problems.get_by_role("button").click()
        expect(problems).to_contain_text("root/go · unreachable-target")
        require_accessible(page, "problems with targets", part="[data-inspector]")
        if SHOTS:
            page.screenshot(path=str(Path(SHOTS) / "targets.png"))
        choice = page.get_by_label("Targets out of reach or in collision")
        choice.select_option("are errors")
        expect(count).to_have_text("1 error", timeout=GUARD_MS)
        expect(card(page, "root/go").locator("[data-severity='error']")).to_be_visible()
        choice.select_option("are not looked for")
        expect(count).to_have_text("No problems")
        page.reload()
        idle(page)
        page.locator("[data-problem-count]").click()
        expect(page.get_by_label("Targets out of reach or in collision")).to_have_value("off")


def test_targets_follow_the_text(browser: Browser, shop: Workshop) -> None:
    """Of texts that follow one another at once the last one is shown; a good one takes the problem away."""
    written(shop.project, REACH)
    asked: list[Request] = []
    with at_editor(browser, shop, ID) as page:
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        page.on("request", lambda request: asked.append(request) if request.url.endswith("/targets") else None)
        expect(page.locator("[data-problem-count]")).to_have_text("No problems")
        page.keyboard.press("y")
        for text in (FAR, IN_POST):
            target(page, text)
        expect(page.locator("[data-problem-count]")).to_have_text("1 warning", timeout=GUARD_MS)
        page.locator("[data-problem-count]").click()
        page.get_by_role("list", name="Problems").get_by_role("button").click()
        expect(page.get_by_role("list", name="Problems")).to_contain_text("target-in-collision")
        target(page, REACH)
        expect(page.locator("[data-problem-count]")).to_have_text("No problems", timeout=GUARD_MS)
        assert file_text(shop, ID) == REACH
        assert asked


def test_names_are_picked_from_the_documents_own_cell(browser: Browser, shop: Workshop) -> None:
    """No cell is open here."""
    written(shop.project)
    with at_editor(browser, shop, ID) as page:
        card(page, "root/go").click()
        page.get_by_role("combobox", name="robot", exact=True).click()
        expect(page.get_by_role("option", name="left")).to_be_visible()
