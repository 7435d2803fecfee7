"""The graph of a run goes with what is active: to a breakpoint that is hit, in a real browser."""

from __future__ import annotations

import re
from textwrap import indent

from playwright.sync_api import Browser, Locator, Page, expect

from engine.runtime.control.breakpoint import Breakpoint
from engine.runtime.run_options import RunOptions
from tests.editor_web.browsing import opened_page
from tests.editor_web.workshop import Workshop

LONG_ID = "behaviors/long.yaml"
STEPS = 30
COLLAPSE = re.compile(r"^Collapse .*far$")
FIRST = "root/both/chain/step_0"
INSIDE = "root/both/chain/far/inside"
WHOLE = 0.999
"""Of a node that is seen whole, zoomed to any fraction of a pixel."""


def long_behavior() -> str:
    """Return a chain that is legible only in parts, ends with a container, and has another active branch far away."""
    names = [f"step_{number}" for number in range(STEPS)]
    steps = "".join(
        f"              {name}: {{state: test.Give, transitions: {{a: {following}, b: bad, c: bad}}}}\n"
        for name, following in zip(names, [*names[1:], "far"], strict=True)
    )
    return f"""\
flexcell: 1
name: long
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            other: {{state: flow.Wait, with: {{duration_s: 3000}}}}
            chain:
              machine:
                initial: step_0
                states:
{indent(steps, "    ")}\
                  far:
                    machine:
                      initial: begin
                      states:
                        begin: {{state: test.Give, transitions: {{a: inside, b: bad, c: bad}}}}
                        inside: {{state: test.Give, transitions: {{a: good, b: bad, c: bad}}}}
                    transitions: {{good: good, bad: bad}}
          conditions:
            - {{good: {{other: done, chain: good}}}}
            - {{bad: {{chain: bad}}}}
        transitions: {{good: good, bad: bad}}
"""


def leaf(page: Page, path: str) -> Locator:
    """A node of the graph."""
    return page.locator(f".react-flow__node[data-id='{path}'] [data-node]")


def test_a_breakpoint_that_is_hit_is_gone_to_opened_and_legible(browser: Browser, shop: Workshop) -> None:
    """Its container was collapsed, another branch is active far from it, and all was seen, too small to be read."""
    (shop.project / LONG_ID).write_text(long_behavior(), encoding="utf-8")
    points = (Breakpoint(path=FIRST), Breakpoint(path=INSIDE))
    with opened_page(browser, shop.running, f"/behaviors/{LONG_ID}", size=(1280, 800)) as page:
        expect(leaf(page, FIRST)).to_be_visible()
        graph = page.locator("[data-graph]")
        shop.start(LONG_ID, supervision=RunOptions(breakpoints=points))
        waits = page.get_by_role("list", name="Nodes that wait")
        expect(waits).to_have_text(f"{FIRST} before its entry: paused")
        # The view has gone to the first one, by itself and legible.
        expect(leaf(page, FIRST)).to_be_in_viewport(ratio=WHOLE)
        expect(graph).to_have_attribute("data-detail", "all")
        page.get_by_role("button", name="Show all").click()
        expect(graph).not_to_have_attribute("data-detail", "all")
        page.get_by_role("button", name=COLLAPSE).click()
        expect(leaf(page, INSIDE)).to_have_count(0)
        page.get_by_role("button", name="Follow", exact=True).click()
        page.get_by_role("button", name="Resume", exact=True).click()
        expect(waits).to_have_text(f"{INSIDE} before its entry: paused")
        expect(leaf(page, INSIDE)).to_be_in_viewport(ratio=WHOLE)
        expect(graph).to_have_attribute("data-detail", "all")


def test_a_breakpoint_moves_nothing_while_the_view_is_not_followed(browser: Browser, shop: Workshop) -> None:
    """Somebody looks at something else: it stays, and the collapsed container too."""
    (shop.project / LONG_ID).write_text(long_behavior(), encoding="utf-8")
    points = (Breakpoint(path=FIRST), Breakpoint(path=INSIDE))
    with opened_page(browser, shop.running, f"/behaviors/{LONG_ID}", size=(1280, 800)) as page:
        expect(leaf(page, FIRST)).to_be_visible()
        shop.start(LONG_ID, supervision=RunOptions(breakpoints=points))
        waits = page.get_by_role("list", name="Nodes that wait")
        expect(waits).to_have_text(f"{FIRST} before its entry: paused")
        page.get_by_role("button", name="Show all").click()
        page.get_by_role("button", name=COLLAPSE).click()
        expect(leaf(page, INSIDE)).to_have_count(0)
        page.get_by_role("button", name="Resume", exact=True).click()
        expect(waits).to_have_text(f"{INSIDE} before its entry: paused")
        expect(page.get_by_role("button", name="Follow", exact=True)).to_be_visible()
        expect(leaf(page, INSIDE)).to_have_count(0)
