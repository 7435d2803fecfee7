"""The editor for everybody: axe in both themes, small screens, fingers, viewers, and what it weighs."""

from __future__ import annotations

import gzip
import json
import re

import pytest
from playwright.sync_api import Browser, expect

import hatch_build
from editor_web.security.authentication import VIEWER
from tests.editor_web.browsing import PHONE, Scheme, require_accessible, require_fit
from tests.editor_web.editing import at_editor, card, file_text, idle
from tests.editor_web.workshop import SHIFT_ID, Workshop
from tests.tiers import nightly

EDITOR_LIMIT_BYTES = 250_000


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing_in_any_part_of_the_editor(browser: Browser, shop: Workshop, scheme: Scheme) -> None:
    """Canvas, form, problems, document, text, palette, keys."""
    with at_editor(browser, shop, SHIFT_ID, scheme=scheme) as page:
        card(page, "root/first").click()
        page.get_by_label("a leads to").select_option("")
        page.get_by_role("button", name="Guard, timeout, retry").click()
        page.get_by_role("button", name="What is flow.Wait").click()
        page.keyboard.press("y")
        expect(page.get_by_role("textbox", name="Text of the behavior")).to_be_visible()
        idle(page)
        require_accessible(page, "a state chosen, its outcome loose, the text shown")
        card(page, "root/both").locator("[data-head]").click()
        require_accessible(page, "a container chosen", part="[data-inspector]")
        page.locator("[data-problem-count]").click()
        require_accessible(page, "problems", part="[data-inspector]")
        page.get_by_role("tab", name="Behavior").click()
        require_accessible(page, "document", part="[data-inspector]")
        page.keyboard.press("Control+k")
        expect(page.get_by_role("dialog").get_by_role("option").first).to_be_visible()
        require_accessible(page, "palette", part="dialog")
        page.keyboard.press("Escape")
        page.get_by_role("button", name="Keys").click()
        require_accessible(page, "keys", part="dialog")


@pytest.mark.parametrize(("width", "height"), [nightly(1280, 800), (1920, 1080), PHONE])
def test_it_fits_the_screen(browser: Browser, shop: Workshop, width: int, height: int) -> None:
    """Nothing to scroll sideways; save and run in view."""
    with at_editor(browser, shop, SHIFT_ID, size=(width, height)) as page:
        for name in ("Save", "Run"):
            expect(page.get_by_role("button", name=name, exact=True)).to_be_in_viewport()
        expect(card(page, "root/first")).to_be_in_viewport()
        require_fit(page, width, height)


def test_a_behavior_is_edited_by_touch(browser: Browser, shop: Workshop) -> None:
    """Tap a node, tap its tools, tap what to add."""
    with at_editor(browser, shop, SHIFT_ID) as first:
        state = first.context.storage_state()
    context = browser.new_context(
        locale="en-US", viewport={"width": 1024, "height": 768}, has_touch=True, storage_state=state
    )
    page = context.new_page()
    page.goto(f"{shop.running.url}edit/{SHIFT_ID}")
    expect(card(page, "root/set")).to_be_visible()
    idle(page)
    card(page, "root/set").tap()
    page.get_by_role("toolbar").get_by_role("button", name="Add a state").tap()
    page.get_by_role("option", name="flow.Log").tap()
    expect(card(page, "root/log")).to_be_visible()
    page.get_by_role("button", name="Save", exact=True).tap()
    expect(page.locator("[data-unsaved]")).to_have_count(0)
    assert "flow.Log" in file_text(shop, SHIFT_ID)
    context.close()


def test_who_may_look_only_cannot_save(browser: Browser, shop: Workshop) -> None:
    """It says why, and the file stays."""
    login = shop.running.new_login_url(VIEWER)
    with at_editor(browser, shop, SHIFT_ID, login=login) as page:
        expect(page.get_by_role("button", name="Save", exact=True)).to_have_attribute("aria-disabled", "true")
        expect(card(page, "root/first")).to_be_visible()


def test_names_of_nodes_and_arrows_are_spoken(browser: Browser, shop: Workshop) -> None:
    """What they are, what they run, where they lead."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        expect(card(page, "root/first")).to_have_accessible_name(
            "State first, runs test.Give; a to set, b to bad, c to bad"
        )
        expect(page.locator(".react-flow__edge[data-id='root|set|done']")).to_have_accessible_name(
            re.compile("done of set leads to both")
        )


def test_the_editor_loads_on_demand_and_is_light() -> None:
    """Its scripts are not of the first page; the text pane comes later still."""
    manifest = json.loads((hatch_build.STATIC / ".vite" / "manifest.json").read_text(encoding="utf-8"))

    def closure(name: str) -> set[str]:
        found: set[str] = set()
        due = [name]
        while due:
            each = due.pop()
            if each not in found:
                found.add(each)
                due += manifest[each].get("imports", [])
        return found

    first = closure("index.html")
    editor = closure("src/features/editor/EditorPage.tsx")
    text = closure("src/features/editor/YamlPane.tsx")
    assert "src/features/editor/EditorPage.tsx" not in first
    assert "src/features/editor/YamlPane.tsx" not in first | editor

    def weight(names: set[str]) -> int:
        return sum(len(gzip.compress((hatch_build.STATIC / manifest[name]["file"]).read_bytes())) for name in names)

    assert weight(first) <= EDITOR_LIMIT_BYTES
    assert weight(editor - first) <= EDITOR_LIMIT_BYTES
    assert weight(text - editor - first) <= EDITOR_LIMIT_BYTES
