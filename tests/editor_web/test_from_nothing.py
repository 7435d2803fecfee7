"""The transfer by two arms is built from nothing by mouse and keyboard, checked, run, paused, and looked at again.

A real `flexcell serve` with the cell of two Pandas in physics, in real time, and a real browser.
"""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from engine.document import load_behavior
from tests.editor_web.browsing import opened_page
from tests.editor_web.editing import card, idle
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.real_server import dashboard_of
from tests.engine.cli.process import started
from tests.robots.sim.demo_cell import patient_copy

MADE = "behaviors/my_transfer.yaml"

Steps = tuple[tuple[str, str, dict[str, str]], ...]


def steps_of(arm: str, part: str) -> Steps:
    """Name, state and fields of what an arm does, one after the other."""
    joints, line = {"robot": arm, "speed": "${speed}"}, {"robot": arm, "speed_m_s": "${line_speed_m_s}"}
    hand = {"gripper": arm}
    up = {"offset_m x": "0", "offset_m y": "0", "offset_m z": "0.15"}
    return (
        ("open", "gripper.Open", hand),
        ("above_pick", "motion.MoveJoints", {**joints, "target": f"{arm}_above_pick"}),
        ("approach", "motion.MoveLinear", {**line, "target": f"{arm}_pick"}),
        ("grasp", "gripper.Grasp", {**hand, "part": part, "width_m": "0.03", "force_n": "30"}),
        ("lift", "motion.MoveLinear", {**line, "target": f"{arm}_pick", **up}),
        ("carry", "motion.MoveJoints", {**joints, "target": f"{arm}_carry"}),
        ("above_place", "motion.MoveJoints", {**joints, "target": f"{arm}_above_place"}),
        ("check_carried", "gripper.CheckHeld", {**hand, "part": part}),
        ("put_down", "motion.MoveLinear", {**line, "target": f"{arm}_place"}),
        ("release", "gripper.Open", {**hand, "part": part}),
        ("retreat", "motion.MoveLinear", {**line, "target": f"{arm}_place", **up}),
        ("home", "motion.MoveJoints", {**joints, "target": f"{arm}_home"}),
    )


def choose(page: Page, path: str) -> None:
    """By its heading, where nothing lies upon it, once all of it is in sight."""
    page.get_by_role("button", name="Show all (F)").click()
    idle(page)
    card(page, path).locator("[data-name]").first.click()
    expect(card(page, path).locator("[data-card]").first).to_have_attribute("data-selected", "true")


def add(page: Page, what: str, made: str, name: str) -> None:
    """What is chosen decides where it goes; then it is given its name."""
    page.keyboard.press("a")
    page.keyboard.type(what)
    page.keyboard.press("Enter")
    expect(card(page, made)).to_be_focused()
    page.keyboard.press("F2")
    page.keyboard.type(name)
    page.keyboard.press("Enter")
    expect(card(page, f"{made.rpartition('/')[0]}/{name}").locator("[data-card]").first).to_have_attribute(
        "data-selected", "true"
    )
    idle(page)


def fill(page: Page, fields: dict[str, str]) -> None:
    """In the form of the chosen state."""
    for name, value in fields.items():
        if value.startswith("${"):
            page.get_by_role("button", name=f"Write {name} as an expression").click()
        field = page.get_by_role("combobox", name=name, exact=True)
        field.fill(value)
        field.press("Tab")
        idle(page)


def lead(page: Page, outcome: str, target: str) -> None:
    """By the table of the form, where the target is offered; a new outcome of the container by the keyboard."""
    choice = page.get_by_role("combobox", name=f"{outcome} leads to")
    if target in choice.locator("option").all_inner_texts():
        choice.select_option(target)
    else:
        page.keyboard.press("c")
        page.keyboard.type(outcome)
        page.keyboard.press("Enter")
        expect(page.get_by_placeholder("Which outcome …")).to_have_count(0)
        page.keyboard.type(target)
        page.keyboard.press("Enter")
    idle(page)


def build_arm(page: Page, arm: str, part: str) -> None:
    """A machine inside of the concurrency container, one state after the other."""
    choose(page, "root/transfer")
    inside = f"root/transfer/{arm}"
    add(page, "State machine", "root/transfer/machine", arm)
    steps = steps_of(arm, part)
    for k, (name, state, fields) in enumerate(steps):
        made = state.rpartition(".")[2]
        snake = "".join(f"_{letter.lower()}" if letter.isupper() else letter for letter in made).lstrip("_")
        taken = snake in (before for before, _, _ in steps[:k])
        add(page, state, f"{inside}/{snake}{'_2' if taken else ''}", name)
        fill(page, fields)
        if k + 1 == len(steps):
            lead(page, "reached", "placed")
        for outcome in ("missed", "lost", "failed"):
            if page.get_by_role("combobox", name=f"{outcome} leads to").count():
                lead(page, outcome, "failed")


def declare(page: Page) -> None:
    """The cell and the parameters of the behavior."""
    page.get_by_role("tab", name="Behavior").click()
    page.get_by_role("combobox", name="Cell").fill("cells/dual_panda.yaml")
    page.keyboard.press("Tab")
    idle(page)
    # Slow: without a graphics card the 3D view leaves the page three frames a second, and a click takes some of them.
    for name, default in (("speed", "0.1"), ("line_speed_m_s", "0.05")):
        page.get_by_role("textbox", name="New parameter").fill(name)
        page.keyboard.press("Enter")
        page.get_by_role("combobox", name=f"Default of {name}").fill(default)
        page.keyboard.press("Tab")
        idle(page)
    page.get_by_role("combobox", name="Unit of line_speed_m_s").fill("m/s")
    page.keyboard.press("Tab")
    idle(page)


