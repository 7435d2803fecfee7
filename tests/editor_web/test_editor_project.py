"""The editor among the files of a project: all open unchanged; references, entries, changes from elsewhere."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, Route, expect

from tests.editor_web.browsing import fetched
from tests.editor_web.editing import at_editor, card, file_text, idle, save
from tests.editor_web.workshop import NAP_ID, SHIFT_ID, Workshop
from tests.tiers import nightly

BEHAVIORS = Path(__file__).parents[2] / "behaviors"
FILES = sorted(file for file in BEHAVIORS.glob("*/*.yaml") if "\nroot:" in file.read_text(encoding="utf-8"))
OUTER_ID = "behaviors/outer.yaml"
OUTER = """
flexcell: 1
name: outer
outcomes: [good]
success: [good]
root:
  machine:
    initial: nap
    states:
      nap: {behavior: nap.yaml, transitions: {good: good}}
"""


def come_back(page: Page) -> None:
    """Come back to the page from another program."""
    page.evaluate("() => dispatchEvent(new Event('focus'))")


@pytest.mark.parametrize("file", [FILES[0], *map(nightly, FILES[1:])], ids=lambda file: file.stem)
def test_a_behavior_of_the_project_opens_and_saves_without_a_changed_byte(
    browser: Browser, shop: Workshop, file: Path
) -> None:
    """Opened, gone about in, undone, saved."""
    for folder in (file.parent, BEHAVIORS / "cells", BEHAVIORS / "entries"):
        shutil.copytree(folder, shop.project / "behaviors" / folder.name, dirs_exist_ok=True)
    behavior_id = f"behaviors/{file.relative_to(BEHAVIORS).as_posix()}"
    before = file_text(shop, behavior_id)
    with at_editor(browser, shop, behavior_id) as page:
        page.keyboard.press("Control+a")
        page.keyboard.press("Control+d")
        idle(page)
        page.keyboard.press("Control+z")
        expect(page.get_by_role("button", name="Undo")).to_have_attribute("aria-disabled", "true")
        save(page)
        page.keyboard.press("Control+s")
        idle(page)
    assert file_text(shop, behavior_id) == before


def test_a_behavior_that_is_referred_to_is_opened_in_its_own_editor(browser: Browser, shop: Workshop) -> None:
    """By Enter or a double click; the browser leads back."""
    (shop.project / OUTER_ID).write_text(OUTER, encoding="utf-8")
    with at_editor(browser, shop, OUTER_ID) as page:
        expect(card(page, "root/nap")).to_contain_text("nap.yaml")
        card(page, "root/nap").focus()
        page.keyboard.press("Enter")
        expect(page.locator("[data-editor-head] h1")).to_contain_text("nap")
        expect(card(page, "root/only")).to_be_visible()
        page.go_back()
        expect(card(page, "root/nap")).to_be_visible()


def test_a_named_entry_is_chosen_from_those_of_its_kind_and_added_from_the_library(
    browser: Browser, shop: Workshop
) -> None:
    """As the target of a motion."""
    entries: list[dict[str, object]] = [
        {"kind": "pose", "name": "above_tray"},
        {"kind": "joints", "name": "home"},
    ]

    def with_entries(route: Route) -> None:
        answer = fetched(route)
        route.fulfill(response=answer, body=json.dumps({**answer.json(), "entries": entries}))

    with at_editor(browser, shop, NAP_ID) as page:
        page.route("**/api/v1/catalogue", with_entries)
        page.reload()
        expect(card(page, "root/only")).to_be_visible()
        page.get_by_role("button", name="Entries").click()
        page.get_by_role("button", name="Add above_tray").click()
        expect(card(page, "root/above_tray")).to_contain_text("motion.MoveLinear")
        expect(page.get_by_role("combobox", name="target", exact=True)).to_have_value("above_tray")
        card(page, "root/above_tray").focus()
        page.keyboard.press("a")
        page.keyboard.type("motion.movejoints")
        page.keyboard.press("Enter")
        expect(card(page, "root/move_joints")).to_be_focused()
        target = page.get_by_role("combobox", name="target", exact=True)
        target.focus()
        expect(page.get_by_role("listbox", name="Choices for target").get_by_role("option")).to_have_text(["home"])
        target.press("ArrowDown")
        target.press("Enter")
        idle(page)
        save(page)
    text = file_text(shop, NAP_ID)
    assert "entry: above_tray" in text
    assert "entry: home" in text


def test_a_file_that_changes_elsewhere_is_taken_where_nothing_is_unsaved_and_reported_where_something_is(
    browser: Browser, shop: Workshop
) -> None:
    """Without a reload, when one comes back to the page at the latest."""
    file = shop.project / SHIFT_ID
    with at_editor(browser, shop, SHIFT_ID) as page:
        file.write_text(file_text(shop, SHIFT_ID).replace("  rest: ", "  pause: ").replace(": rest,", ": pause,"))
        come_back(page)
        expect(card(page, "root/pause")).to_be_visible()
        expect(page.locator("[data-unsaved]")).to_have_count(0)
        card(page, "root/set").click()
        page.keyboard.press("Delete")
        expect(page.locator("[data-unsaved]")).to_be_visible()
        file.write_text(file_text(shop, SHIFT_ID).replace("name: shift", "name: late"))
        come_back(page)
        expect(page.get_by_role("alert")).to_contain_text("The file has changed on disk")
        expect(card(page, "root/set")).to_have_count(0)
    assert "name: late" in file_text(shop, SHIFT_ID)
