"""Notes of the editor, a merge with conflicts, and who is there: axe in both themes, worked by keyboard."""

from __future__ import annotations

import re

from playwright.sync_api import Browser, Page, expect

from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import opened_page, require_accessible, tab_to
from tests.editor_web.editing import at_editor, card, file_text, idle, save
from tests.editor_web.test_editor_project import come_back
from tests.editor_web.workshop import NAP_ID, SHIFT, SHIFT_ID, Workshop

LASTING_NOTES = """
const later = window.setTimeout
window.setTimeout = (done, ms, ...values) => later(done, ms === 2500 ? 60000 : ms, ...values)
"""
"""What was done is said for 2.5 s, less than axe takes on a busy machine."""


def change_rest(page: Page, duration_s: str) -> None:
    card(page, "root/rest").focus()
    page.keyboard.press("Enter")
    field = page.get_by_role("combobox", name="duration_s")
    expect(field).to_be_visible()
    field.fill(duration_s)
    field.press("Tab")
    idle(page)


def test_conflicts_of_a_merge_are_decided_by_keyboard(browser: Browser, shop: Workshop) -> None:
    """The note that leads there, the panel, both texts side by side; the file has what was chosen."""
    with at_editor(browser, shop, SHIFT_ID, quiet=False) as page:
        change_rest(page, "5")
        changed = SHIFT.replace("3000", "7").replace("value: 1}", "value: 8}")
        (shop.project / SHIFT_ID).write_text(changed, encoding="utf-8")
        come_back(page)
        expect(page.get_by_role("alert")).to_contain_text("The file has changed on disk")
        require_accessible(page, "a file that has changed")
        tab_to(page, page.get_by_role("button", name="Merge now"))
        page.keyboard.press("Enter")
        panel = page.get_by_role("region", name="Conflicts")
        expect(panel.get_by_role("status")).to_have_text("The file has changed: 1 conflict, 1 open")
        require_accessible(page, "conflicts", part="[aria-label=Conflicts]")
        require_unique_names(page, "conflicts")
        tab_to(page, panel.get_by_role("button", name="Compare the texts"))
        page.keyboard.press("Enter")
        dialog = page.get_by_role("dialog", name="The file has changed on disk")
        expect(dialog).to_be_visible()
        require_accessible(page, "both texts", part="dialog[open]")
        page.keyboard.press("Escape")
        expect(dialog).to_have_count(0)
        tab_to(page, panel.get_by_role("radio", name=re.compile("^Mine")), key="Shift+Tab")
        page.keyboard.press("Space")
        expect(panel.get_by_role("status")).to_have_text("The file has changed: 1 conflict, 0 open")
        tab_to(page, panel.get_by_role("button", name="Save with these choices"))
        page.keyboard.press("Enter")
        expect(panel).to_have_count(0)
        expect(page.locator("[data-unsaved]")).to_have_count(0)
    text = file_text(shop, SHIFT_ID)
    assert "duration_s: 5" in text
    assert "value: 8" in text


def test_notes_of_the_editor_are_accessible(browser: Browser, shop: Workshop) -> None:
    """A draft of an earlier visit beside a refusal, and what was done."""
    with at_editor(browser, shop, NAP_ID, quiet=False) as page:
        card(page, "root/only").focus()
        page.keyboard.press("Delete")
        expect(page.locator("[data-unsaved]")).to_be_visible()
        page.add_init_script(LASTING_NOTES)
        page.reload()
        expect(page.get_by_text("Your unsaved changes of an earlier visit are here.")).to_be_visible()
        idle(page)
        page.keyboard.press("Control+Enter")
        expect(page.get_by_role("alert")).to_contain_text(
            "Run: the behavior is not finished. – A container is empty: add a node to it."
        )
        require_accessible(page, "a refusal beside a draft of an earlier visit")
        require_unique_names(page, "a refusal beside a draft of an earlier visit")
        page.keyboard.press("Control+z")
        expect(card(page, "root/only")).to_be_visible()
        tab_to(page, page.get_by_role("button", name="Put the refusal away"))
        page.keyboard.press("Enter")
        expect(page.get_by_role("alert")).to_have_count(0)
        card(page, "root/only").click()
        page.keyboard.press("Control+d")
        save(page)
        expect(page.get_by_text("Saved", exact=True)).to_be_visible()
        require_accessible(page, "what was done")


def test_the_list_of_open_pages_is_accessible_and_worked_by_keyboard(browser: Browser, shop: Workshop) -> None:
    """One page operates a run, the other one sees it; a name is given to this page."""
    shop.start(NAP_ID)
    with (
        opened_page(browser, shop.running, f"/behaviors/{NAP_ID}") as page,
        opened_page(browser, shop.running, f"/behaviors/{NAP_ID}") as other,
    ):
        page.get_by_role("button", name="Take control").press("Enter")
        people = other.get_by_role("button", name=re.compile("^2 pages open, .* operates"))
        tab_to(other, people)
        other.keyboard.press("Enter")
        pages = other.get_by_role("list", name="Open pages").get_by_role("listitem")
        expect(pages).to_have_count(2)
        require_accessible(other, "open pages")
        require_unique_names(other, "open pages")
        tab_to(other, other.get_by_role("textbox", name="Your name"))
        other.keyboard.type("Ana")
        other.keyboard.press("Enter")
        expect(pages.filter(has_text="Ana (this page)")).to_have_count(1)
        other.keyboard.press("Escape")
        expect(pages).to_have_count(0)
        expect(people).to_be_focused()
