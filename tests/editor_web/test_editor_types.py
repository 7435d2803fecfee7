"""The type of nodes is replaced in place in a browser: what is lost is shown before, and one undo gives it back."""

from __future__ import annotations

from playwright.sync_api import Browser, expect

from engine.document import load_behavior
from tests.editor_web.editing import at_editor, card, file_text, idle, save
from tests.editor_web.workshop import SHIFT_ID, Workshop


def test_a_state_gets_another_class_and_its_losses_are_shown_before(browser: Browser, shop: Workshop) -> None:
    before = file_text(shop, SHIFT_ID)
    with at_editor(browser, shop, SHIFT_ID) as page:
        card(page, "root/first").locator("[data-head]").click()
        page.keyboard.press("Shift+R")
        page.keyboard.type("flow.wait")
        page.keyboard.press("Enter")
        dialog = page.get_by_role("dialog", name="Replace by flow.Wait")
        expect(dialog.get_by_role("row")).to_have_count(5)
        expect(dialog).to_contain_text("parameter after_s")
        expect(dialog).to_contain_text("transition b")
        dialog.get_by_role("button", name="Keep it").click()
        save(page)
        assert file_text(shop, SHIFT_ID) == before
        page.get_by_role("button", name="Replace first").click()
        page.keyboard.type("flow.wait")
        page.keyboard.press("Enter")
        dialog.get_by_role("button", name="Replace", exact=True).click()
        expect(card(page, "root/first")).to_contain_text("flow.Wait")
        save(page)
        assert load_behavior(shop.project / SHIFT_ID).root.children["first"].state == "flow.Wait"
        page.keyboard.press("Control+z")
        expect(card(page, "root/first")).to_contain_text("test.Give")
        save(page)
    assert file_text(shop, SHIFT_ID) == before


def test_the_kind_of_a_container_is_replaced_where_nothing_is_lost_at_once(browser: Browser, shop: Workshop) -> None:
    """Its nodes, arrows and positions stay."""
    before = file_text(shop, SHIFT_ID)
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.keyboard.press("Shift+R")
        page.keyboard.type("priority")
        page.keyboard.press("Enter")
        expect(page.get_by_role("dialog")).to_have_count(0)
        expect(card(page, "root/both")).to_be_visible()
        idle(page)
        save(page)
    assert file_text(shop, SHIFT_ID) == before.replace("  machine:\n", "  priority:\n", 1)
