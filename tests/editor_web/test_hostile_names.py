"""Names that every JavaScript object inherits, as parameters, userdata, states and outcomes, in a real browser."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser, expect

from engine.event import RunStarted
from tests.editor_web.browsing import opened_page
from tests.editor_web.workshop import Workshop

PARAMETERS = ("__proto__", "constructor", "toString", "hasOwnProperty")
USERDATA = ("valueOf", "isPrototypeOf")
HOSTILE_ID = "behaviors/hostile.yaml"
HOSTILE = """
flexcell: 1
name: hostile
parameters:
  __proto__: {type: number, default: 1, minimum: 0, maximum: 10}
  constructor: {type: string}
  toString: {type: number, default: 2}
  hasOwnProperty: {type: boolean, default: true}
userdata: {valueOf: 1, isPrototypeOf: [2]}
outcomes: [hasOwnProperty]
success: [hasOwnProperty]
root:
  machine:
    initial: constructor
    states:
      constructor: {state: flow.Wait, with: {duration_s: 3000}, transitions: {done: toString}}
      toString: {state: flow.Wait, with: {duration_s: 0}, transitions: {done: hasOwnProperty}}
"""


def write(shop: Workshop) -> None:
    """Put the document into the project."""
    Path(shop.project, HOSTILE_ID).write_text(HOSTILE, encoding="utf-8")


def test_a_run_of_inherited_names_is_started_and_watched(browser: Browser, shop: Workshop) -> None:
    """The form asks for what is missing, the run gets what was typed, its data is listed by name."""
    write(shop)
    with opened_page(browser, shop.running, f"/behaviors/{HOSTILE_ID}") as page:
        for name in PARAMETERS:
            expect(page.locator(f"[name='{name}']")).to_be_attached()
        page.get_by_role("button", name="Start", exact=True).click()
        expect(page.get_by_text("A value is required")).to_have_count(1)
        page.locator("[name='constructor']").fill("given")
        page.locator("[name='__proto__']").fill("7")
        page.get_by_role("button", name="Start", exact=True).click()
        expect(page.locator(".react-flow__node[data-id='root/constructor'] [data-node]")).to_have_attribute(
            "data-status", "active"
        )
        page.get_by_role("tab", name="Data").click()
        data = page.get_by_role("tabpanel", name="Data")
        for name in USERDATA:
            expect(data.get_by_text(name, exact=True)).to_be_visible()
        expect(page.get_by_role("alert")).to_have_count(0)
    run = shop.session.runs()[0].id
    started = next(event for event in shop.events(run) if isinstance(event, RunStarted))
    assert started.parameters == {"__proto__": 7.0, "constructor": "given", "toString": 2, "hasOwnProperty": True}


def test_a_behavior_of_inherited_names_is_edited(browser: Browser, shop: Workshop) -> None:
    """The form of the document, of its states and its text show them; nothing fails."""
    write(shop)
    with opened_page(browser, shop.running, f"/edit/{HOSTILE_ID}") as page:
        node = page.locator(".react-flow__node[data-id='root/constructor']")
        node.click()
        expect(page.get_by_label("Form of constructor")).to_be_visible()
        page.get_by_role("tab", name="Behavior").click()
        for name in (*PARAMETERS, *USERDATA):
            expect(page.get_by_text(name, exact=True).first).to_be_visible()
        expect(page.get_by_role("alert")).to_have_count(0)
