"""Entries on the page for teaching: their tags, what they were, and several beside each other; frames are captured."""

from __future__ import annotations

import re
from collections.abc import Generator
from typing import Any

import msgspec
import numpy as np
import pytest
from playwright.sync_api import Browser, expect

from engine.messages import Pose
from engine.messages.demonstrations import Trajectory
from engine.skills.dmp import LearnJointDmp
from engine.skills.entries import ReadEntry, ReadHistory, WriteEntry
from engine.skills.motion import ForwardKinematics
from engine.store.entry_kinds import Joints, decode_entry
from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import Scheme, require_accessible, tab_to
from tests.editor_web.teach_page import tab, teaching
from tests.editor_web.teach_site import TeachSite
from tests.robots.panda_arm import home

TIMES = np.linspace(0.0, 1.0, 101)
HOME = tuple(home().tolist())
TURNED = (0.3, *HOME[1:])


def led(by_rad: float) -> Trajectory:
    """The first joint goes so far and stops there."""
    rows = home() + np.outer(0.5 - 0.5 * np.cos(np.pi * TIMES), (by_rad, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    return Trajectory(times_s=tuple(TIMES.tolist()), joints=tuple(map(tuple, rows.tolist())))


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    """With a configuration that was changed, a recording, a primitive, and a record."""
    with TeachSite(host=loopback, project=tmp_path_factory.mktemp("taught")) as opened:
        learned = opened.call(opened.bus.call(LearnJointDmp(trajectory=led(0.2)), to="left"))
        written: tuple[tuple[str, str, dict[str, Any]], ...] = (
            ("joints", "above", {"joints": HOME}),
            ("joints", "above", {"joints": TURNED}),
            ("joints", "aside", {"joints": HOME}),
            ("trajectory", "long", msgspec.to_builtins(led(0.5))),
            ("dmp", "short", msgspec.to_builtins(learned.dmp)),
            ("record", "note", {"text": "before"}),
            ("record", "note", {"text": "after"}),
        )
        for kind, name, value in written:
            entry = WriteEntry(kind=kind, name=name, value=value, tags=("station_1",), by="ana")
            opened.call(opened.bus.call(entry, to="store"))
        yield opened


def test_tags_are_changed_and_the_value_stays(browser: Browser, site: TeachSite) -> None:
    """By whom is in the history; somebody else's change meanwhile is not overwritten."""
    with teaching(browser, site, quiet=False) as page:
        entries = tab(page, "Entries")
        entries.get_by_role("button", name="joints aside station_1").click()
        tags = entries.get_by_role("form", name="Tags of aside")
        keep = tags.get_by_role("button", name="Save tags")
        expect(keep).to_have_attribute("aria-disabled", "true")
        tags.get_by_label("Tags").fill("Above")
        expect(tags.get_by_text(re.compile("has only a–z"))).to_be_visible()
        tags.get_by_label("Tags").fill("tested, station_2")
        keep.click()
        expect(entries.get_by_role("button", name="joints aside station_2 tested")).to_be_visible()
        expect(entries.get_by_role("list", name="History of aside").get_by_role("listitem")).to_have_count(2)
        record = site.call(site.bus.call(ReadEntry(kind="joints", name="aside"), to="store"))
        assert decode_entry(record, Joints).joints == HOME
        last = site.call(site.bus.call(ReadHistory(kind="joints", name="aside"), to="store")).changes[-1]
        assert (last.by, last.reason, last.tags) == ("the dashboard", "other tags", ("station_2", "tested"))


def test_what_an_entry_was_is_seen_before_it_is_undone(browser: Browser, site: TeachSite) -> None:
    """Its joints and what bringing it back would change; of what has no place, its value."""
    with teaching(browser, site) as page:
        entries = tab(page, "Entries")
        entries.get_by_role("button", name="joints above station_1").click()
        entries.get_by_role("button", name=re.compile("^1 made by ana")).click()
        was = entries.get_by_role("group", name="Revision 1 of above")
        expect(was).to_contain_text("Joints0.0°  -45.0°")
        expect(was).to_contain_text("joint 1 ends 17.2° away")
        was.get_by_role("button", name="Show this one in the cell").click()
        expect(entries.get_by_role("alert")).to_have_count(0)
        entries.get_by_role("button", name="record note station_1").click()
        entries.get_by_role("button", name=re.compile("^1 made by ana")).click()
        expect(entries.get_by_role("group", name="Revision 1 of note")).to_contain_text('"text": "before"')


def test_a_pose_is_captured_and_saved_by_keyboard_alone(browser: Browser, site: TeachSite) -> None:
    # A capture may be asked for before it is there; the server says so in the console.
    with teaching(browser, site, quiet=False) as page:
        tab_to(page, page.get_by_role("group", name="Capture").get_by_role("button", name="Pose"))
        page.keyboard.press("Enter")
        tab_to(page, page.get_by_role("tab", name="Move"))
        page.keyboard.press("ArrowRight")
        form = page.get_by_role("form", name=re.compile("^Save capture"))
        tab_to(page, form.get_by_label("Name"))
        page.keyboard.type("taught_by_keys")
        tab_to(page, form.get_by_role("button", name="Save", exact=True))
        page.keyboard.press("Enter")
        expect(form.get_by_role("status", name="Saving")).to_have_text("Saved as pose taught_by_keys.")
    record = site.call(site.bus.call(ReadEntry(kind="pose", name="taught_by_keys"), to="store"))
    now = site.call(site.bus.call(ForwardKinematics(), to="left"))
    assert decode_entry(record, Pose).xyz == pytest.approx(now.xyz, abs=1e-3)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_entries_are_compared_side_by_side(browser: Browser, site: TeachSite, scheme: Scheme) -> None:
    """Motions over time, places by how far they are apart, all of them together in the cell."""
    with teaching(browser, site, scheme=scheme) as page:
        entries = tab(page, "Entries")
        for name in ("trajectory long", "dmp short", "joints above"):
            entries.get_by_role("checkbox", name=f"Compare {name}").check()
        expect(entries.get_by_role("checkbox", name="Compare record note")).to_be_disabled()
        side = entries.get_by_role("region", name="Comparison")
        expect(side.get_by_role("img", name="2 curves, Tool x over time")).to_be_visible()
        side.get_by_label("Show over time").select_option("Joint 1")
        expect(side.get_by_role("img", name="2 curves, Joint 1 over time")).to_be_visible()
        expect(side.get_by_role("list", name="Against short")).to_contain_text("joint 1 ends")
        side.get_by_role("button", name="Show all in the cell").click()
        entries.get_by_role("button", name="joints above station_1").click()
        entries.get_by_role("button", name=re.compile("^1 made by ana")).click()
        expect(entries.get_by_role("group", name="Revision 1 of above")).to_contain_text("-45.0°")
        require_accessible(page, f"compared, {scheme}")
        require_unique_names(page, "entries compared")


def test_a_primitive_is_measured_against_its_demonstration_in_the_joints_and_at_the_tool(
    browser: Browser, site: TeachSite
) -> None:
    """As soon as it is recorded."""
    site.call(site.go_home())
    # A capture may be asked for before it is there; the server says so in the console.
    with teaching(browser, site, quiet=False) as page:
        page.get_by_role("button", name="Record", exact=True).click()
        expect(page.get_by_role("status", name="Messages of the Helping Hand")).to_have_text("left is being recorded")
        site.call(site.turn(0.3))
        page.get_by_role("button", name="End recording").click()
        captures = tab(page, "Captures")
        table = captures.get_by_role("table", name="Learned against shown")
        cells = table.get_by_role("row").nth(1).get_by_role("cell")
        expect(cells.nth(1)).to_have_text(re.compile(r"^0\.\d+° RMS, 0\.\d+° at most$"))
        expect(cells.nth(2)).to_have_text(re.compile(r"^[01]\.\d\d mm RMS, \d\.\d\d mm at most$"))


def test_a_frame_is_captured_as_seen_from_another(browser: Browser, site: TeachSite) -> None:
    """The details tell it as it is, though no arm goes to a pose in that frame."""
    with teaching(browser, site, quiet=False) as page:
        page.get_by_role("button", name="Frame", exact=True).click()
        asked = page.get_by_role("dialog", name="Frame")
        asked.get_by_label("Where is").select_option("left/panda_hand_tcp")
        asked.get_by_label("Seen from").select_option("left/panda_hand")
        require_accessible(page, "a frame is chosen")
        asked.get_by_role("button", name="Capture the frame").click()
        expect(page.get_by_role("status", name="Messages of the Helping Hand")).to_have_text(
            re.compile("of left: pose")
        )
        captures = tab(page, "Captures")
        expect(captures.get_by_text("In left/panda_hand")).to_be_visible()
        expect(captures.get_by_text(re.compile(r"^-?0\.0 {2}-?0\.0 {2}103\.4 mm"))).to_be_visible()
        expect(captures.get_by_text(re.compile("not known to this arm")).first).to_be_visible()
