"""Nodes of the editor's canvas that are laid out by themselves, in a real browser."""

from __future__ import annotations

from itertools import combinations

import pytest
from playwright.sync_api import Browser, FloatRect, Page, expect

from engine.document import load_behavior
from tests.editor_web.editing import at_editor, card, file_text, idle, save
from tests.editor_web.workshop import SHIFT_ID, Workshop


def saved_view(page: Page, shop: Workshop) -> dict[str, list[float]]:
    """Save, and read the positions that are on disk."""
    idle(page)
    save(page)
    view = load_behavior(shop.project / SHIFT_ID).document.view
    return {path: list(at) for path, at in view.items()}


def boxes_on_screen(page: Page) -> dict[str, FloatRect]:
    """Where the nodes of the root are."""
    found = {name: card(page, f"root/{name}").bounding_box() for name in ("first", "set", "both", "rest")}
    return {name: box for name, box in found.items() if box is not None}


def lie_apart(one: FloatRect, other: FloatRect) -> bool:
    """Does neither cover a part of the other?"""
    return (
        one["x"] + one["width"] <= other["x"]
        or other["x"] + other["width"] <= one["x"]
        or one["y"] + one["height"] <= other["y"]
        or other["y"] + other["height"] <= one["y"]
    )


def test_selected_nodes_are_laid_out_among_themselves_and_the_others_stay(browser: Browser, shop: Workshop) -> None:
    """By button and by key, around where they were, over nothing; one step of undo gives every byte back."""
    scattered = {"first": [600, 40], "set": [0, 300], "both": [330, 130], "rest": [1100, 0]}
    places = "".join(f"  root/{name}: {at}\n" for name, at in scattered.items())
    with (shop.project / SHIFT_ID).open("a", encoding="utf-8") as file:
        file.write(f"view:\n{places}")
    text = file_text(shop, SHIFT_ID)
    with at_editor(browser, shop, SHIFT_ID) as page:
        card(page, "root/first").click()
        card(page, "root/set").click(modifiers=["Shift"])
        bar = page.get_by_role("toolbar", name="Selected nodes")
        expect(bar).to_contain_text("2 selected")
        bar.get_by_role("button", name="Auto-layout of the selected nodes (Shift+L)").click()
        idle(page)
        boxes = boxes_on_screen(page)
        view = saved_view(page, shop)
        assert {name: view[f"root/{name}"] for name in ("both", "rest")} == {
            name: scattered[name] for name in ("both", "rest")
        }
        assert boxes["first"]["y"] == pytest.approx(boxes["set"]["y"], abs=1)
        assert boxes["first"]["x"] + boxes["first"]["width"] < boxes["set"]["x"]
        for one, other in combinations(boxes, 2):
            assert lie_apart(boxes[one], boxes[other]), (one, other)
        page.keyboard.press("Control+z")
        idle(page)
        save(page)
        assert file_text(shop, SHIFT_ID) == text
        page.keyboard.press("Shift+L")
        idle(page)
        assert saved_view(page, shop) == view
        page.keyboard.press("Shift+L")
        expect(page.get_by_text("It is laid out already")).to_be_visible()
        card(page, "root/set").locator("[data-head]").click(button="right")
        menu = page.get_by_role("menu", name="Selected nodes")
        # All of it fits, wherever the pointer is.
        for name in ("Disable 2 nodes", "Auto-layout", "Delete"):
            expect(menu.get_by_role("menuitem", name=name)).to_be_in_viewport(ratio=1)
