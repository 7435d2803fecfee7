"""A cell of two arms built from nothing in a real browser, by mouse and keyboard; a part is handed over in it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from playwright.sync_api import Browser, Page, expect

from engine.document.cell import load_cell
from tests.editor_web.browsing import opened_page
from tests.editor_web.real_server import dashboard_of
from tests.engine.cli.command import flexcell
from tests.engine.cli.process import started

HAND_OVER = """\
flexcell: 1
name: hand_over
description: The left arm puts the block where the right one gets it, and that one carries it on.
cell: cell.yaml
outcomes: [finished, failed]
success: [finished]
root:
  machine:
    initial: pick_left
    states:
      pick_left:
        state: manipulation.PickPart
        with: {robot: left, part: block, grasp: {xyz: [0, 0, 0], xyzw: [1, 0, 0, 0], frame: part}, width_m: 0.04}
        transitions: {picked: place_left, missed: failed, unreachable: failed, blocked: failed, failed: failed}
      place_left:
        state: manipulation.PlacePart
        with:
          robot: left
          part: block
          target: {xyz: [0, 0, 0.026], xyzw: [0, 0, 0, 1], frame: middle}
          target_of: part
          approach: [0, 0, 1]
        transitions: {placed: away, missed: failed, unreachable: failed, blocked: failed, failed: failed}
      away:
        state: motion.MoveFree
        with: {robot: left, joints: [0, -0.785, 0, -2.356, 0, 1.571, 0.785]}
        transitions: {reached: pick_right, no_way: failed, blocked: failed, failed: failed}
      pick_right:
        state: manipulation.PickPart
        with: {robot: right, part: block, grasp: {xyz: [0, 0, 0], xyzw: [1, 0, 0, 0], frame: part}, width_m: 0.04}
        transitions: {picked: place_right, missed: failed, unreachable: failed, blocked: failed, failed: failed}
      place_right:
        state: manipulation.PlacePart
        with:
          robot: right
          part: block
          target: {xyz: [0, 0, 0.026], xyzw: [0, 0, 0, 1], frame: there}
          target_of: part
          approach: [0, 0, 1]
        transitions: {placed: lies, missed: failed, unreachable: failed, blocked: failed, failed: failed}
      lies:
        state: cell.ExpectPart
        with: {part: block, frame: there, tolerance_m: 0.03}
        transitions: {there: finished, elsewhere: failed}
"""


def add(page: Page, kind: str, name: str, values: Mapping[str, str], choices: Mapping[str, str] | None = None) -> None:
    """Add an item from the list, give it its numbers and its name, and apply them by Enter."""
    forms = page.locator('form[aria-label^="Change "]')
    shown = forms.get_attribute("aria-label") if forms.count() else None
    page.get_by_role("button", name="Add", exact=True).click()
    page.get_by_role("menuitem", name=kind, exact=True).click()
    # The form of the item before stays until the server has answered.
    form = page.locator(f'form[aria-label^="Change "]:not([aria-label="{shown}"])')
    expect(form).to_be_visible()
    for label, value in (choices or {}).items():
        form.get_by_label(label).select_option(value)
    for label, value in values.items():
        form.get_by_label(label, exact=True).fill(value)
    form.get_by_label("Name").fill(name)
    page.keyboard.press("Enter")
    expect(page.get_by_role("form", name=f"Change {name}")).to_be_visible()


def test_two_arms_hand_a_part_over_in_a_cell_that_was_built_from_nothing(browser: Browser, tmp_path: Path) -> None:
    assert flexcell("cell", "new", "cell.yaml", cwd=tmp_path).code == 0
    panda = {"Model": "panda", "Tool": "panda_hand"}
    with (
        started("serve", "--cell", "cell.yaml", "--port", "0", cwd=tmp_path) as server,
        opened_page(browser, dashboard_of(server, tmp_path / ".flexcell"), "/workcell") as page,
    ):
        page.get_by_role("button", name="Edit the cell").click()
        add(page, "Robot", "left", {"Position x": "-0.5"}, panda)
        add(page, "Robot", "right", {"Position x": "0.5", "Roll, pitch, yaw y": "180"}, panda)
        block = {"Size x": "0.05", "Size y": "0.04", "Size z": "0.05"}
        add(page, "Part", "block", {**block, "Position x": "-0.2", "Position y": "0.25", "Position z": "0.026"})
        add(page, "Frame", "middle", {"Position y": "-0.2"})
        add(page, "Frame", "there", {"Position x": "0.2", "Position y": "0.2"})
        page.keyboard.press("Control+s")
        expect(page.locator("[data-unsaved]")).to_have_count(0)
        expect(page.get_by_role("button", name="Connect the cell anew")).to_be_enabled()
    document = load_cell(tmp_path / "cell.yaml").document
    assert {name: robot.model for name, robot in document.robots.items()} == {"left": "panda", "right": "panda"}
    (tmp_path / "hand_over.yaml").write_text(HAND_OVER, encoding="utf-8")
    ran = flexcell("run", "hand_over.yaml", "--clock", "virtual", cwd=tmp_path)
    assert ran.code == 0, ran.out + ran.err
