"""From a node to the Python source of its state class, in a real browser."""

from __future__ import annotations

import inspect
from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from states.flow.set_value import SetValue
from tests.editor_web.browsing import Scheme
from tests.editor_web.editing import at_editor, card
from tests.editor_web.workshop import SHIFT_ID, Workshop


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_node_leads_to_the_lines_of_its_class(browser: Browser, shop: Workshop, scheme: Scheme) -> None:
    """Its file and line are in the form, can be copied, and the text is opened there to be read only."""
    file = Path(str(inspect.getsourcefile(SetValue)))
    lines, first = inspect.getsourcelines(SetValue)
    place = f"{file}:{first}"
    with at_editor(browser, shop, SHIFT_ID, scheme=scheme) as page:
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        card(page, "root/set").locator("[data-head]").click()
        shown = page.get_by_role("button", name=f"flow/set_value.py:{first}")
        expect(shown).to_be_visible()
        page.get_by_role("button", name="Copy file and line").click()
        expect(page.get_by_role("button", name="Copied")).to_be_visible()
        assert page.evaluate("() => navigator.clipboard.readText()") == place
        page.keyboard.press("Escape")
        card(page, "root/set").locator("[data-head]").click()
        page.keyboard.press("Alt+F12")
        dialog = page.get_by_role("dialog", name="Source of flow.SetValue")
        expect(dialog).to_contain_text(place)
        text = dialog.get_by_role("textbox", name=f"Source in {file}")
        expect(text.locator(".cm-node-line")).to_have_count(len(lines))
        expect(text.locator(".cm-node-line").first).to_have_text(lines[0].rstrip())
        expect(text.locator(".cm-node-line").first).to_be_in_viewport(ratio=1)
        expect(text).to_have_attribute("contenteditable", "false")
        page.keyboard.press("Escape")
        expect(dialog).to_have_count(0)
        shown.click()
        expect(dialog).to_be_visible()
