"""A page on a slow processor: what is drawn once stays where it is while the rest of it comes."""

from __future__ import annotations

from typing import Any

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.editor_web.browsing import opened_page
from tests.editor_web.editing import idle
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.workshop import SHIFT_ID, Workshop

SLOWER = 4
"""The page's processor time takes so many times as long."""
LARGEST_SHIFT = 0.03
"""Of the layout, after the first content: less than a third of what counts as good."""
WATCH = """() => {
    const places = (globalThis.headPlaces = new Map())
    const look = () => {
        const isPainted = performance.getEntriesByName('first-contentful-paint').length > 0
        for (const each of isPainted ? document.querySelectorAll('header button, header a') : []) {
            const { x, y, width } = each.getBoundingClientRect()
            const before = places.get(each)?.at(-1)
            const isMoved = !before || Math.abs(before[0] - x) > 1 || Math.abs(before[1] - y) > 1
            if (width > 0 && isMoved) places.set(each, [...(places.get(each) ?? []), [Math.round(x), Math.round(y)]])
        }
        requestAnimationFrame(look)
    }
    look()
}"""
"""Where each control of a head is, in every frame."""
PLACES = (
    """() => [...headPlaces].map(([each, at]) => [each.getAttribute('aria-label') ?? each.textContent.trim(), at])"""
)
SHIFTS = """() => new Promise((resolve) => {
    const [first] = performance.getEntriesByName('first-contentful-paint')
    const nameOf = ({ node }) => node?.nodeType === 1 ? node.cloneNode(false).outerHTML.slice(0, 160) : '?'
    new PerformanceObserver((list, observer) => {
        observer.disconnect()
        const late = list.getEntries().filter((each) => each.startTime > first.startTime && !each.hadRecentInput)
        resolve(late.map((each) => [each.value, each.sources.map(nameOf)]))
    }).observe({ type: 'layout-shift', buffered: true })
    // Nothing is reported where nothing has moved.
    requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(() => resolve([]))))
})"""
"""Each shift of the layout after the first content: how large, and of what."""


def rested(page: Page, part: str) -> None:
    """Wait until a part is drawn, and nothing more is asked of the server."""
    expect(page.locator(part).first).to_be_visible(timeout=GUARD_MS)
    page.wait_for_load_state("networkidle")
    page.evaluate("() => document.fonts.ready.then(() => new Promise((done) => requestAnimationFrame(done)))")


@pytest.mark.parametrize("name", ["behavior", "run", "editor", "past run"])
def test_what_is_drawn_stays_where_it_is_while_the_page_comes(browser: Browser, shop: Workshop, name: str) -> None:
    run = shop.start() if "run" in name else ""
    path = {"editor": f"/edit/{SHIFT_ID}", "past run": f"/runs/{run}"}.get(name, f"/behaviors/{SHIFT_ID}")
    with opened_page(browser, shop.running) as page:
        page.context.add_init_script(f"({WATCH})()")
        session: Any = page.context.new_cdp_session(page)
        session.send("Emulation.setCPUThrottlingRate", {"rate": SLOWER})
        page.goto(shop.running.url.rstrip("/") + path)
        rested(page, ".react-flow .react-flow__node")
        if name == "editor":
            idle(page)
        if run:
            expect(page.get_by_role("button", name="Stop this run")).to_be_visible(timeout=GUARD_MS)
        shifts: list[Any] = page.evaluate(SHIFTS)
        places: list[tuple[str, list[list[int]]]] = page.evaluate(PLACES)
    assert sum(size for size, _ in shifts) < LARGEST_SHIFT, shifts
    assert len(places) > 2, places
    assert [each for each in places if len(each[1]) > 1] == []
