"""A real gripper on the page, in a real browser: enabled with a reason, stopped by its own fault, and enabled again."""

from __future__ import annotations

import json
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path

from playwright.sync_api import Browser, Locator, Page, expect

from editor_web.server import Dashboard
from tests.editor_web.browsing import opened_page, require_accessible
from tests.editor_web.real_server import dashboard_of
from tests.editor_web.stop_process import stop_button, stop_status
from tests.engine.cli.process import started
from tests.robots.drivers.emulated_device import EmulatedProcess
from tests.robots.drivers.emulated_gripper import emulated

CELL = """\
flexcell: 1
cell: bench
world: {{kind: mujoco, engine_silence_s: 10.0, world_silence_s: 10.0}}
robots:
  left: {{model: ur10, gripper: {{model: robotiq_2f85, driver: {driver}}}}}
"""
MINOR_FAULT = 8


@contextmanager
def served_gripper(folder: Path) -> Generator[tuple[Dashboard, EmulatedProcess]]:
    """Serve a cell whose gripper is an emulated one, not activated yet."""
    with emulated("urcap", active=False) as emulator:
        options = {"kind": "robotiq", "connection": emulator.connection, "stale_s": 5.0, "timeout_s": 2.0}
        (folder / "cell.yaml").write_text(CELL.format(driver=json.dumps(options)), encoding="utf-8")
        with started("serve", "--cell", "cell.yaml", "--port", "0", cwd=folder) as server:
            yield dashboard_of(server, folder / ".flexcell"), emulator


def enable(page: Page, within: Locator, reason: str) -> None:
    """Enable the gripper by the button in a part of the page."""
    within.get_by_role("button", name="Enable left/gripper…").click()
    dialog = page.get_by_role("dialog", name="Enable left/gripper?")
    dialog.get_by_role("textbox", name="Reason").fill(reason)
    dialog.get_by_role("button", name="Enable", exact=True).click()
    expect(dialog).to_have_count(0)


def test_a_gripper_is_enabled_from_the_page_and_again_by_the_recovery_guide(browser: Browser, tmp_path: Path) -> None:
    with (
        served_gripper(tmp_path) as (running, emulator),
        opened_page(browser, running, "/workcell/robots/left/gripper", quiet=False) as page,
    ):
        device = page.get_by_role("table", name="Device left/gripper")
        expect(device).to_contain_text("read only, not enabled")
        expect(device).to_contain_text("readings per second")
        expect(page.get_by_role("table", name="Driver of left/gripper")).to_contain_text("Never run on hardware")
        expect(page.get_by_role("table", name="Options of robotiq")).to_contain_text("Modbus address of the gripper")
        require_accessible(page, "a real device")
        assert emulator.do("state")["active"] is False

        enable(page, page.get_by_role("region", name="Real device"), "the area is clear")
        expect(device).to_contain_text("the area is clear")
        expect(page.get_by_role("button", name="Enable left/gripper…")).to_have_count(0)
        assert emulator.do("state")["active"] is True

        emulator.do("fault", code=MINOR_FAULT)
        expect(device).to_contain_text("fault of the gripper")
        stop_button(page).click()
        expect(stop_status(page)).to_contain_text("All arms at rest")
        guide = page.get_by_role("region", name="Recovery guide")
        expect(guide).to_contain_text("left/gripper may not move: fault of the gripper")
        require_accessible(page, "the guide with a real device")
        emulator.do("fault", code=0)
        enable(page, guide, "it has cooled down")
        expect(guide).to_contain_text("left/gripper: may move")
        expect(device).to_contain_text("it has cooled down")
        expect(device).to_contain_text("Last stopped")
