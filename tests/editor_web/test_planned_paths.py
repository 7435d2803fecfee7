"""Planned ways in a real browser: what is asked of the operator, what is in the way, and what the 3D view shows."""

from __future__ import annotations

import io
from collections.abc import Generator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, FrameLocator, Locator, Page, expect

from engine.bus import SkillBus
from engine.runtime.run_options import RunOptions
from tests.editor_web.browsing import (
    DESK,
    PHONE,
    Scheme,
    Size,
    opened_page,
    require_accessible,
    require_fit,
    switch,
    until,
)
from tests.editor_web.fake_planner import CONFIRMED, CONFIRMED_ID, FakePlanner, Plan
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.workshop import Workshop
from tests.tiers import nightly

ASKED = RunOptions(autonomy="low", demand_operator=True)
GREEN, VIOLET, TABLE = (22, 163, 74), (68, 1, 84), (228, 224, 223)
_read: Any = import_module("imageio.v3").imread


class Shop(Workshop):
    """A workshop with an arm that plans."""

    def __init__(self, *, host: str, project: Path, cell_view: bool = False) -> None:
        self._planner: FakePlanner | None = None
        super().__init__(
            host=host, project=project, states={Plan.state_name: Plan}, furnish=self._settle, cell_view=cell_view
        )
        (project / CONFIRMED_ID).write_text(CONFIRMED, encoding="utf-8")

    @property
    def planner(self) -> FakePlanner:
        """The arm's; use it with `on_loop`."""
        assert self._planner is not None
        return self._planner

    def _settle(self, bus: SkillBus) -> None:
        self._planner = FakePlanner(bus)


@pytest.fixture
def shop(tmp_path: Path, loopback: str) -> Generator[Shop]:
    """Without a 3D view."""
    with Shop(host=loopback, project=tmp_path) as opened:
        yield opened


def asked(page: Page) -> Locator:
    """What the run asks."""
    return page.get_by_role("region", name="The run asks")


def blocked(page: Page) -> Locator:
    """The arms that wait."""
    return page.get_by_role("list", name="Arms with a blocked path")


@contextmanager
def at_confirmed(browser: Browser, shop: Shop, *, size: Size = DESK, scheme: Scheme = "light") -> Generator[Page]:
    """The page of the behavior that plans."""
    with opened_page(browser, shop.running, f"/behaviors/{CONFIRMED_ID}", size=size, scheme=scheme) as page:
        expect(page.get_by_role("heading", name="confirmed")).to_be_visible()
        yield page


def view_of(page: Page) -> FrameLocator:
    """The 3D view, once something is drawn."""
    view = page.frame_locator("iframe[title='3D view of the cell']")
    expect(view.locator("canvas[data-engine]")).to_be_visible(timeout=GUARD_MS)
    return view


def pixels(page: Page, colour: tuple[int, int, int]) -> int:
    """How many pixels of the 3D view are of about this colour."""
    shot = page.locator("iframe[title='3D view of the cell']").screenshot(timeout=GUARD_MS)
    picture = np.asarray(_read(io.BytesIO(shot)))[..., :3].astype(int)
    return int((np.abs(picture - colour).max(axis=-1) < 30).sum())


def test_what_the_view_shows_is_chosen_by_keyboard_and_kept(browser: Browser, tmp_path: Path, loopback: str) -> None:
    """Seen in the picture itself: voxels until they are hidden, the line of a way until it is over."""
    with (
        Shop(host=loopback, project=tmp_path, cell_view=True) as shop,
        opened_page(browser, shop.running, size=(640, 480)) as page,
    ):
        shop.on_loop(lambda: shop.planner.show("moving"))
        view_of(page)
        until(page, lambda: pixels(page, VIOLET) > 50 and pixels(page, GREEN) > 50)
        page.get_by_role("button", name="Show", exact=True).press("Enter")
        menu = page.get_by_role("dialog", name="Show")
        # It takes the keyboard a moment after it opens.
        expect(menu.locator(":focus")).to_have_count(1)
        switch(menu.get_by_label("Voxels"), on=False)
        page.keyboard.press("Escape")
        expect(menu).to_have_count(0)
        expect(page.get_by_role("button", name="Show", exact=True)).to_be_focused()
        until(page, lambda: pixels(page, VIOLET) == 0)
        shop.on_loop(lambda: shop.planner.show("none"))
        page.reload()
        view_of(page)
        until(page, lambda: pixels(page, TABLE) > 500)
        until(page, lambda: (pixels(page, VIOLET), pixels(page, GREEN)) == (0, 0))


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [DESK, nightly(PHONE)])
def test_questions_blocked_ways_and_the_menu_are_accessible_and_fit(
    browser: Browser, tmp_path: Path, loopback: str, size: Size, scheme: Scheme
) -> None:
    with Shop(host=loopback, project=tmp_path, cell_view=True) as shop:
        shop.start(CONFIRMED_ID, supervision=ASKED)
        with at_confirmed(browser, shop, size=size, scheme=scheme) as page:
            expect(asked(page)).to_contain_text("shown in the 3D view")
            shop.on_loop(lambda: shop.planner.show("blocked", reason="left/fore would touch anna/hand"))
            expect(blocked(page)).to_be_visible()
            if size == PHONE:
                page.get_by_role("tab", name="Cell").click()
            page.get_by_role("button", name="Show", exact=True).click()
            expect(page.get_by_role("dialog", name="Show")).to_be_visible()
            require_fit(page, *size)
            require_accessible(page, f"a planned way, {scheme} {size}")
