"""Working the editor in a real browser: opening it, finding nodes and ports, saving and reading the file."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, Locator, Page, expect

from tests.editor_web.browsing import Scheme, Size, opened_page
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.workshop import Workshop

LAPTOP: Size = (1280, 800)


@contextmanager
def at_editor(
    browser: Browser,
    shop: Workshop,
    behavior_id: str,
    *,
    size: Size = LAPTOP,
    scheme: Scheme = "light",
    quiet: bool = True,
    login: str = "",
) -> Generator[Page]:
    """The editor of a behavior, drawn."""
    with opened_page(
        browser, shop.running, f"/edit/{behavior_id}", size=size, scheme=scheme, quiet=quiet, login=login
    ) as page:
        # The first look at a project reads and checks all of its behaviors.
        expect(page.locator(".react-flow[data-in-place] .react-flow__node").first).to_be_visible(timeout=GUARD_MS)
        idle(page)
        yield page


def card(page: Page, path: str) -> Locator:
    """A node on the canvas."""
    return page.locator(f".react-flow__node[data-id='{path}']")


def port(page: Page, path: str, outcome: str) -> Locator:
    """The port of an outcome."""
    return card(page, path).locator(f".react-flow__handle[data-handleid='{outcome}']")


def pill(page: Page, path: str, outcome: str) -> Locator:
    """An outcome of a machine, as a place that arrows lead to."""
    return page.locator(f".react-flow__node[data-id='{path}#{outcome}']")


def drag(page: Page, source: Locator, target: Locator, *, at: tuple[float, float] | None = None) -> None:
    """Drag with the mouse, in steps as a hand does, once all rests; to the middle of the target, or a place in it."""
    expect(source).to_be_visible()
    expect(target).to_be_visible()
    idle(page)
    start, end = source.bounding_box(), target.bounding_box()
    assert start is not None
    assert end is not None
    to_x, to_y = at if at is not None else (end["width"] / 2, end["height"] / 2)
    page.mouse.move(start["x"] + start["width"] / 2, start["y"] + start["height"] / 2)
    page.mouse.down()
    page.mouse.move(end["x"] + to_x, end["y"] + to_y, steps=12)
    page.mouse.up()


def save(page: Page) -> None:
    """Save by the keyboard, after every edit is done, and see it done."""
    idle(page)
    page.keyboard.press("Control+s")
    expect(page.locator("[data-unsaved]")).to_have_count(0)


def idle(page: Page) -> None:
    """Wait until the server has answered every edit, and the canvas shows it and rests."""
    expect(page.locator("[data-editor]")).to_have_attribute("aria-busy", "false")
    expect(page.locator("[data-canvas]")).to_have_attribute("aria-busy", "false")


def file_text(shop: Workshop, behavior_id: str) -> str:
    """What is on disk."""
    return Path(shop.project, behavior_id).read_bytes().decode("utf-8")
