"""A real browser moves an arm with the mouse, by the handle in the 3D view."""

from __future__ import annotations

from collections.abc import Generator

import pytest
from playwright.sync_api import Browser, Page, expect

from engine.messages import JointState
from tests.editor_web.blue_arrow import tip_of_the_blue_arrow
from tests.editor_web.browsing import opened_page, require_accessible, switch
from tests.editor_web.teach_site import TeachSite

MOVES_RAD_S, RESTS_RAD_S = 0.03, 0.01
PULLS, PATIENCE_S = 4, 15.0


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    with TeachSite(host=loopback, project=tmp_path_factory.mktemp("dragged"), view=True) as opened:
        yield opened


def require_focus_in(page: Page) -> None:
    """The menu takes the keyboard a moment after it opens; a key before that is for something else."""
    expect(page.get_by_role("dialog").locator(":focus")).to_have_count(1)


def fastest(state: JointState) -> float:
    return max(map(abs, state.velocity_rad_s))


def pull_until_it_goes(page: Page, site: TeachSite) -> None:
    """Press and pull at the handle; once more where a picture, late on a busy machine, showed it at another place."""
    for _ in range(PULLS):
        before, tip = None, tip_of_the_blue_arrow(page, "lowest")
        # Until it is drawn, and where it stays.
        while tip is None or tip != before:
            before, tip = tip, tip_of_the_blue_arrow(page, "lowest")
        page.mouse.move(*tip)
        page.mouse.down()
        page.mouse.move(tip[0], tip[1] + 60, steps=6)
        try:
            site.call(site.seen(lambda state: fastest(state) > MOVES_RAD_S), within_s=PATIENCE_S)
        except TimeoutError:
            page.mouse.up()
        else:
            return
    pytest.fail(f"the arm did not go in {PULLS} pulls")


def test_the_arm_goes_while_the_mouse_is_down_on_its_handle_and_rests_when_it_is_up(
    browser: Browser, site: TeachSite
) -> None:
    with opened_page(browser, site.running, "/teach", quiet=False, size=(1000, 640)) as page:
        button = page.get_by_role("button", name="Handle")
        button.press("Enter")
        require_focus_in(page)
        switch(page.get_by_role("radio", name="left"))
        expect(button).to_have_text("Handle: left")
        require_accessible(page, "the menu of the handle", part="[role=dialog]")
        page.keyboard.press("Escape")
        expect(page.get_by_role("dialog")).to_have_count(0)
        pull_until_it_goes(page, site)
        page.mouse.up()
        site.call(site.seen(lambda state: fastest(state) < RESTS_RAD_S))
        button.press("Enter")
        require_focus_in(page)
        switch(page.get_by_role("radio", name="None"))
        expect(button).to_have_text("Handle")
