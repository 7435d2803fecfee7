"""The tab of curves in a real browser, against a real session: choosing, drawing, holding, reading, exporting."""

from __future__ import annotations

import asyncio
import csv
import io
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.editor_web.browsing import PHONE, Scheme, Size, opened_page, require_accessible
from tests.editor_web.fake_plant import FakePlant
from tests.editor_web.workshop import SHIFT_ID, Workshop

LAPTOP: Size = (1280, 800)
BRIEF_ID = "behaviors/brief.yaml"
BRIEF = """
flexcell: 1
name: brief
outcomes: [good]
success: [good]
root:
  machine:
    initial: only
    states:
      only: {state: flow.Wait, with: {duration_s: 0.5}, transitions: {done: good}}
"""
# How many pixels of the canvas are of a curve and not of text or grid.
PAINTED = """() => {
    const canvas = document.querySelector('[aria-label*=" curves over "] canvas')
    if (!canvas?.width || !canvas.height) return 0
    const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data
    let painted = 0
    for (let at = 0; at < data.length; at += 4) {
        const spread = Math.max(data[at], data[at + 1], data[at + 2]) - Math.min(data[at], data[at + 1], data[at + 2])
        if (data[at + 3] > 128 && spread > 60) painted += 1
    }
    return painted
}"""


@pytest.fixture
def plant() -> FakePlant:
    """The devices on the bus."""
    return FakePlant()


@pytest.fixture
def shop(tmp_path: Path, loopback: str, plant: FakePlant) -> Generator[Workshop]:
    """A served session with them."""
    with Workshop(host=loopback, project=tmp_path, furnish=plant.furnish) as opened:
        yield opened


@contextmanager
def at_plots(browser: Browser, shop: Workshop, *, size: Size = LAPTOP, scheme: Scheme = "light") -> Generator[Page]:
    """The page of a behavior with its curves in front."""
    path = f"/behaviors/{SHIFT_ID}"
    with opened_page(browser, shop.running, path, size=size, scheme=scheme) as page:
        page.get_by_role("tab", name="Plots").click()
        expect(page.get_by_text("Nothing is selected")).to_be_visible()
        yield page


def choose_joints(page: Page) -> None:
    """Both joints' positions."""
    page.get_by_role("button", name="plant/joint_state").click()
    page.get_by_label("All of position_rad of plant/joint_state").check()


async def sampled(pages: int) -> None:
    """Wait until this many pages are sampled for."""
    while sum(task.get_name() == "data-sample" for task in asyncio.all_tasks()) != pages:  # noqa: ASYNC110 - untold
        await asyncio.sleep(0.02)


def test_chosen_numbers_are_drawn_with_their_values_and_units(
    browser: Browser, shop: Workshop, plant: FakePlant
) -> None:
    """Rows at once or one by one; what is taken away is gone."""
    with at_plots(browser, shop) as page:
        choose_joints(page)
        legend = page.get_by_role("list", name="Curves")
        expect(legend.get_by_role("listitem")).to_have_count(2)
        expect(legend).to_contain_text("position_rad lift")
        expect(legend).to_contain_text("0.5 rad")
        shop.on_loop(lambda: plant.publish(2.0))
        expect(legend).to_contain_text("0.9093 rad")
        page.wait_for_function(f"() => ({PAINTED})() > 100")
        page.get_by_label("Find a number").fill("gripper width")
        page.get_by_label("width_m of plant/gripper/state").check()
        expect(legend).to_contain_text("0.04 m")
        legend.get_by_role("button", name="Take away position_rad turn of plant/joint_state").click()
        expect(legend.get_by_role("listitem")).to_have_count(2)
        page.get_by_label("Find a number").fill("")
        page.get_by_role("button", name="position_rad turn of plant/joint_state").click()
        expect(legend.get_by_role("listitem")).to_have_count(3)


def test_a_held_plot_can_be_read_while_samples_go_on(browser: Browser, shop: Workshop, plant: FakePlant) -> None:
    """Pointing tells the values at that time, by mouse or keys."""
    with at_plots(browser, shop) as page:
        choose_joints(page)
        legend = page.get_by_role("list", name="Curves")
        expect(legend).to_contain_text("0.5 rad")
        page.wait_for_function(f"() => ({PAINTED})() > 3")
        page.get_by_role("button", name="Hold").click()
        expect(page.get_by_text("paused at")).to_be_visible()
        shop.on_loop(lambda: plant.publish(2.0))
        canvas = page.get_by_role("img", name="2 curves over")
        canvas.press("ArrowLeft")
        expect(page.get_by_text("paused at")).to_have_count(0)
        expect(legend).to_contain_text("0.5 rad")
        canvas.press("+")
        expect(canvas).to_have_attribute(
            "aria-label", "2 curves over 24 s; arrows read values, plus and minus zoom, space pauses"
        )
        page.get_by_role("button", name="Go on").click()
        canvas.press("Escape")
        expect(legend).to_contain_text("0.9093 rad")


