"""The page on which arms are taught, in a real browser with an arm in physics."""

from __future__ import annotations

import re
from collections.abc import Generator

import numpy as np
import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from engine.messages.primitives import JointDmp
from engine.skills.entries import ReadEntry
from engine.skills.jogging import JogCommand
from engine.skills.teaching import Callback, Trigger, TriggerType
from engine.store.entry_kinds import Joints, decode_entry
from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import PHONE, Scheme, require_accessible, require_fit, switch, until
from tests.editor_web.teach_page import tab, teaching
from tests.editor_web.teach_site import RESTS_RAD_S, TeachSite, fastest

TABS = ("Move", "Captures", "Entries", "Triggers", "Buttons")
BEHAVIOR = "behaviors/go_round.yaml"
GO_ROUND = """
flexcell: 1
name: go_round
cell: cells/taught.yaml
outcomes: [done, lost]
success: [done]
root:
  machine:
    initial: there
    states:
      there:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: there}, speed: 0.9}
        transitions: {reached: sweep, failed: lost}
      sweep:
        state: motion.FollowJointDmp
        with: {robot: left, dmp: {entry: sweep}, approach_speed: 0.5}
        transitions: {reached: here, failed: lost}
      here:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: here}, speed: 0.9}
        transitions: {reached: done, failed: lost}
"""


def trigger(button: str, callback: Callback, kind: TriggerType = "rising_edge") -> Trigger:
    return Trigger(
        trig_name=f"{button} {callback}",
        robot_ns="left",
        trig_topic=f"/buttons/keyboard/{button}",
        trig_type=kind,
        trig_callback=callback,
    )


TRIGGERS = (trigger("previous", "joint_save"), trigger("next", "joint_dmp_save", "hold"))


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    """An arm in physics, in real time, with two triggers."""
    project = tmp_path_factory.mktemp("taught")
    (project / "behaviors").mkdir()
    (project / BEHAVIOR).write_text(GO_ROUND, encoding="utf-8")
    with TeachSite(host=loopback, project=project, triggers=TRIGGERS) as opened:
        yield opened


def entry_joints(site: TeachSite, name: str) -> tuple[float, ...]:
    record = site.call(site.bus.call(ReadEntry(kind="joints", name=name), to="store"))
    return decode_entry(record, Joints).joints


def save(page: Page, capture: int, name: str) -> Locator:
    """Choose a capture and type a name for it."""
    panel = tab(page, "Captures")
    panel.get_by_role("list", name="Captures").get_by_role("button", name=re.compile(f"^{capture} ")).click()
    form = panel.get_by_role("form", name=f"Save capture {capture}")
    form.get_by_label("Name").fill(name)
    return form


def saved(form: Locator, button: str = "Save") -> None:
    form.get_by_role("button", name=button, exact=True).click()
    expect(form.get_by_role("status", name="Saving")).to_contain_text("Saved as")


def shown_deg(joint: Locator) -> float:
    """The angle that the page shows for a joint, in degrees."""
    angle = re.search(r"(-?[0-9.]+)°", joint.inner_text())
    assert angle is not None
    return float(angle[1])


def run_round(site: TeachSite) -> None:
    """Run the behavior to its end."""

    async def ended() -> str:
        run = await site.session.start(BEHAVIOR, parameters={}, seed=1)
        while site.session.run(run).status == "running":
            await site.bus.clock.sleep(0.05)
        found = site.session.run(run)
        return found.outcome or found.cause

    assert site.call(ended()) == "done"


