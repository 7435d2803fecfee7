"""The task of building: one arm of the transfer from nothing, twelve states in a row, until nothing is wrong with them.

The other arm is the same again. What is typed is typed letter by letter, and what is offered is selected.
"""

from __future__ import annotations

from playwright.sync_api import Locator, expect

from benchmarks.clicks_tasks import Hand, Task, at_home

_JOINTS = {"robot": "left", "speed": "0.5"}
_LINE = {"robot": "left", "speed_m_s": "0.25"}
_HAND = {"gripper": "left"}
_PART = {"part": "hca_north"}
_UP = {"offset_m x": "0", "offset_m y": "0", "offset_m z": "0.15"}
STATES: tuple[tuple[str, dict[str, str]], ...] = (
    ("gripper.Open", _HAND),
    ("motion.MoveJoints", {**_JOINTS, "target": "left_above_pick"}),
    ("motion.MoveLinear", {**_LINE, "target": "left_pick"}),
    ("gripper.Grasp", {**_HAND, **_PART, "width_m": "0.03", "force_n": "30"}),
    ("motion.MoveLinear", {**_LINE, "target": "left_pick", **_UP}),
    ("motion.MoveJoints", {**_JOINTS, "target": "left_carry"}),
    ("motion.MoveJoints", {**_JOINTS, "target": "left_above_place"}),
    ("gripper.CheckHeld", {**_HAND, **_PART}),
    ("motion.MoveLinear", {**_LINE, "target": "left_place"}),
    ("gripper.Open", {**_HAND, **_PART}),
    ("motion.MoveLinear", {**_LINE, "target": "left_place", **_UP}),
    ("motion.MoveJoints", {**_JOINTS, "target": "left_home"}),
)


def build(hand: Hand) -> str:
    """A new behavior for the connected cell, with what its machine may end with, until there is no problem."""
    page = hand.page
    hand.button("New")
    hand.click(page.get_by_label("Name", exact=True))
    hand.type("one_arm")
    older = page.get_by_role("button", name="Make it", exact=True)
    belongs_to_the_cell = not older.is_visible()
    hand.click(older.or_(page.get_by_role("button", name="Create")).first)
    expect(page.get_by_role("tab", name="Behavior")).to_be_visible()
    if not belongs_to_the_cell:
        hand.click(page.get_by_role("tab", name="Behavior"))
        _fill(hand, "Cell", "cells/dual_panda.yaml")
    hand.click(page.locator(".react-flow__pane"))
    for state, fields in STATES:
        hand.press("a")
        hand.type(state)
        hand.press("Enter")
        expect(page.get_by_role("combobox", name=next(iter(fields)), exact=True)).to_be_visible()
        rest(hand)
        for name, value in fields.items():
            _fill(hand, name, value)
    # What is open leads to the next one, or to the outcome of its name.
    hand.click(page.locator(".react-flow__pane"))
    hand.press("Control+A")
    hand.press("w")
    rest(hand)
    problems = page.get_by_role("tab", name="Problems")
    hand.click(problems)
    rest(hand)
    left = page.locator("[data-problem-count], .problem-count").first.inner_text()
    return "" if left == "No problems" else f"left to connect by hand: {left}"


def _fill(hand: Hand, name: str, value: str) -> None:
    field: Locator = hand.page.get_by_role("combobox", name=name, exact=True)
    if field.input_value() == value:
        return
    hand.click(field)
    hand.press("Control+A")
    hand.type(value)
    hand.press("Tab")
    rest(hand)


def rest(hand: Hand) -> None:
    """Wait until the server has answered every edit."""
    for part in ("[data-editor], .editor", "[data-canvas], .edit-canvas"):
        expect(hand.page.locator(part).first).to_have_attribute("aria-busy", "false")


BUILD = Task(name="build one arm of the transfer", prepare=at_home, do=build)
