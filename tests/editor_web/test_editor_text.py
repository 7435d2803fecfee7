"""The editor keeps the file: only what was edited changes, undo leads back to every byte, conflicts are shown."""

from __future__ import annotations

import difflib
import shutil
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.editor_web.editing import at_editor, card, drag, file_text, idle, port, save
from tests.editor_web.workshop import SHIFT_ID, Workshop

BEHAVIORS = Path(__file__).parents[2] / "behaviors"
PLATE_ID = "behaviors/plate_transfer/plate_transfer.yaml"


@contextmanager
def at_plate(browser: Browser, shop: Workshop, *, quiet: bool = True) -> Generator[Page]:
    """A real behavior of the project, copied, in the editor."""
    for name in ("plate_transfer/plate_transfer.yaml", "cells/irb4600.yaml", "entries/irb4600.yaml"):
        (shop.project / "behaviors" / name).parent.mkdir(exist_ok=True)
        shutil.copyfile(BEHAVIORS / name, shop.project / "behaviors" / name)
    with at_editor(browser, shop, PLATE_ID, quiet=quiet) as page:
        yield page


def changed_lines(before: str, after: str) -> tuple[list[str], list[str]]:
    """Lines that went, lines that came."""
    lines = [line for line in difflib.ndiff(before.splitlines(), after.splitlines()) if line[0] in "+-"]
    gone = [line[2:].strip() for line in lines if line[0] == "-"]
    return gone, [line[2:].strip() for line in lines if line[0] == "+"]


def fill(page: Page, field: str, value: str) -> None:
    """Write into a field of the form; it counts when it is left."""
    box = page.get_by_role("combobox", name=field, exact=True)
    box.fill(value)
    box.press("Enter")


def test_only_the_edited_lines_of_a_file_change(browser: Browser, shop: Workshop) -> None:
    """A parameter, a new name that is followed, and a target; comments and layout of all else stay."""
    with at_plate(browser, shop) as page:
        before = file_text(shop, PLATE_ID)
        card(page, "root/retreat").click()
        fill(page, "speed", "0.2")
        idle(page)
        page.keyboard.press("Escape")
        card(page, "root/home_again").focus()
        page.keyboard.press("F2")
        page.get_by_label("New name of home_again").fill("go_home")
        page.keyboard.press("Enter")
        expect(card(page, "root/go_home")).to_be_visible()
        # It is out of sight: selected by the keyboard.
        card(page, "root/preplace").focus()
        page.keyboard.press("Enter")
        form = page.get_by_label("Form of preplace")
        form.get_by_label("failed leads to").select_option("home_empty")
        idle(page)
        save(page)
        gone, came = changed_lines(before, file_text(shop, PLATE_ID))
    assert gone == [
        'with: {robot: arm, target: {entry: retreat}, speed: "${speed}"}',
        "transitions: {reached: place, failed: failed}",
        "transitions: {placed: home_again, lost: home_empty, failed: failed}",
        "home_again:",
    ]
    assert came == [
        "with: {robot: arm, target: {entry: retreat}, speed: 0.2}",
        "transitions: {reached: place, failed: home_empty}",
        "transitions: {placed: go_home, lost: home_empty, failed: failed}",
        "go_home:",
    ]


def test_undoing_everything_gives_every_byte_back(browser: Browser, shop: Workshop) -> None:
    """After edits of every kind; redo brings them again."""
    with at_plate(browser, shop) as page:
        before = file_text(shop, PLATE_ID)
        card(page, "root/retreat").click()
        page.keyboard.press("Control+d")
        expect(card(page, "root/retreat_2")).to_be_visible()
        page.keyboard.press("Delete")
        expect(card(page, "root/retreat_2")).to_have_count(0)
        drag(page, card(page, "root/home"), page.locator("[data-canvas]"), at=(300, 30))
        idle(page)
        card(page, "root/pick").click()
        page.keyboard.press("Control+Shift+g")
        expect(card(page, "root/pick")).to_have_count(0)
        page.keyboard.press("Control+a")
        page.keyboard.press("Control+g")
        expect(card(page, "root/group")).to_be_visible()
        save(page)
        edited = file_text(shop, PLATE_ID)
        assert edited != before
        undo = page.get_by_role("button", name="Undo")
        for _ in range(5):
            page.keyboard.press("Control+z")
        expect(undo).to_have_attribute("aria-disabled", "true")
        expect(page.locator("[data-unsaved]")).to_be_visible()
        save(page)
        assert file_text(shop, PLATE_ID) == before
        for _ in range(5):
            page.keyboard.press("Control+Shift+z")
        expect(card(page, "root/group")).to_be_visible()
        save(page)
        assert file_text(shop, PLATE_ID) == edited