def test_curves_are_exported_as_csv(browser: Browser, shop: Workshop) -> None:
    """Times on the server's clock, a heading with the unit."""
    with at_plots(browser, shop) as page:
        choose_joints(page)
        page.wait_for_function(f"() => ({PAINTED})() > 10")
        with page.expect_download() as downloading:
            page.get_by_role("button", name="CSV").click()
        rows = list(csv.reader(io.StringIO(Path(downloading.value.path()).read_text(encoding="utf-8"))))
    assert rows[0] == [
        "time_s",
        "plant/joint_state position_rad lift (rad)",
        "plant/joint_state position_rad turn (rad)",
    ]
    assert rows[1][1:] == ["0", "0.5"]
    assert float(rows[1][0]) > 1.7e9


def test_a_tab_that_is_not_shown_gets_nothing(browser: Browser, shop: Workshop) -> None:
    """And goes on where it was when it is shown again."""
    with at_plots(browser, shop) as page:
        choose_joints(page)
        expect(page.get_by_role("list", name="Curves")).to_contain_text("0.5 rad")
        shop.call(sampled(1))
        page.get_by_role("tab", name="Timeline").click()
        shop.call(sampled(0))
        page.get_by_role("tab", name="Plots").click()
        shop.call(sampled(1))


def test_what_was_chosen_is_kept_over_a_reload(browser: Browser, shop: Workshop) -> None:
    """In the browser that chose it."""
    with at_plots(browser, shop) as page:
        choose_joints(page)
        expect(page.get_by_role("list", name="Curves")).to_contain_text("0.5 rad")
        page.reload()
        page.get_by_role("tab", name="Plots").click()
        expect(page.get_by_role("list", name="Curves").get_by_role("listitem")).to_have_count(2)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_curves_are_accessible(browser: Browser, shop: Workshop, scheme: Scheme) -> None:
    """Also the tree of what can be chosen."""
    with at_plots(browser, shop, scheme=scheme) as page:
        choose_joints(page)
        expect(page.get_by_role("list", name="Curves")).to_contain_text("0.5 rad")
        require_accessible(page, "plots", part="section[aria-label=Plots]")


def test_curves_on_a_phone(browser: Browser, shop: Workshop) -> None:
    """The tree can be put away."""
    with at_plots(browser, shop, size=PHONE) as page:
        choose_joints(page)
        page.get_by_role("button", name="Choose").click()
        expect(page.get_by_label("Find a number")).to_have_count(0)
        page.wait_for_function(f"() => ({PAINTED})() > 10")


def with_brief_run(project: Path) -> Path:
    """Write a behavior that ends by itself after a time that can be seen in its timeline."""
    (project / "behaviors").mkdir()
    (project / BRIEF_ID).write_text(BRIEF, encoding="utf-8")
    return project


@contextmanager
def recorded_run(browser: Browser, shop: Workshop, plant: FakePlant) -> Generator[Page]:
    """The page of a run that was recorded, and has ended."""
    run = shop.start(BRIEF_ID)
    shop.on_loop(lambda: plant.publish(2.0))
    shop.call(shop.session.wait(run))
    with opened_page(browser, shop.running, f"/runs/{run}?layout=debug", size=LAPTOP, quiet=False) as page:
        yield page


def test_recorded_curves_below_the_lanes_have_their_axis_and_their_cursor(
    browser: Browser, tmp_path: Path, loopback: str, plant: FakePlant
) -> None:
    """A press at one place means one time in both; what is drawn is saved as CSV and PNG."""
    with (
        # With a 3D view, for a server records its runs for that.
        Workshop(host=loopback, project=with_brief_run(tmp_path), furnish=plant.furnish, cell_view=True) as shop,
        recorded_run(browser, shop, plant) as page,
    ):
        page.get_by_role("tab", name="Timeline").click()
        moment = page.get_by_role("slider", name="Moment of the run")
        page.get_by_role("button", name="Curves", exact=True).click()
        page.get_by_role("button", name="Choose curves").click()
        choose_joints(page)
        page.keyboard.press("Escape")
        curves = page.get_by_role("slider", name="2 recorded curves")
        lanes, below = moment.bounding_box(), curves.bounding_box()
        assert lanes is not None
        assert below is not None
        middle = lanes["x"] + lanes["width"] / 2
        page.mouse.click(middle, lanes["y"] + 5)
        expect(moment).not_to_have_attribute("aria-valuenow", "0")
        at_lanes = float(moment.get_attribute("aria-valuenow") or "nan")
        expect(curves).to_have_attribute("aria-valuetext", f"{at_lanes:.2f} s")
        moment.press("Home")
        expect(curves).to_have_attribute("aria-valuetext", "0.00 s")
        page.mouse.click(middle, below["y"] + below["height"] / 2)
        expect(curves).to_have_attribute("aria-valuetext", f"{at_lanes:.2f} s")
        require_accessible(page, "curves below lanes", part="[aria-label=Timeline]")
        for kind in ("CSV", "PNG"):
            with page.expect_download() as downloading:
                page.get_by_role("toolbar", name="Curves").get_by_role("button", name=kind).click()
            assert downloading.value.suggested_filename == f"recorded-curves.{kind.lower()}"