def test_poses_and_a_motion_are_taught_by_buttons_and_move_a_behavior(browser: Browser, site: TeachSite) -> None:
    """Two configurations and a motion led by hand; overwriting one changes where the next run ends."""
    site.call(site.go_home())
    with teaching(browser, site) as page:
        switch(tab(page, "Buttons").get_by_role("switch"))
        page.keyboard.press("ArrowLeft")
        said = page.get_by_role("status", name="Messages of the Helping Hand")
        expect(said).to_have_text(re.compile("capture [0-9]+ of left: joints"))
        first = int(said.inner_text().split()[1])
        move = tab(page, "Move")
        move.get_by_text("Step", exact=True).click()
        move.get_by_text("50 mm", exact=True).click()
        move.get_by_role("slider", name="Speed", exact=True).press("End")
        before = np.array(site.joints().position_rad)
        move.get_by_role("button", name="Z minus", exact=True).click()
        site.call(site.moved(before, by_rad=0.03))
        site.call(site.rested())
        expect(move.get_by_role("button", name="Stop (Escape)")).to_have_count(0)
        page.keyboard.press("ArrowLeft")
        expect(said).to_have_text(f"capture {first + 1} of left: joints")
        move.get_by_role("button", name="Float").click()
        expect(move.get_by_role("button", name="Hold position")).to_be_visible()
        page.keyboard.down("ArrowRight")
        expect(said).to_have_text("left is being recorded")
        began = np.array(site.joints().position_rad)
        move.get_by_role("button", name="Push left").hover()
        page.mouse.down()
        site.call(site.moved(began, by_rad=0.15))
        page.mouse.up()
        site.call(site.rested())
        page.keyboard.up("ArrowRight")
        expect(said).to_have_text(f"capture {first + 2} of left: dmp")
        move.get_by_role("button", name="Hold position").click()
        expect(move.get_by_role("button", name="Float")).to_be_visible()
        for nth, name in enumerate(("here", "there", "sweep")):
            saved(save(page, first + nth, name))
        here, there = entry_joints(site, "here"), entry_joints(site, "there")
        assert np.abs(np.subtract(here, there)).max() > 0.03
        sweep = decode_entry(site.call(site.bus.call(ReadEntry(kind="dmp", name="sweep"), to="store")), JointDmp)
        assert np.abs(np.subtract(sweep.start, sweep.goal)).max() > 0.1
        run_round(site)
        assert np.allclose(site.joints().position_rad, here, atol=0.01)
        form = save(page, first + 1, "here")
        expect(form.get_by_role("status", name="Effect of overwriting")).to_contain_text("the tool moves by 50")
        saved(form, "Overwrite")
        run_round(site)
        assert np.allclose(site.joints().position_rad, there, atol=0.01)
        entries = tab(page, "Entries")
        entries.get_by_label("Search").fill("he")
        expect(entries.get_by_role("list", name="Entries").get_by_role("button")).to_have_count(1)
        entries.get_by_role("button", name="joints here").click()
        expect(entries.get_by_role("list", name="History of here").get_by_role("listitem")).to_have_count(2)
        entries.get_by_role("button", name="Undo").click()
        expect(entries.get_by_role("list", name="History of here").get_by_role("listitem")).to_have_count(3)
    assert entry_joints(site, "here") == here


def test_an_arm_rests_when_its_page_dies_while_it_jogs(browser: Browser, site: TeachSite) -> None:
    """In less than 0.3 s after the last word of the page, of the time of the simulated world."""
    site.call(site.go_home())
    with teaching(browser, site) as page:
        told_s = site.call(site.hear_jogs())
        page.get_by_role("button", name="Z minus", exact=True).hover()
        page.mouse.down()
        site.call(site.seen(lambda state: fastest(state) > 0.05))
        expect(page.get_by_role("status", name="State of left").first).to_have_text("jogging")
        page.close()
        moving = site.call(site.last_moving())
        assert moving.time_s - told_s[-1] < 0.3
        site.call(site.let_go())


@pytest.mark.parametrize("leave", ["blur", "pointerup", "visibilitychange"])
def test_leaving_the_page_lets_go_of_a_jog(browser: Browser, site: TeachSite, leave: str) -> None:
    with teaching(browser, site) as page:
        told_s = site.call(site.hear_jogs())
        page.get_by_role("button", name="Z plus", exact=True).focus()
        page.keyboard.down("Enter")
        site.call(site.seen(lambda state: fastest(state) > 0.05))
        if leave == "visibilitychange":
            page.evaluate("Object.defineProperty(document, 'hidden', {value: true})")
            page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
        else:
            page.evaluate(f"dispatchEvent(new Event('{leave}'))")
        moving = site.call(site.last_moving())
        assert moving.time_s - told_s[-1] < 0.3
        expect(page.get_by_role("status", name="State of left").first).to_have_text("idle")


def test_an_arm_is_jogged_by_joints_with_the_keyboard(browser: Browser, site: TeachSite) -> None:
    """As long as the digit is down; what floats is not jogged, and the page says why."""
    site.call(site.go_home())
    with teaching(browser, site) as page:
        move = page.get_by_role("tabpanel", name="Move")
        move.get_by_text("Joints", exact=True).click()
        before = site.joints().position_rad
        move.get_by_role("button", name="Jog with the keyboard").focus()
        page.keyboard.down("7")
        site.call(site.seen(lambda state: state.position_rad[6] > before[6] + 0.05))
        page.keyboard.up("7")
        after = site.call(site.rested()).position_rad
        assert np.allclose(after[:6], before[:6], atol=5e-3)
        shown = move.get_by_role("list", name="Joints").get_by_role("listitem").last
        # The page hears of no changes below 1e-4 rad, and rounds to a tenth of a degree.
        until(page, lambda: abs(shown_deg(shown) - np.degrees(site.joints().position_rad[6])) < 0.06)
        move.get_by_role("button", name="Float").click()
        expect(move.get_by_role("status", name="State of jogging")).to_have_text("it floats: let it hold itself first")
        move.get_by_role("button", name="Hold position").click()
        expect(move.get_by_role("button", name="Float")).to_be_visible()