def test_typing_in_the_text_changes_the_canvas_and_back(browser: Browser, shop: Workshop) -> None:
    """In place, with the cursor where it was; one history for both."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        before = file_text(shop, SHIFT_ID)
        page.keyboard.press("y")
        text = page.get_by_role("textbox", name="Text of the behavior")
        expect(text).to_contain_text("name: shift")
        card(page, "root/set").click()
        expect(page.locator(".cm-node-line")).to_have_count(1)
        fill(page, "value", "42")
        expect(text).to_contain_text("with: {value: 42}")
        page.get_by_text("initial: first").click()
        page.keyboard.press("End")
        for _ in "first":
            page.keyboard.press("Backspace")
        page.keyboard.type("set")
        expect(card(page, "root/set").get_by_title("The machine begins here")).to_be_visible()
        expect(card(page, "root/first").get_by_title("The machine begins here")).to_have_count(0)
        page.get_by_text("rest: {state: flow.Wait").click()
        expect(card(page, "root/rest").locator("[data-card]")).to_have_attribute("data-selected", "true")
        page.keyboard.press("Control+z")
        page.keyboard.press("Control+z")
        expect(page.get_by_role("button", name="Undo")).to_have_attribute("aria-disabled", "true")
        expect(text).to_contain_text("initial: first")
        save(page)
        assert file_text(shop, SHIFT_ID) == before


def test_a_text_that_cannot_be_read_keeps_the_canvas_and_says_where(browser: Browser, shop: Workshop) -> None:
    """Line and column from the engine, in the gutter and in the list; mended, all is well again."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.keyboard.press("y")
        page.get_by_text("initial: first").click()
        page.keyboard.press("End")
        page.keyboard.type(": oops")
        expect(page.get_by_text("The text cannot be read")).to_be_visible()
        expect(page.locator(".cm-lint-marker-error").first).to_be_visible()
        expect(card(page, "root/first")).to_be_visible()
        expect(page.locator("[data-problem-count]")).to_contain_text("1 error")
        page.locator("[data-problem-count]").click()
        expect(page.get_by_role("list", name="Problems")).to_contain_text("line 1")
        page.get_by_role("textbox", name="Text of the behavior").focus()
        page.keyboard.press("Control+z")
        expect(page.get_by_text("The text cannot be read")).to_have_count(0)
        expect(page.locator(".cm-lint-marker-error")).to_have_count(0)


def test_problems_lead_to_their_node_and_line(browser: Browser, shop: Workshop) -> None:
    """They stand on nodes and ports, in the text, and in the list."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.keyboard.press("y")
        card(page, "root/set").click()
        page.get_by_label("done leads to").select_option("")
        expect(port(page, "root/set", "done").locator("..")).to_have_attribute("data-loose", "true")
        expect(card(page, "root/set").locator("[data-severity='error']")).to_be_visible()
        page.locator("[data-canvas] .react-flow__pane").click(position={"x": 5, "y": 300})
        page.locator("[data-problem-count]").click()
        problems = page.get_by_role("list", name="Problems")
        problems.get_by_role("button").first.click()
        expect(problems).to_contain_text("root/set")
        expect(card(page, "root/set").locator("[data-card]")).to_have_attribute("data-selected", "true")
        expect(page.locator(".cm-activeLine")).to_contain_text("set: {state: flow.SetValue")


@pytest.mark.parametrize("side", ["merged", "theirs", "mine"])
def test_a_file_that_changed_on_disk_is_merged_by_nodes(browser: Browser, shop: Workshop, side: str) -> None:
    """Other fields are merged by themselves; one that both changed is marked at its node, and nothing is written."""
    with at_editor(browser, shop, SHIFT_ID, quiet=False) as page:
        card(page, "root/set").click()
        fill(page, "value", "42")
        expect(page.locator("[data-unsaved]")).to_be_visible()
        theirs = file_text(shop, SHIFT_ID).replace("name: shift", "name: late shift")
        if side != "merged":
            theirs = theirs.replace("value: 1", "value: 7")
        (shop.project / SHIFT_ID).write_text(theirs, encoding="utf-8")
        page.keyboard.press("Escape")
        page.keyboard.press("Control+s")
        if side != "merged":
            panel = page.get_by_role("region", name="Conflicts")
            expect(panel.locator("[data-conflict]")).to_have_count(1)
            expect(card(page, "root/set").locator("[data-conflicts='1']")).to_be_visible()
            assert file_text(shop, SHIFT_ID) == theirs
            panel.get_by_text({"theirs": "Theirs: 7", "mine": "Mine: 42"}[side]).click()
            panel.get_by_role("button", name="Save with these choices").click()
            expect(panel).to_have_count(0)
        expect(page.locator("[data-unsaved]")).to_have_count(0)
        idle(page)
    on_disk = file_text(shop, SHIFT_ID)
    assert "late shift" in on_disk
    assert ("value: 42" in on_disk, "value: 7" in on_disk) == (side != "theirs", side == "theirs")


def test_a_draft_outlives_the_page(browser: Browser, shop: Workshop) -> None:
    """Unsaved changes are there again after a reload, and can be thrown away."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.on("dialog", lambda dialog: dialog.accept())
        card(page, "root/set").click()
        fill(page, "value", "42")
        expect(page.locator("[data-unsaved]")).to_be_visible()
        page.reload()
        expect(page.get_by_text("Your unsaved changes of an earlier visit are here.")).to_be_visible()
        card(page, "root/set").click()
        expect(page.get_by_role("combobox", name="value", exact=True)).to_have_value("42")
        page.get_by_role("button", name="Discard them").click()
        expect(page.get_by_role("combobox", name="value", exact=True)).to_have_value("1")
        expect(page.locator("[data-unsaved]")).to_have_count(0)
        assert "value: 42" not in file_text(shop, SHIFT_ID)
