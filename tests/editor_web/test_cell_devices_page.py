"""Devices, equipment and bonds of a cell in a real browser: in the tree, in their forms, added, renamed, deleted."""

from __future__ import annotations

import re
from collections.abc import Generator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from editor_web.server import Dashboard
from engine.document.cell import load_cell
from engine.document.cell_devices import SlideAxis
from tests.editor_web.browsing import SCHEMES, Scheme, opened_page, require_accessible
from tests.editor_web.real_server import dashboard_of
from tests.engine.cli.process import started
from tests.engine.editing.cells.device_texts import CELL, write_device_cell


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Generator[tuple[Dashboard, Path]]:
    """A served cell with a clamp on pins, and its file."""
    folder = tmp_path_factory.mktemp("cell_devices")
    file = write_device_cell(folder)
    with started("serve", "--cell", file.name, "--port", "0", cwd=folder) as server:
        yield dashboard_of(server, folder / ".flexcell"), file


@pytest.fixture(autouse=True)
def as_it_was(served: tuple[Dashboard, Path]) -> None:
    """Each test begins with the document as the cell was opened with it."""
    served[1].write_text(CELL)


def begin(page: Page) -> None:
    page.get_by_role("button", name="Edit the cell").click()
    expect(page.get_by_role("toolbar", name="Edit the cell")).to_be_visible()


def apply(page: Page) -> None:
    page.get_by_role("button", name="Apply").click()
    expect(page.get_by_role("button", name="Apply")).to_be_disabled()


def test_the_axis_of_a_device_is_changed_and_what_it_has_is_renamed(
    browser: Browser, served: tuple[Dashboard, Path]
) -> None:
    running, file = served
    with opened_page(browser, running, "/workcell/devices/clamp") as page:
        begin(page)
        expect(page.get_by_role("treeitem", name=re.compile("clamp.*closed"))).to_be_visible()
        axis = page.get_by_role("group", name="Axis main")
        axis.get_by_label("Force at rest F").fill("55")
        axis.get_by_label("Name of Axis main").fill("jaw")
        apply(page)
        expect(page.get_by_role("group", name="Axis jaw")).to_be_visible()
        page.get_by_label("Name", exact=True).fill("holder")
        apply(page)
        expect(page.get_by_role("treeitem", name=re.compile("holder"))).to_be_visible()
        page.keyboard.press("Control+s")
        expect(page.locator("[data-unsaved]")).to_have_count(0)
    (axis_spec,) = load_cell(file).document.devices["holder"].axes.items()
    assert (axis_spec[0], isinstance(axis_spec[1], SlideAxis) and axis_spec[1].force_n) == ("jaw", 55)
    assert "# one only" in file.read_text()


def test_a_device_and_a_bond_are_added_and_a_fixture_that_they_name_stays(
    browser: Browser, served: tuple[Dashboard, Path]
) -> None:
    running, file = served
    with opened_page(browser, running, "/workcell") as page:
        begin(page)
        page.get_by_role("button", name="Add", exact=True).click()
        page.get_by_role("menuitem", name="Device", exact=True).click()
        expect(page.get_by_role("form", name="Change device_1")).to_be_visible()
        page.get_by_role("button", name="Axis, sensor, position").click()
        page.get_by_role("menuitem", name="Axis that slides").click()
        page.get_by_role("group", name="Axis axis_1").get_by_label("Moves").select_option("stop")
        apply(page)
        page.get_by_role("button", name="Add", exact=True).click()
        page.get_by_role("menuitem", name="Bond", exact=True).click()
        form = page.get_by_role("form", name="Change bond_1")
        form.get_by_label("Joined to").select_option("jaw")
        form.get_by_label("Breaks at (N)").fill("12.5")
        apply(page)
        page.get_by_role("treeitem", name=re.compile("^stop")).click()
        page.get_by_role("button", name="Delete: stop").click()
        expect(page.get_by_role("alert")).to_contain_text("named by `clamp`, `device_1`, `glue`")
        page.keyboard.press("Control+s")
        expect(page.locator("[data-unsaved]")).to_have_count(0)
    document = load_cell(file).document
    assert document.devices["device_1"].axes["axis_1"].body == "stop"
    assert (document.bonds["bond_1"].to, document.bonds["bond_1"].force_n) == ("jaw", 12.5)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_form_of_a_device_is_accessible(browser: Browser, served: tuple[Dashboard, Path], scheme: Scheme) -> None:
    with opened_page(browser, served[0], "/workcell/devices/clamp", scheme=scheme) as page:
        begin(page)
        page.get_by_role("group", name="Axis main").get_by_label("Force at rest F").fill("0")
        expect(page.get_by_text("Force at rest is above 0")).to_be_visible()
        require_accessible(page, f"the form of a device, {scheme}")
