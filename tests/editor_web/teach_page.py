"""The page on which arms are taught, driven: opened, its tabs, and a gamepad that the test holds."""

from __future__ import annotations

import re
from collections.abc import Generator, Sequence
from contextlib import ExitStack, contextmanager

from playwright.sync_api import Browser, Locator, Page, expect

from tests.editor_web.browsing import Scheme, opened_page
from tests.editor_web.teach_site import TeachSite
from tests.editor_web.viser_page import ViserPage, served_view

LAPTOP = (1280, 800)
SOUTH, DEADMAN, SHIFT, START = 0, 4, 5, 9
_PADS = """
window.pads = [null, null, null, null]
window.padReads = 0
navigator.getGamepads = () => { window.padReads += 1; return window.pads }
"""
_HOLD = """([index, axes, down]) => {
    const isNew = window.pads[index] === null
    const buttons = Array.from({length: 17}, (_, at) => ({pressed: down.includes(at), value: +down.includes(at)}))
    window.pads[index] = {connected: true, index, axes, buttons}
    if (isNew) dispatchEvent(new Event('gamepadconnected'))
}"""
_LOOKED_AT = """(times) => new Promise((done) => {
    const until = window.padReads + times
    const look = () => (window.padReads > until ? done() : requestAnimationFrame(look))
    look()
})"""
_GONE = """(index) => { window.pads[index] = null; dispatchEvent(new Event('gamepaddisconnected')) }"""


@contextmanager
def teaching(
    browser: Browser, site: TeachSite, *, scheme: Scheme = "light", size: tuple[int, int] = LAPTOP, quiet: bool = True
) -> Generator[Page]:
    """Open the page, which knows the arm and has prepared it for jogging: a press before that moves nothing."""
    with opened_page(browser, site.running, "/teach", scheme=scheme, size=size, quiet=quiet) as page:
        expect(page.get_by_role("status", name="State of left").first).to_have_text("idle")
        expect(page.get_by_role("button", name="Z plus", exact=True)).not_to_have_attribute("aria-disabled", "true")
        yield page


def tab(page: Page, name: str) -> Locator:
    """Open a tab."""
    page.get_by_role("tab", name=name, exact=True).click()
    return page.get_by_role("tabpanel", name=name, exact=True)


@contextmanager
def seeing(site: TeachSite, name: str) -> Generator[ViserPage]:
    """A 3D view beside that of the page, of the same name or another."""
    with ExitStack() as stack:
        view = served_view(site.running, name)
        opened = site.call(view.__aenter__())
        stack.callback(lambda: site.call(view.__aexit__(None, None, None)))
        yield opened


def name_of(page: Page) -> str:
    """What the page calls itself."""
    found = re.fullmatch(
        r"http://[^/]+/cell/(\w+)/.*", page.locator("iframe[title='3D view of the cell']").get_attribute("src") or ""
    )
    assert found is not None
    return found[1]


class Gamepads:
    """Gamepads that the browser has in the place of real ones."""

    def __init__(self, page: Page) -> None:
        self._page = page
        page.evaluate(_PADS)

    def hold(self, *down: int, axes: Sequence[float] = (0.0, 0.0, 0.0, 0.0), index: int = 0) -> None:
        """Have these buttons down and the sticks there."""
        self._page.evaluate(_HOLD, [index, list(axes), list(down)])

    def unplug(self, index: int = 0) -> None:
        """Take it away."""
        self._page.evaluate(_GONE, index)

    def looked_at(self, times: int = 10) -> None:
        """Wait until the page has looked at them so often, and once more."""
        self._page.evaluate(_LOOKED_AT, times)
