"""A frame of the cell that an arm teaches by three points, in a real browser."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Browser, expect

from engine.document.cell import load_cell
from tests.editor_web.browsing import opened_page, require_accessible
from tests.editor_web.real_server import dashboard_of
from tests.engine.cli.process import started

CELL = """\
flexcell: 1
cell: bench
world: {kind: mujoco}
robots:
  left: {model: panda, gripper: {model: panda_hand}}
fixtures:
  table: {shape: box, size_m: [0.4, 0.4, 0.1], at: {xyz: [0.9, 0, 0.05]}}
frames:
  slot: {parent: table}
"""


def test_a_frame_is_taught_by_three_points_in_what_it_stands_in(browser: Browser, tmp_path: Path) -> None:
    file = tmp_path / "cell.yaml"
    file.write_text(CELL)
    with (
        started("serve", "--cell", "cell.yaml", "--port", "0", cwd=tmp_path) as server,
        opened_page(browser, dashboard_of(server, tmp_path / ".flexcell"), "/workcell/frames/slot") as page,
    ):
        page.get_by_role("button", name="Edit the cell").click()
        page.get_by_role("button", name="Teach with an arm").click()
        dialog = page.get_by_role("dialog", name="Teach slot")
        # The arm is at home: three times the same point is no frame.
        for point in ("Origin", "Point on x", "Point on y"):
            dialog.get_by_role("button", name=re.compile(f"^Take: {point}")).click()
        expect(dialog.get_by_text("is 0.0 mm from the origin")).to_be_visible()
        for point, values in (("Origin", "0.8 0 0.1"), ("Point on x", "0.8 0.1 0.1"), ("Point on y", "0.7 0 0.1")):
            for axis, value in zip("xyz", values.split(), strict=True):
                dialog.get_by_label(f"{point} {axis}", exact=True).fill(value)
        expect(dialog.get_by_text("90.00° apart")).to_be_visible()
        require_accessible(page, "a frame that is taught")
        dialog.get_by_role("button", name="Make the pose of the points").click()
        dialog.get_by_role("button", name="Use this value").click()
        expect(dialog).to_have_count(0)
        expect(page.get_by_label("Position x", exact=True)).to_have_value("-0.1")
        page.get_by_role("button", name="Apply").click()
        expect(page.get_by_role("button", name="Apply")).to_be_disabled()
        page.keyboard.press("Control+s")
        expect(page.locator("[data-unsaved]")).to_have_count(0)
    slot = load_cell(file).document.frames["slot"]
    assert (slot.parent, slot.at.xyz, slot.at.rpy) == ("table", (-0.1, 0.0, 0.05), (0.0, 0.0, 1.570796))