def rules(page: Page) -> None:
    """Both placed; or one of them failed."""
    choose(page, "root/transfer")
    wanted = (
        ("placed", {"left": "placed", "right": "placed"}),
        ("failed", {"left": "failed"}),
        ("failed", {"right": "failed"}),
    )
    for k, (outcome, when) in enumerate(wanted, start=1):
        page.get_by_role("button", name="Add a rule").click()
        expect(page.get_by_role("combobox", name=f"Outcome of rule {k}")).to_be_visible()
        idle(page)
        for arm in ("left", "right"):
            page.get_by_role("combobox", name=f"{arm} in rule {k}").select_option(when.get(arm, ""))
            idle(page)
        page.get_by_role("combobox", name=f"Outcome of rule {k}").fill(outcome)
        page.keyboard.press("Tab")
        idle(page)


def expect_parts(page: Page) -> None:
    """Where the parts must lie in the end."""
    for name, part, x, y, ends in (
        ("expect_north_part", "hca_north", "-0.09", "-0.28", ""),
        ("expect_south_part", "hca_south", "0.09", "0.28", "finished"),
    ):
        add(page, "cell.ExpectPart", "root/expect_part", name)
        region = f"{{center_m: [{x}, {y}], size_m: [0.17, 0.2], height_m: [0.015, 0.04]}}"
        fill(page, {"part": part, "region": region})
        lead(page, "elsewhere", "failed")
        if ends:
            lead(page, "there", ends)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A folder with the cell and its entries, and no behavior."""
    patient_copy(tmp_path)
    return tmp_path


# Some hundred edits, one after the other, and two arms in real time: minutes. Shorter tests edit and run too.
@pytest.mark.nightly
@pytest.mark.timeout(600)
def test_the_transfer_with_two_arms_is_built_from_nothing_checked_run_paused_and_looked_at(
    browser: Browser, project: Path, loopback: str
) -> None:
    """Twenty-six states; the parts then lie where they were to be put."""
    cell = ("--cell", "behaviors/cells/dual_panda.yaml")
    with (
        started("serve", "--host", loopback, "--port", "0", *cell, cwd=project) as process,
        opened_page(browser, dashboard_of(process, project / ".flexcell"), "/", size=(1600, 1000)) as page,
    ):
        page.set_default_timeout(60_000)
        page.get_by_role("button", name="New", exact=True).click()
        page.get_by_label("Name", exact=True).fill("my_transfer")
        page.get_by_role("button", name="Create").click()
        expect(page.get_by_role("tab", name="Behavior")).to_be_visible(timeout=GUARD_MS)
        declare(page)
        page.locator("[data-canvas]").click(position={"x": 30, "y": 500})
        add(page, "Concurrency", "root/concurrency", "transfer")
        build_arm(page, "left", "hca_north")
        build_arm(page, "right", "hca_south")
        rules(page)
        page.locator("[data-canvas]").click(position={"x": 8, "y": 120})
        expect_parts(page)
        choose(page, "root/transfer")
        lead(page, "placed", "expect_north_part")
        lead(page, "failed", "failed")
        expect(page.locator("[data-problem-count]")).to_have_text("No problems", timeout=GUARD_MS)
        page.get_by_role("button", name="Run", exact=True).click()
        expect(page.get_by_role("button", name="Start", exact=True)).to_be_visible()
        behavior = load_behavior(project / MADE)
        assert len(behavior.root.children) == 3
        run(page)


def node(page: Page, path: str) -> Locator:
    """A node of the graph of the run."""
    return page.locator(f".react-flow__node[data-id='{path}'] [data-node]").first


def run(page: Page) -> None:
    """Start, pause, go on, to the end; then back in time; then once more, stopped."""
    page.get_by_role("button", name="Start", exact=True).click()
    expect(node(page, "root/transfer")).to_have_attribute("data-status", "active")
    page.get_by_role("button", name="Take control", exact=True).click()
    page.get_by_role("button", name="Pause", exact=True).click()
    state = page.get_by_role("status", name="State of the run")
    expect(state).to_contain_text("Paused")
    page.get_by_role("button", name="Resume", exact=True).click()
    expect(state).to_have_text("Succeeded", timeout=5 * GUARD_MS)
    expect(node(page, "root/transfer")).to_have_attribute("data-status", "done")
    page.get_by_text("Debug", exact=True).click()
    page.get_by_role("tab", name="Timeline").click()
    moment = page.get_by_role("slider", name="Moment of the run")
    box = moment.bounding_box()
    assert box is not None
    moment.click(position={"x": 0.5 * box["width"], "y": 8})
    expect(node(page, "root/transfer")).to_have_attribute("data-status", "active")
    page.get_by_role("button", name="Back to live").click()
    expect(node(page, "root/transfer")).to_have_attribute("data-status", "done")
    page.get_by_role("button", name="Start", exact=True).click()
    expect(node(page, "root/transfer")).to_have_attribute("data-status", "active")
    page.get_by_role("button", name="Stop this run").click()
    expect(state).to_have_text("Stopped", timeout=GUARD_MS)
