"""The editor of the cell in a real browser: a box by mouse and keyboard, its numbers, undo, the text, a conflict."""

from __future__ import annotations

import re
from collections.abc import Generator
from contextlib import suppress
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from editor_web.server import Dashboard
from tests.editor_web.blue_arrow import tip_of_the_blue_arrow
from tests.editor_web.browsing import SCHEMES, Scheme, opened_page, require_accessible
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.real_server import dashboard_of
from tests.engine.cli.process import started
from tests.engine.editing.cells.cell_texts import CELL, write_cell

PULLS = 4
UP_MS = 6 * GUARD_MS


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Generator[tuple[Dashboard, Path]]:
    """A served cell without robots, and its file."""
    folder = tmp_path_factory.mktemp("cell_editing")
    file = write_cell(folder)
    with started("serve", "--cell", str(file.relative_to(folder)), "--port", "0", cwd=folder) as server:
        yield dashboard_of(server, folder / ".flexcell"), file


@pytest.fixture(autouse=True)
def as_it_was(served: tuple[Dashboard, Path]) -> None:
    """Each test begins with the document as the cell was opened with it."""
    served[1].write_text(CELL)


def begin(page: Page) -> None:
    page.get_by_role("button", name="Edit the cell").click()
    expect(page.get_by_role("toolbar", name="Edit the cell")).to_be_visible()


def text_of(page: Page) -> str:
    """The text of the document as it is shown."""
    return "\n".join(page.get_by_role("textbox", name="Text of the cell").locator(".cm-line").all_inner_texts())


def test_a_box_is_added_by_mouse_and_placed_by_keyboard(browser: Browser, served: tuple[Dashboard, Path]) -> None:
    running, file = served
    with opened_page(browser, running, "/workcell") as page:
        begin(page)
        page.get_by_role("button", name="Add", exact=True).click()
        page.get_by_role("menuitem", name="Box").click()
        form = page.get_by_role("form", name="Change box_1")
        expect(form).to_be_visible()
        expect(page.get_by_role("treeitem", name=re.compile("box_1"))).to_be_visible()
        form.get_by_label("Stands in").select_option("table")
        form.get_by_label("Size x").fill("0.40")
        form.get_by_label("Position z").fill("0.4")
        form.get_by_label("Roll, pitch, yaw y").fill("90")
        page.keyboard.press("Enter")
        written = (
            "box_1: {shape: box, size_m: [0.4, 0.1, 0.1], at: {xyz: [0, 0, 0.4], frame: table, rpy: [0, 0, 1.570796]}}"
        )
        expect(page.get_by_role("textbox", name="Text of the cell")).to_contain_text(written)
        assert file.read_text() == CELL

        # By keyboard: the button has the focus, a field would undo its own letters.
        page.get_by_role("button", name="Undo").focus()
        page.keyboard.press("Control+z")
        expect(form.get_by_label("Size x")).to_have_value("0.1")
        page.keyboard.press("Control+z")
        expect(page.get_by_role("treeitem", name=re.compile("box_1"))).to_have_count(0)
        page.keyboard.press("Control+Shift+z")
        page.get_by_role("button", name="Redo").click()
        expect(page.get_by_role("textbox", name="Text of the cell")).to_contain_text(written)

        page.keyboard.press("Control+s")
        expect(page.locator("[data-unsaved]")).to_have_count(0)
        assert file.read_text() == CELL.replace("\n\nframes:", f"\n  {written}\n\nframes:")
        expect(page.get_by_text("as the document was when the cell was opened")).to_be_visible()
        expect(page.get_by_role("button", name="Connect the cell anew")).to_be_enabled()


def test_an_item_is_renamed_with_what_stands_in_it_and_not_deleted(
    browser: Browser, served: tuple[Dashboard, Path]
) -> None:
    with opened_page(browser, served[0], "/workcell/fixtures/table") as page:
        begin(page)
        page.get_by_role("button", name="Delete").click()
        expect(page.get_by_role("alert")).to_contain_text("it is named by `dock`, `slot`")
        page.get_by_label("Name").fill("bench_top")
        page.get_by_role("button", name="Apply").click()
        expect(page.get_by_role("form", name="Change bench_top")).to_be_visible()
        expect(page).to_have_url(re.compile("/workcell/fixtures/bench_top$"))
        expect(page.get_by_role("alert")).to_have_count(0)
        text = text_of(page)
        assert "slot: {parent: bench_top" in text
        assert "# the table of 2019" in text


def test_the_text_and_the_tree_follow_one_another(browser: Browser, served: tuple[Dashboard, Path]) -> None:
    with opened_page(browser, served[0], "/workcell") as page:
        begin(page)
        page.get_by_text("mass_kg").click()
        expect(page.get_by_role("form", name="Change plate")).to_be_visible()
        page.keyboard.press("End")
        page.keyboard.type("5")
        expect(page.get_by_label("Mass mass")).to_have_value("0.55")
        page.keyboard.type("x")
        expect(page.get_by_role("treeitem", name=re.compile("plate.*has an error"))).to_be_visible()
        expect(page.get_by_role("form", name="Change plate").get_by_role("alert")).to_contain_text("mass_kg")
        page.keyboard.press("Control+z")
        expect(page.get_by_role("alert")).to_have_count(0)
        expect(page.locator("[data-unsaved]")).to_have_count(0)


