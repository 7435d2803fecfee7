"""A behavior of 1,000 states opens, is seen as a whole, and can be edited; what that costs is measured elsewhere."""

from __future__ import annotations

import re

import pytest
from playwright.sync_api import Browser, expect

from benchmarks.large_document import large_document
from engine.document import load_behavior
from tests.editor_web.editing import at_editor, card, file_text, idle, save
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.workshop import Workshop

LARGE_ID = "behaviors/large.yaml"
STATES = 1000
INNER = "root/area_1/step_0"
DRAWN_ALL = re.compile(r"^1[12]\d\d$")
"""The states, the containers around them, and their outcomes."""


@pytest.fixture
def large(shop: Workshop) -> Workshop:
    """A project with a large behavior."""
    (shop.project / LARGE_ID).write_text(large_document(STATES), encoding="utf-8")
    return shop


def test_a_thousand_states_open_closed_and_an_edit_deep_inside_changes_its_lines_only(
    browser: Browser, large: Workshop
) -> None:
    before = file_text(large, LARGE_ID)
    with at_editor(browser, large, LARGE_ID) as page:
        expect(card(page, "root/area_0")).to_contain_text("State machine of")
        card(page, "root/area_1").dblclick(position={"x": 60, "y": 14})
        idle(page)
        card(page, INNER).dblclick(position={"x": 60, "y": 14})
        idle(page)
        card(page, f"{INNER}/wait_3").click()
        page.keyboard.press("Control+d")
        expect(card(page, f"{INNER}/wait_3_2")).to_be_visible()
        idle(page)
        save(page)
    after = file_text(large, LARGE_ID)
    assert load_behavior(large.project / LARGE_ID).root.children["area_1"].children["step_0"].children["wait_3_2"]
    kept = iter(after.split("\n"))
    assert all(line in kept for line in before.split("\n"))
    assert len(after.split("\n")) - len(before.split("\n")) == 4


def test_all_of_it_is_seen_from_far_away_as_plain_boxes_and_in_full_near_by(browser: Browser, large: Workshop) -> None:
    with at_editor(browser, large, LARGE_ID) as page:
        card(page, "root/area_1").click()
        page.keyboard.press("Shift+O")
        expect(page.locator("[data-canvas]")).to_have_attribute("data-drawn", DRAWN_ALL, timeout=GUARD_MS)
        expect(page.locator("[data-far-lines] path")).to_have_attribute("d", re.compile("M.*L"))
        expect(card(page, f"{INNER}/wait_3")).to_have_accessible_name(re.compile("State wait_3, runs flow.Wait"))
        page.wait_for_function(f"() => document.querySelectorAll('[data-box]').length > {STATES}")
        # One node asked for by the palette is gone to, and there everything can be read.
        page.keyboard.press("Control+k")
        page.keyboard.type("wait_5")
        page.get_by_role("option").filter(has_text="root/area_0/step_0").first.click()
        found = card(page, "root/area_0/step_0/wait_5")
        expect(found.locator("[data-name]")).to_have_text("wait_5")
        expect(found).to_be_focused()
        expect(page.locator("[data-far-lines]")).to_have_count(0)
        page.wait_for_function(f"() => document.querySelectorAll('.react-flow__node').length < {STATES / 2}")
        page.keyboard.press("Shift+O")
        expect(page.locator("[data-canvas]")).not_to_have_attribute("data-drawn", DRAWN_ALL)
