"""Values of a behavior are taught on the demo cell from their fields, and a behavior is adapted, by keyboard alone."""

from __future__ import annotations

import re
from collections.abc import Generator
from typing import Any

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from engine.document import load_behavior
from engine.document.cell import load_cell
from engine.messages import Pose
from engine.skills.motion import ForwardKinematics
from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import opened_page, require_accessible, tab_to
from tests.editor_web.editing import LAPTOP, card, idle
from tests.editor_web.teach_site import TeachSite
from tests.robots.sim.demo_cell import patient_copy

PLACES_ID = "behaviors/places.yaml"
PLACES = """
flexcell: 1
name: places
cell: cells/dual_panda.yaml
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: go
    states:
      go:
        state: motion.MoveLinear
        with: {robot: left, duration_s: 2, target: {entry: left_pick}}
        transitions: {reached: turn, failed: bad}
      turn:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: left_home}}
        transitions: {reached: look, failed: bad}
      look:
        state: cell.ExpectPart
        with: {part: hca_north, region: {center_m: [-0.1, 0.3], size_m: [0.3, 0.2]}}
        transitions: {there: each, elsewhere: bad}
      each:
        foreach:
          items: [{entry: left_pick}]
          as: place
          child: {state: motion.MoveLinear, with: {robot: left, duration_s: 2, target: "${place}"}}
          next: [reached]
        transitions: {exhausted: good, broken: bad}
"""
OTHER_CELL = "flexcell: 1\ncell: other\nworld: {kind: mujoco}\nrobots: {arm: {model: panda}}\n"
FOREIGN_ID = "behaviors/foreign.yaml"
FOREIGN = PLACES.replace("name: places", "name: foreign").replace("dual_panda", "other").replace("left,", "arm,")


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    """The demo cell in physics and real time, and two behaviors."""
    project = tmp_path_factory.mktemp("wizards")
    file = patient_copy(project)
    # The arms stand still: steps as long as those of the other taught cell cost half the time.
    file.write_text(file.read_text(encoding="utf-8").replace("step_s: 0.001", "step_s: 0.002"), encoding="utf-8")
    (project / PLACES_ID).write_text(PLACES, encoding="utf-8")
    (project / FOREIGN_ID).write_text(FOREIGN, encoding="utf-8")
    file.with_name("other.yaml").write_text(OTHER_CELL, encoding="utf-8")
    with TeachSite(host=loopback, project=project, cell=load_cell(file), warm=False) as opened:
        yield opened


def press(page: Page, control: Locator) -> None:
    tab_to(page, control)
    page.keyboard.press("Enter")


def type_into(page: Page, field: Locator, text: str) -> None:
    tab_to(page, field)
    page.keyboard.press("Control+a")
    page.keyboard.type(text)


def open_wizard(page: Page, node: str, teach: str, title: str) -> Locator:
    """Select a node, go to its form, to the wand of a field, and press it."""
    card(page, f"root/{node}").focus()
    expect(page.get_by_role("button", name=f"Rename {node}", exact=True)).to_be_visible()
    page.keyboard.press("e")
    expect(page.locator("[data-inspector] :focus")).to_have_count(1)
    press(page, page.get_by_role("button", name=re.compile(teach)))
    wizard = page.get_by_role("dialog", name=title)
    expect(wizard.get_by_role("status", name="Present pose of the tool")).to_contain_text("Tool now")
    return wizard


def use(page: Page, wizard: Locator, teach: str) -> None:
    """Write the value into the document; the keyboard is again where it was."""
    press(page, wizard.get_by_role("button", name="Use this value"))
    expect(wizard).to_have_count(0)
    expect(page.get_by_role("button", name=re.compile(teach))).to_be_focused()
    idle(page)


