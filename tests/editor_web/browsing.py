"""Driving a real browser: which one, a logged-in page that must stay silent, and axe."""

from __future__ import annotations

import os
import shutil
import time
from collections.abc import Callable, Generator, Sequence
from contextlib import contextmanager
from typing import Any, Literal

from playwright.sync_api import APIResponse, Browser, ConsoleMessage, Locator, Page, Route, expect

import bootstrap
import hatch_build
from editor_web.server import Dashboard
from tests.editor_web.limits import GUARD_MS, GUARD_S

AXE = hatch_build.SOURCE / "node_modules" / "axe-core" / "axe.min.js"
FADED = """() => {
    const ends = (each) => each.effect?.getComputedTiming().endTime !== Infinity
    document.getAnimations().filter(ends).forEach((each) => each.finish())
}"""
"""Ends what fades: to wait for it lasts for ever where a part is out of sight, and where something turns endlessly."""
OF_COLOURS = ("color-contrast", "link-in-text-block")
"""The rules of axe-core that look at colours."""
Scheme = Literal["light", "dark"]
SCHEMES: tuple[Scheme, Scheme] = ("light", "dark")
Size = tuple[int, int]
TABS = 150
"""Presses of Tab within which a control is reached."""
DESK: Size = (1366, 768)
PHONE: Size = (390, 844)


def browser_program() -> str:
    """The browser to drive: FLEXCELL_CHROMIUM, else the first one installed."""
    named = os.environ.get("FLEXCELL_CHROMIUM")
    found = named or next((path for name in bootstrap.BROWSERS if (path := shutil.which(name))), None)
    assert found, (
        "no Chromium: install `chromium-headless-shell` or `chromium`, or set FLEXCELL_CHROMIUM to its program"
    )
    return found


# What the 3D view says of its light when it is left, or changes its theme, before that has come.
LEFT_WHILE_LOADING = "Failed to load HDR JPEG: TypeError: Failed to fetch"


@contextmanager
def opened_page(
    browser: Browser,
    running: Dashboard,
    path: str = "/",
    *,
    quiet: bool = True,
    size: Size = DESK,
    scheme: Scheme = "light",
    login: str = "",
) -> Generator[Page]:
    """Log in, as the operator unless `login` says otherwise, and open an address; console errors fail a quiet page."""
    context = browser.new_context(locale="en-US", viewport={"width": size[0], "height": size[1]}, color_scheme=scheme)
    # A click waits until a part rests for two frames, which a 3D view without a graphics card holds up.
    context.set_default_timeout(2 * GUARD_MS)
    page = context.new_page()
    said: list[str] = []

    def listen(message: ConsoleMessage) -> None:
        if message.type == "error" and not message.text.startswith(LEFT_WHILE_LOADING):
            said.append(message.text)

    page.on("console", listen)
    page.on("pageerror", lambda error: said.append(str(error)))
    try:
        context.request.get(login or running.new_login_url(), max_redirects=0)
        page.goto(running.url.rstrip("/") + path)
        yield page
    finally:
        # Nothing of a page that failed disturbs the next one.
        context.close()
    assert not (said and quiet), said


def require_accessible(page: Page, what: str, *, part: str = "") -> None:
    """axe-core finds nothing on the page, or in the part that a selector names, in its theme and in the other one.

    In the other theme only colours are looked at: nothing else of the page depends on it.
    """
    if not page.evaluate("() => 'axe' in window"):
        page.evaluate(f"() => {{ {AXE.read_text(encoding='utf-8')} }}")
    is_dark: bool = page.evaluate("() => matchMedia('(prefers-color-scheme: dark)').matches")
    own, other = SCHEMES[is_dark], SCHEMES[not is_dark]
    _require_accessible(page, what, own, part, None)
    _require_accessible(page, what, other, part, OF_COLOURS)
    page.emulate_media(color_scheme=own)


def _require_accessible(page: Page, what: str, scheme: Scheme, part: str, only: Sequence[str] | None) -> None:
    page.emulate_media(color_scheme=scheme)
    # The page for logging in has no themes of its own.
    page.wait_for_function(
        "(s) => [s, undefined].includes(document.documentElement.dataset.mantineColorScheme)", arg=scheme
    )
    page.evaluate(FADED)
    result: dict[str, Any] = page.evaluate(
        "([part, only]) => axe.run(part || document, { resultTypes: ['violations'], ...(only && { runOnly: only }) })",
        [part, only],
    )
    found = [(v["id"], [n["html"][:160] for n in v["nodes"]][:4]) for v in result["violations"]]
    assert found == [], f"{what}, {scheme}: {found}"


def require_fit(page: Page, width: int, height: int | None = None) -> None:
    """Nothing reaches beyond the screen, sideways, or at all where a height is given."""
    page.wait_for_function(
        "([width, height]) => document.documentElement.scrollWidth <= width"
        " && document.documentElement.scrollHeight <= height",
        arg=[width, 1e9 if height is None else height],
    )


def until(page: Page, condition: Callable[[], bool]) -> None:
    """Let the page go on until something outside of it is so, as what it asked the server for."""
    end_s = time.monotonic() + GUARD_S
    while not condition():
        assert time.monotonic() < end_s, "it has never been so"
        page.wait_for_timeout(20)


def switch(box: Locator, *, on: bool = True) -> None:
    """Turn a switch or choice by the keyboard, which misses nothing in a layout that still moves, and see it turned."""
    expect(box).to_be_enabled()
    box.press("Space")
    expect(box).to_be_checked(checked=on)


def tab_to(page: Page, control: Locator, *, key: Literal["Tab", "Shift+Tab"] = "Tab") -> None:
    """Go to a control by the key Tab alone."""
    # The box of a segmented control is out of sight, and takes the keyboard.
    expect(control).to_be_attached()
    for _ in range(TABS):
        if control.evaluate("(element) => element === document.activeElement"):
            return
        page.keyboard.press(key)
    expect(control).to_be_focused()


def fetched(route: Route) -> APIResponse:
    """Ask the server in the name of the page: a request of a test does not say where it comes from, and is refused."""
    return route.fetch(headers={**route.request.all_headers(), "sec-fetch-site": "same-origin"})