def test_a_change_on_disk_is_for_a_person_to_decide(browser: Browser, served: tuple[Dashboard, Path]) -> None:
    running, file = served
    with opened_page(browser, running, "/workcell/parts/plate", quiet=False) as page:
        begin(page)
        page.get_by_label("Mass mass").fill("0.6")
        page.get_by_role("button", name="Apply").click()
        expect(page.locator("[data-unsaved]")).to_be_visible()
        file.write_text(CELL.replace("mass_kg: 0.5", "mass_kg: 0.7"))
        page.get_by_role("button", name="Save").click()
        conflict = page.get_by_role("alert").filter(has_text="The file has changed on disk")
        expect(conflict).to_contain_text("+     mass_kg: 0.7")
        require_accessible(page, "a conflict of the cell")
        conflict.get_by_role("button", name="Overwrite with yours").click()
        expect(conflict).to_have_count(0)
        # The conflict goes first; the text is written when nothing is unsaved any more.
        expect(page.locator("[data-unsaved]")).to_have_count(0)
        assert file.read_text() == CELL.replace("mass_kg: 0.5", "mass_kg: 0.6")


def test_the_cell_is_connected_anew_with_what_was_saved(browser: Browser, tmp_path: Path) -> None:
    """In a server of its own: the editor stays open, and the open cell is that of the document then."""
    file = write_cell(tmp_path)
    with (
        started("serve", "--cell", str(file.relative_to(tmp_path)), "--port", "0", cwd=tmp_path) as server,
        opened_page(browser, dashboard_of(server, tmp_path / ".flexcell"), "/workcell", quiet=False) as page,
    ):
        begin(page)
        page.get_by_role("button", name="Add", exact=True).click()
        page.get_by_role("menuitem", name="Frame").click()
        expect(page.get_by_role("form", name="Change frame_1")).to_be_visible()
        expect(page.get_by_role("button", name="Connect the cell anew")).to_have_attribute("aria-disabled", "true")
        page.keyboard.press("Control+s")
        anew = page.get_by_role("button", name="Connect the cell anew")
        expect(anew).to_be_enabled()
        anew.click()
        expect(page.get_by_text("as the document was when the cell was opened")).to_have_count(0, timeout=UP_MS)
        expect(page.get_by_role("form", name="Change frame_1")).to_be_visible()
        page.get_by_role("button", name="Close the editor").click()
        expect(page.get_by_role("region", name="Details of frame_1")).to_contain_text("Position")


def test_a_box_is_dragged_in_the_3d_view_by_whole_steps(browser: Browser, served: tuple[Dashboard, Path]) -> None:
    """Only the numbers of the form change; the document does when they are applied."""
    with opened_page(browser, served[0], "/workcell", quiet=False) as page:
        begin(page)
        page.get_by_role("button", name="Add", exact=True).click()
        page.get_by_role("menuitem", name="Box").click()
        page.get_by_label("Position z").fill("1.0")
        page.get_by_label("Drag in the 3D view").select_option("usual")
        height = page.get_by_label("Position z")
        for _ in range(PULLS):
            before, tip = None, tip_of_the_blue_arrow(page, "highest")
            # Until it is drawn, and where it stays.
            while tip is None or tip != before:
                before, tip = tip, tip_of_the_blue_arrow(page, "highest")
            page.mouse.move(*tip)
            page.mouse.down()
            page.mouse.move(tip[0], tip[1] - 50, steps=6)
            page.mouse.up()
            with suppress(AssertionError):
                expect(height).not_to_have_value(re.compile(r"^1(\.0)?$"), timeout=GUARD_MS / 4)
                break
        moved_m = float(height.input_value())
        assert moved_m > 1.0
        assert moved_m == pytest.approx(round(moved_m, 2))
        assert "xyz: [0, 0, 0.05]" in text_of(page)
        page.get_by_role("button", name="Apply").click()
        expect(page.get_by_role("textbox", name="Text of the cell")).to_contain_text(f"xyz: [0, 0, {moved_m:g}]")


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_editor_is_accessible(browser: Browser, served: tuple[Dashboard, Path], scheme: Scheme) -> None:
    with opened_page(browser, served[0], "/workcell/parts/plate", scheme=scheme) as page:
        begin(page)
        page.get_by_label("Mass mass").fill("0.6")
        page.get_by_role("button", name="Apply").click()
        expect(page.locator("[data-unsaved]")).to_be_visible()
        require_accessible(page, f"the editor of the cell, {scheme}")


def test_a_viewer_has_no_editor(browser: Browser, served: tuple[Dashboard, Path]) -> None:
    running = served[0]
    with opened_page(browser, running, "/workcell", login=running.new_login_url("viewer")) as page:
        expect(page.get_by_role("tree", name="Items of the cell")).to_be_visible()
        expect(page.get_by_role("button", name="Edit the cell")).to_have_count(0)
