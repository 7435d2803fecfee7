"""The file of a behavior in the page: its versions side by side, another name, a copy, deleting and bringing back."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Browser, Page, expect

from editor_web.security.authentication import VIEWER
from tests.editor_web.browsing import Scheme, require_accessible
from tests.editor_web.editing import at_editor, card, file_text, idle, save
from tests.editor_web.test_editor_project import OUTER, OUTER_ID
from tests.editor_web.workshop import NAP, NAP_ID, SHIFT, SHIFT_ID, Workshop


def choose_in_menu(page: Page, words: str) -> None:
    """Choose something in the menu of the file."""
    page.get_by_role("button", name="File", exact=True).click()
    page.get_by_role("menuitem", name=words).click()


def rename_state(page: Page, path: str, name: str) -> None:
    """Give a state another name by the keyboard."""
    # The tools of a selected node may lie over its neighbour.
    page.keyboard.press("Escape")
    card(page, path).click()
    page.keyboard.press("F2")
    page.keyboard.type(name)
    page.keyboard.press("Enter")
    idle(page)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_two_versions_are_compared_in_words_on_both_drawings_and_in_the_text(
    browser: Browser, shop: Workshop, scheme: Scheme
) -> None:
    with at_editor(browser, shop, SHIFT_ID, scheme=scheme) as page:
        card(page, "root/set").click()
        page.keyboard.press("Control+d")
        idle(page)
        rename_state(page, "root/rest", "sleep")
        save(page)
        page.keyboard.press("h")
        dialog = page.get_by_role("dialog", name="Versions")
        listed = dialog.get_by_label("Versions, newest first").get_by_role("button")
        expect(listed.first).to_contain_text("saved here · on disk now")
        changes = dialog.get_by_label("What differs")
        expect(changes).to_contain_text("set_2 added")
        expect(changes).to_contain_text("rest renamed to sleep")
        older, newer = (dialog.get_by_label(re.compile("Drawing of the version")).nth(index) for index in (0, 1))
        # What led to the renamed state leads elsewhere.
        expect(older.locator("title", has_text="changed")).to_have_count(2)
        expect(newer.locator("title", has_text="added")).to_have_count(1)
        expect(newer).to_contain_text("sleep")
        require_accessible(page, f"versions, {scheme}", part="dialog[open]")
        dialog.get_by_role("tab", name="Text").click()
        expect(dialog.locator("[data-changed]").first).to_be_visible()
        dialog.get_by_role("tab", name="This version").click()
        expect(dialog.get_by_label(re.compile("Drawing of the version"))).to_contain_text("sleep")


def test_an_older_version_is_restored_as_an_edit_that_can_be_undone(browser: Browser, shop: Workshop) -> None:
    with at_editor(browser, shop, SHIFT_ID) as page:
        rename_state(page, "root/rest", "sleep")
        save(page)
        changed = file_text(shop, SHIFT_ID)
        choose_in_menu(page, "Versions…")
        dialog = page.get_by_role("dialog", name="Versions")
        dialog.get_by_label("Versions, newest first").get_by_role("button").last.click()
        expect(dialog.get_by_label(re.compile("Drawing of the version"))).to_be_visible()
        dialog.get_by_role("button", name="Restore this version").click()
        expect(card(page, "root/rest")).to_be_visible()
        assert file_text(shop, SHIFT_ID) == changed
        page.keyboard.press("Control+z")
        expect(card(page, "root/sleep")).to_be_visible()
        page.keyboard.press("Control+Shift+z")
        expect(card(page, "root/rest")).to_be_visible()
        save(page)
    assert file_text(shop, SHIFT_ID) == SHIFT


def test_a_behavior_is_renamed_and_those_that_refer_to_it_follow(browser: Browser, shop: Workshop) -> None:
    (shop.project / OUTER_ID).write_text(OUTER, encoding="utf-8")
    # That a name is taken, the browser's console says too.
    with at_editor(browser, shop, NAP_ID, quiet=False) as page:
        choose_in_menu(page, "Rename or move…")
        dialog = page.get_by_role("dialog", name="Rename or move")
        expect(dialog).to_contain_text(OUTER_ID)
        require_accessible(page, "rename", part="dialog[open]")
        name = dialog.get_by_label("Name of the file")
        name.fill("../nap")
        expect(dialog.get_by_role("alert")).to_contain_text("begins with a letter")
        name.fill("shift")
        dialog.get_by_role("button", name="Rename").click()
        expect(dialog.get_by_role("alert")).to_contain_text("there is a document with this id")
        name.fill("snooze")
        dialog.get_by_label("Folder, if any").fill("rests")
        dialog.get_by_role("button", name="Rename").click()
        expect(page.locator("[data-editor-head]")).to_contain_text("behaviors/rests/snooze.yaml")
        expect(card(page, "root/only")).to_be_visible()
    assert file_text(shop, "behaviors/rests/snooze.yaml") == NAP
    assert file_text(shop, OUTER_ID) == OUTER.replace("nap.yaml", "rests/snooze.yaml")
    assert not (shop.project / NAP_ID).exists()


def test_a_copy_is_made_of_what_is_shown_also_where_it_was_not_saved(browser: Browser, shop: Workshop) -> None:
    with at_editor(browser, shop, NAP_ID) as page:
        rename_state(page, "root/only", "alone")
        choose_in_menu(page, "Duplicate…")
        expect(page.get_by_role("dialog")).to_contain_text("behaviors/nap_copy.yaml")
        page.keyboard.press("Enter")
        expect(page.locator("[data-editor-head]")).to_contain_text("behaviors/nap_copy.yaml")
        expect(card(page, "root/alone")).to_be_visible()
    assert file_text(shop, "behaviors/nap_copy.yaml") == file_text(shop, NAP_ID) == NAP.replace("only", "alone")


def test_a_deleted_behavior_tells_who_needs_it_and_comes_back(browser: Browser, shop: Workshop) -> None:
    (shop.project / OUTER_ID).write_text(OUTER, encoding="utf-8")
    with at_editor(browser, shop, NAP_ID) as page:
        choose_in_menu(page, "Delete…")
        dialog = page.get_by_role("dialog", name="Delete")
        expect(dialog).to_contain_text(OUTER_ID)
        dialog.get_by_role("button", name="Delete nap").click()
        expect(page.locator("[data-editor-head]")).to_have_count(0)
        assert not (shop.project / NAP_ID).exists()
        page.get_by_role("button", name="New").click()
        page.get_by_text("Deleted behaviors").click()
        page.get_by_role("button", name="Restore").click()
        expect(page.locator("[data-editor-head]")).to_contain_text(NAP_ID)
        expect(card(page, "root/only")).to_be_visible()
    assert file_text(shop, NAP_ID) == NAP


def test_a_viewer_compares_versions_and_changes_no_file(browser: Browser, shop: Workshop) -> None:
    text = SHIFT.replace("rest: {", "sleep: {").replace("finished: rest", "finished: sleep")
    with at_editor(browser, shop, SHIFT_ID):
        pass
    (shop.project / SHIFT_ID).write_text(text, encoding="utf-8")
    login = shop.running.new_login_url(VIEWER)
    with at_editor(browser, shop, SHIFT_ID, login=login) as page:
        page.keyboard.press("h")
        dialog = page.get_by_role("dialog", name="Versions")
        expect(dialog.get_by_label("What differs")).to_contain_text("sleep")
        expect(dialog.get_by_role("button", name="Restore this version")).to_have_count(0)
        page.keyboard.press("Escape")
        page.get_by_role("button", name="File", exact=True).click()
        expect(page.get_by_role("menuitem", name="Delete…")).to_be_disabled()