def test_an_entry_is_played_back_only_after_a_yes_and_escape_stops_it(browser: Browser, site: TeachSite) -> None:
    site.call(site.go_home())
    site.call(site.write_joints("aside", (1.2, -0.785, 0.0, -2.356, 0.0, 1.571, 0.785), tags=("station_1",)))
    with teaching(browser, site, quiet=False) as page:
        entries = tab(page, "Entries")
        entries.get_by_label("Search").fill("station")
        entries.get_by_role("button", name="joints aside station_1").click()
        entries.get_by_role("button", name="Play back slowly").click()
        expect(entries.get_by_role("group", name="Play back")).to_contain_text("left will move")
        before = np.array(site.joints().position_rad)
        entries.get_by_role("button", name="Move the arm").click()
        site.call(site.moved(before, by_rad=0.02))
        page.keyboard.press("Escape")
        expect(entries.get_by_role("status", name="Play-back")).to_have_text("Stopped")
        rested = site.call(site.rested())
        # The page may take a while for the key.
        assert rested.position_rad[0] < 1.1
        entries.get_by_role("button", name="Play back slowly").click()
        entries.get_by_label("Speed of the play-back").select_option("50")
        entries.get_by_role("button", name="Move the arm").click()
        expect(entries.get_by_role("status", name="Play-back")).to_contain_text("has gone along")
        assert abs(site.joints().position_rad[0] - 1.2) < 0.01
        entries.get_by_role("button", name="Delete").click()
        expect(entries.get_by_text("Nothing is found")).to_be_visible()


def test_triggers_are_edited_as_a_table_and_as_yaml(browser: Browser, site: TeachSite) -> None:
    """Kept in the file; a mistake is refused with its line, and a button that is pressed lights up."""
    file = site.project / "triggers.yaml"
    with teaching(browser, site, quiet=False) as page:
        panel = tab(page, "Triggers")
        panel.get_by_role("button", name="Add a trigger").click()
        form = panel.get_by_role("form", name="Trigger")
        form.get_by_label("Name").fill("Pose")
        form.get_by_label("Topic").fill("buttons/keyboard/play_pause")
        form.get_by_label("Callback").select_option("pose_save")
        form.get_by_role("button", name="Keep the trigger").click()
        row = panel.get_by_role("row", name=re.compile("Pose"))
        expect(row).to_contain_text("captures the pose")
        assert '- trig_name: "Pose"' in file.read_text(encoding="utf-8")
        switch(tab(page, "Buttons").get_by_role("switch"))
        tab(page, "Triggers")
        page.keyboard.down("Space")
        expect(row.get_by_role("img", name="pressed", exact=True)).to_be_visible()
        page.keyboard.up("Space")
        expect(row.get_by_role("img", name="not pressed")).to_be_visible()
        expect(page.get_by_role("status", name="Messages of the Helping Hand")).to_contain_text("of left: pose")
        panel.get_by_text("YAML", exact=True).click()
        text = panel.get_by_role("textbox")
        expect(text).to_have_value(file.read_text(encoding="utf-8"))
        good = text.input_value()
        text.fill(good.replace('"pose_save"', '"pose"'))
        panel.get_by_role("button", name="Save the YAML").click()
        line = good[: good.index('"pose_save"')].count("\n") + 1
        expect(panel.get_by_role("alert")).to_contain_text(f"Line {line}, column 20: `trig_callback`")
        assert file.read_text(encoding="utf-8") == good
        text.fill("# By hand.\n" + good)
        panel.get_by_role("button", name="Save the YAML").click()
        expect(panel.get_by_role("status", name="Saving the triggers")).to_have_text("Saved, and in force.")
        panel.get_by_text("Table", exact=True).click()
        panel.get_by_role("button", name="Remove Pose").click()
        expect(row).to_have_count(0)
    assert file.read_text(encoding="utf-8").startswith("# By hand.\n")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_tab_is_accessible(browser: Browser, site: TeachSite, scheme: Scheme) -> None:
    """In both themes."""
    with teaching(browser, site, scheme=scheme) as page:
        for name in TABS:
            tab(page, name)
            if name == "Triggers":
                page.get_by_role("button", name="Add a trigger").click()
            if name == "Captures":
                page.get_by_role("button", name="Pose", exact=True).click()
                expect(page.get_by_role("form", name=re.compile("Save capture"))).to_be_visible()
            require_accessible(page, f"{name}, {scheme}")
            require_unique_names(page, name)


def test_a_phone_shows_everything_without_scrolling_sideways(browser: Browser, site: TeachSite) -> None:
    with teaching(browser, site, size=PHONE) as page:
        for name in TABS:
            tab(page, name)
            require_fit(page, PHONE[0])


def test_jog_commands_stay_within_what_the_slider_says(browser: Browser, site: TeachSite) -> None:
    with teaching(browser, site) as page:
        told: list[JogCommand] = []
        site.on_loop(lambda: site.bus.topic("left/jog", JogCommand).subscribe(told.append))
        tab(page, "Move").get_by_role("slider", name="Speed", exact=True).press("Home")
        page.get_by_role("button", name="Y plus", exact=True).focus()
        page.keyboard.down("Enter")
        site.call(site.seen(lambda _: len(told) > 4))
        page.keyboard.up("Enter")
        site.call(site.rested())
    # The release is a command too: the goal stays open for the next press.
    moving = (0.0, 0.0025, 0.0, 0.0, 0.0, 0.0)
    assert {tuple(each.velocity) for each in told} == {moving, (0.0,) * 6}
    assert fastest(site.joints()) < RESTS_RAD_S
