"""What touches at rest in a draft, and distances between items, in a real browser."""

from __future__ import annotations

import re
from collections.abc import Generator

import pytest
from playwright.sync_api import Browser, Page, expect

from editor_web.server import Dashboard
from tests.editor_web.browsing import SCHEMES, Scheme, opened_page, require_accessible
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.real_server import dashboard_of
from tests.engine.cli.process import started

# The first look loads the models of arms, on a busy computer.
FIRST_MS = 6 * GUARD_MS
CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
fixtures:
  table: {shape: box, size_m: [0.6, 0.6, 0.1], at: {xyz: [0.6, 0, 0.05]}}
  post: {shape: box, size_m: [0.1, 0.1, 0.6], at: {xyz: [0, 0.6, 0.3]}}
parts:
  block: {shape: box, size_m: [0.1, 0.1, 0.1], mass_kg: 0.2, at: {xyz: [0.6, 0, 0.15]}}
"""


@pytest.fixture(scope="module")
def served(tmp_path_factory: pytest.TempPathFactory) -> Generator[Dashboard]:
    """A served cell of a table, a post and a part."""
    folder = tmp_path_factory.mktemp("cell_rest")
    (folder / "cell.yaml").write_text(CELL)
    with started("serve", "--cell", "cell.yaml", "--port", "0", cwd=folder) as server:
        yield dashboard_of(server, folder / ".flexcell")


def sink(page: Page) -> None:
    """Lower the block into the table, in the draft."""
    page.get_by_role("button", name="Edit the cell").click()
    page.get_by_label("Position z").fill("0.13")
    page.get_by_role("button", name="Apply").click()


def test_a_part_that_is_put_into_the_table_is_marked_until_it_is_lifted(browser: Browser, served: Dashboard) -> None:
    with opened_page(browser, served, "/workcell/parts/block") as page:
        sink(page)
        form = page.get_by_role("form", name="Change block")
        expect(form.get_by_text("`table` and `block` overlap by 20.0 mm")).to_be_visible(timeout=FIRST_MS)
        for name in ("table", "block"):
            expect(page.get_by_role("treeitem", name=re.compile(f"^{name}.*touches something"))).to_be_visible()
        expect(page.get_by_role("button", name="Save")).to_be_enabled()
        page.get_by_role("button", name="Undo").click()
        expect(page.get_by_text("touches something")).to_have_count(0, timeout=FIRST_MS)


def test_the_distance_between_two_items_follows_the_draft(browser: Browser, served: Dashboard) -> None:
    with opened_page(browser, served, "/workcell/fixtures/post") as page:
        page.get_by_role("button", name="Edit the cell").click()
        page.get_by_role("button", name="Measure from here").click()
        page.get_by_role("treeitem", name=re.compile("^table")).click()
        table = page.get_by_role("table", name="Distance and angle")
        expect(table).to_contain_text("0.600, -0.600, -0.250 m")
        page.get_by_label("Position y").fill("0.6")
        page.get_by_role("button", name="Apply").click()
        expect(table).to_contain_text("0.6500 m")
        page.get_by_role("button", name="End measuring").click()
        expect(table).to_have_count(0)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_marks_and_measures_are_accessible(browser: Browser, served: Dashboard, scheme: Scheme) -> None:
    with opened_page(browser, served, "/workcell/parts/block", scheme=scheme) as page:
        sink(page)
        expect(page.get_by_text("touches something").first).to_be_visible(timeout=FIRST_MS)
        page.get_by_role("button", name="Measure from here").click()
        page.get_by_role("treeitem", name=re.compile("^post")).click()
        expect(page.get_by_role("table", name="Distance and angle")).to_be_visible()
        require_accessible(page, f"what touches at rest, {scheme}")