def test_values_are_taught_from_their_fields_by_keyboard_alone(browser: Browser, site: TeachSite) -> None:
    """A pose and joints from the present ones of the arm, a pose of three points, a region, the places of a pallet."""
    with opened_page(browser, site.running, f"/edit/{PLACES_ID}", size=LAPTOP) as page:
        expect(page.locator(".react-flow[data-in-place] .react-flow__node").first).to_be_visible()
        idle(page)
        wizard = open_wizard(page, "go", "^Teach target$", "Teach target of go")
        press(page, wizard.get_by_role("button", name="Take the present pose"))
        require_accessible(page, "the wizard of a pose", part="dialog[open]")
        use(page, wizard, "^Teach target$")
        wizard = open_wizard(page, "turn", "^Teach target$", "Teach target of turn")
        press(page, wizard.get_by_role("button", name="Take the present joints"))
        require_accessible(page, "the wizard of joints", part="dialog[open]")
        require_unique_names(page, "the wizard of joints")
        use(page, wizard, "^Teach target$")
        wizard = open_wizard(page, "look", "^Teach region$", "Teach region of look")
        for corner in ("First corner", "Second corner"):
            press(page, wizard.get_by_role("button", name=f"Take: {corner}"))
        expect(wizard).to_contain_text("the region has no area")
        type_into(page, wizard.get_by_role("textbox", name="Size x"), "0.2")
        type_into(page, wizard.get_by_role("textbox", name="Size y"), "0.1")
        require_accessible(page, "the wizard of a region", part="dialog[open]")
        require_unique_names(page, "the wizard of a region")
        use(page, wizard, "^Teach region$")
        wizard = open_wizard(page, "each", "^Teach .* as a grid of poses$", "Teach items of each")
        type_into(page, wizard.get_by_role("textbox", name="Rows"), "1")
        press(page, wizard.get_by_role("button", name="Take: First place"))
        press(page, wizard.get_by_role("button", name="Take: End of the row"))
        type_into(page, wizard.get_by_role("textbox", name="End of the row x"), "0.5")
        expect(wizard.get_by_role("group", name="Places")).to_contain_text("3: 0.5000")
        require_accessible(page, "the wizard of a pallet", part="dialog[open]")
        require_unique_names(page, "the wizard of a pallet")
        use(page, wizard, "^Teach .* as a grid of poses$")
        page.keyboard.press("Control+s")
        expect(page.locator("[data-unsaved]")).to_have_count(0)
    now = site.call(site.bus.call(ForwardKinematics(), to="left"))
    require_taught(load_behavior(site.project / PLACES_ID).root.children, now, site.joints().position_rad)


def require_taught(states: Any, now: Pose, joints: tuple[float, ...]) -> None:
    """The document has what the arm measured; it has stood still."""
    x, y, z = now.xyz
    assert states["go"].parameters["target"]["xyz"] == pytest.approx([x, y, z], abs=1e-3)
    assert states["go"].parameters["target"]["xyzw"] == pytest.approx(list(now.xyzw), abs=1e-3)
    assert states["turn"].parameters["target"] == pytest.approx(list(joints), abs=1e-3)
    region = states["look"].parameters["region"]
    assert region["size_m"] == [0.2, 0.1]
    assert region["center_m"] == pytest.approx([x, y], abs=1e-3)
    places = states["each"].foreach.items
    expected = [[x, y, z], [(x + 0.5) / 2, y, z], [0.5, y, z]]
    assert [place["xyz"] for place in places] == [pytest.approx(each, abs=1e-3) for each in expected]


def test_a_pose_is_made_of_three_points_by_keyboard_alone(browser: Browser, site: TeachSite) -> None:
    """Points on one line are refused with the reason; Escape leaves the document as it was."""
    with opened_page(browser, site.running, f"/edit/{PLACES_ID}", size=LAPTOP) as page:
        expect(page.locator(".react-flow[data-in-place] .react-flow__node").first).to_be_visible()
        idle(page)
        wizard = open_wizard(page, "go", "^Teach target$", "Teach target of go")
        tab_to(page, wizard.get_by_role("radio", name="In place"))
        page.keyboard.press("ArrowRight")
        for point in ("Origin", "Point on x", "Point on y"):
            press(page, wizard.get_by_role("button", name=f"Take: {point}"))
        expect(wizard.get_by_role("alert")).to_be_visible()
        require_accessible(page, "the wizard of three points", part="dialog[open]")
        require_unique_names(page, "the wizard of three points")
        page.keyboard.press("Escape")
        expect(wizard).to_have_count(0)
        expect(page.get_by_role("button", name="Teach target", exact=True)).to_be_focused()
        expect(page.locator("[data-unsaved]")).to_have_count(0)


def test_a_behavior_of_another_cell_is_adapted_by_keyboard_alone(browser: Browser, site: TeachSite) -> None:
    """What each name becomes, what stays open; the copy opens in the editor."""
    with opened_page(browser, site.running, f"/behaviors/{FOREIGN_ID}", size=LAPTOP) as page:
        adapt = page.get_by_role("button", name="Adapt…")
        tab_to(page, adapt)
        page.keyboard.press("Enter")
        dialog = page.get_by_role("dialog", name="Adapt to this cell")
        expect(dialog.get_by_role("combobox", name="robot arm becomes")).to_be_visible()
        require_accessible(page, "a behavior is adapted", part="dialog[open]")
        require_unique_names(page, "a behavior is adapted")
        tab_to(page, dialog.get_by_role("combobox", name="robot arm becomes"))
        page.keyboard.press("ArrowDown")
        expect(dialog.get_by_role("option", name="right")).to_be_visible()
        require_accessible(page, "a name is selected", part="dialog[open]")
        page.keyboard.press("Escape")
        expect(dialog.get_by_role("option")).to_have_count(0)
        press(page, dialog.get_by_role("button", name="Create and open"))
        expect(page.locator("[data-editor-head]")).to_contain_text("foreign_dual_panda")
    made = load_behavior(site.project / "behaviors" / "foreign_dual_panda.yaml")
    assert made.root.children["go"].parameters["robot"] in {"left", "right"}
