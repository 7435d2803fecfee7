"""Usages of what a node runs, own keys, conditions at their node and watches, in a real browser."""

from __future__ import annotations

import re

from playwright.sync_api import Browser, Locator, Page, expect

from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import opened_page, require_accessible, switch
from tests.editor_web.editing import LAPTOP, at_editor, card
from tests.editor_web.workshop import NAP_ID, SHIFT_ID, Workshop


def _key_row(page: Page, command: str) -> Locator:
    return page.get_by_role("dialog", name="Keyboard").locator(f"[data-key-of='{command}']")


def test_usages_lead_to_a_node_of_another_document_and_a_changed_key_is_said_and_works(
    browser: Browser, shop: Workshop
) -> None:
    with at_editor(browser, shop, SHIFT_ID) as page:
        card(page, "root/rest").click()
        page.keyboard.press("Shift+F12")
        dialog = page.get_by_role("dialog", name="Usages")
        expect(dialog).to_contain_text("2 places in 2 documents")
        expect(dialog).to_contain_text("nap.yaml:10")
        require_accessible(page, "usages")
        dialog.get_by_role("button", name="root/only").click()
        expect(page).to_have_url(re.compile(rf"/edit/{NAP_ID}#root/only$"))
        expect(card(page, "root/only").locator("[data-card]")).to_have_attribute("data-selected", "true")
        page.keyboard.press("?")
        require_accessible(page, "keys")
        _key_row(page, "duplicate").get_by_role("button", name="Change the key").click()
        page.keyboard.press("d")
        expect(_key_row(page, "duplicate")).to_contain_text("It is the key of")
        require_accessible(page, "a key that another command has", part="dialog[open]")
        require_unique_names(page, "a key that another command has")
        page.keyboard.press("F9")
        expect(_key_row(page, "duplicate")).to_contain_text("F9")
        page.keyboard.press("Escape")
        expect(page.get_by_role("button", name="Duplicate (F9)")).to_be_visible()
        card(page, "root/only").click()
        page.keyboard.press("F9")
        expect(card(page, "root/only_2")).to_be_visible()


def test_a_condition_is_checked_at_its_node_and_a_watch_follows_the_run(browser: Browser, shop: Workshop) -> None:
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}", size=LAPTOP) as page:
        node = page.locator(".react-flow__node[data-id='root/set'] [data-node]")
        node.click(button="right")
        page.get_by_role("menuitem", name="Breakpoint: condition and count").click()
        form = page.get_by_role("dialog", name="Breakpoints of set")
        switch(form.get_by_label("Pause before its entry"))
        condition = form.get_by_role("combobox", name="Only if")
        condition.fill("valu == 0")
        expect(form).to_contain_text("`valu` is not defined before `set`; did you mean value?")
        condition.fill("value == 0")
        expect(form).not_to_contain_text("not defined")
        condition.press("Enter")
        require_accessible(page, "breakpoint form")
        require_unique_names(page, "breakpoint form")
        page.keyboard.press("Escape")
        expect(form).to_have_count(0)
        page.get_by_role("button", name="Start", exact=True).click()
        expect(page.get_by_role("status", name="State of the run")).to_contain_text("Paused")
        page.get_by_role("tab", name="Data", exact=True).click()
        watch = page.get_by_role("combobox", name="New watch")
        watch.fill("value + 41")
        watch.press("Enter")
        values = page.get_by_role("region", name="Watches").get_by_role("listitem")
        expect(values).to_contain_text("41")
        require_accessible(page, "a watch", part="section[aria-label=Data]")
        page.get_by_role("button", name="Edit the watch value + 41").click()
        expect(page.get_by_role("combobox", name="Expression of the watch value + 41")).to_be_focused()
        require_accessible(page, "a watch that is edited", part="section[aria-label=Data]")
        require_unique_names(page, "a watch that is edited")
        page.keyboard.press("End")
        page.keyboard.type("0")
        page.keyboard.press("Enter")
        expect(values).to_contain_text("410")
