"""Named entries seen in 3D from inside the editor: the ghost of the right arm, and what is known of the entry."""

from __future__ import annotations

import re
from collections.abc import Generator
from contextlib import contextmanager
from typing import Any

import msgspec
import numpy as np
import pytest
import websockets
from playwright.sync_api import Browser, Locator, Page, expect

from editor_web.security.authentication import VIEWER
from engine.messages.demonstrations import Trajectory
from engine.skills.dmp import LearnJointDmp
from engine.skills.entries import WriteEntry
from tests.editor_web.browsing import PHONE, Scheme, Size, opened_page, require_accessible
from tests.editor_web.teach_page import name_of, seeing
from tests.editor_web.teach_site import CELL, TeachSite
from tests.editor_web.viser_page import ViserPage, served_view
from tests.editor_web.workshop import NAP_ID, Workshop
from tests.robots.panda_arm import home
from tests.tiers import nightly

LAPTOP: Size = (1280, 800)
HOME = tuple(home().tolist())
TURNED = (0.3, *HOME[1:])
TIMES = np.linspace(0.0, 1.0, 101)
LED = home() + np.outer(0.5 - 0.5 * np.cos(np.pi * TIMES), (0.2, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
TWO_ARMS = CELL.replace(
    "fixtures:", "  right:\n    model: ur10\n    driver: sim\n    base: {xyz: [0.9, 0.0, 0.0]}\nfixtures:"
)
REACH_ID = "behaviors/reach.yaml"
REACH = """
flexcell: 1
name: reach
parameters:
  arm: {type: string, default: left, description: Which one}
  place: {type: string, description: Where to}
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: turn
    states:
      turn:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: aside}}
        transitions: {reached: over, failed: bad}
      over:
        state: motion.MoveLinear
        with: {robot: "${arm}", target: {entry: far_away}, duration_s: 2}
        transitions: {reached: swing, failed: bad}
      swing:
        state: motion.FollowJointDmp
        with: {robot: right, dmp: {entry: swing}}
        transitions: {reached: asked, failed: bad}
      asked:
        state: motion.MoveJoints
        with: {robot: left, target: {entry: "${place}"}}
        transitions: {reached: good, failed: bad}
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    """Two arms of different kinds, and entries for the first."""
    project = tmp_path_factory.mktemp("reached")
    opened = TeachSite(host=loopback, project=project, view=True)
    (project / "behaviors" / "cells" / "taught.yaml").write_text(TWO_ARMS, encoding="utf-8")
    (project / REACH_ID).write_text(REACH, encoding="utf-8")
    with opened:
        led = Trajectory(times_s=tuple(TIMES.tolist()), joints=tuple(map(tuple, LED.tolist())))
        learned = opened.call(opened.bus.call(LearnJointDmp(trajectory=led), to="left"))
        written: tuple[tuple[str, str, dict[str, Any]], ...] = (
            ("joints", "ahead", {"joints": HOME}),
            ("joints", "aside", {"joints": TURNED}),
            ("pose", "far_away", {"xyz": (3.0, 0.0, 0.5)}),
            ("dmp", "swing", msgspec.to_builtins(learned.dmp)),
        )
        for kind, name, value in written:
            entry = WriteEntry(kind=kind, name=name, value=value, tags=("station_1",), by="ana", reason="measured")
            opened.call(opened.bus.call(entry, to="store"))
        yield opened


@contextmanager
def editing(
    browser: Browser,
    site: TeachSite,
    node: str,
    *,
    scheme: Scheme = "light",
    size: Size = LAPTOP,
    is_drawn: bool = False,
) -> Generator[Page]:
    """Open the form of a node; the answers of the server are as it was asked, also in the console."""
    path = f"/edit/{REACH_ID}#root/{node}"
    with opened_page(browser, site.running, path, scheme=scheme, size=size, quiet=False) as page:
        if size[0] < LAPTOP[0]:
            page.get_by_role("tab", name="Form").click()
        if not is_drawn:
            # Without a graphics card a picture of the cell takes seconds; what it would show is asked for by `seeing`.
            page.route(
                "**/cell/*/**", lambda route: route.fulfill(body="<title>cell</title>", content_type="text/html")
            )
        expect(button_of(page)).to_be_visible()
        yield page


def button_of(page: Page) -> Locator:
    return page.get_by_role("button", name=re.compile("^Show (target|dmp) in 3D$"))


def open_preview(page: Page, name: str) -> Locator:
    """Press the button by the keyboard, as soon as the entries are known."""
    button = button_of(page)
    expect(button).not_to_have_attribute("aria-disabled", "true")
    button.press("Enter")
    return preview_of(page, name)


def preview_of(page: Page, name: str) -> Locator:
    shown = page.get_by_label(f"Preview of {name}", exact=True)
    expect(shown).to_be_visible()
    return shown


def is_ghost(view: ViserPage, arm: str) -> bool:
    return view.is_seen(f"/taught/{arm}.0/ghost")


def test_the_arm_of_the_state_is_shown_at_its_entry_until_the_preview_is_closed(
    browser: Browser, site: TeachSite
) -> None:
    """In numbers and as a ghost that only this page sees; another entry in the field takes its place."""
    with editing(browser, site, "turn") as page:
        shown = open_preview(page, "aside")
        expect(shown.get_by_role("combobox", name="Arm that is shown")).to_have_value("left")
        expect(shown).to_contain_text("Joints17.2  -45.0  0.0")
        expect(shown).to_contain_text(re.compile(r"Revision 1.*by ana, measured"))
        expect(shown).to_contain_text("Tagsstation_1")
        with seeing(site, name_of(page)) as mine, seeing(site, "another") as other:
            site.call(mine.until(lambda: is_ghost(mine, "left")))
            target = page.get_by_role("combobox", name="target", exact=True)
            target.fill("ahead")
            target.press("Enter")
            expect(preview_of(page, "ahead")).to_contain_text("Joints0.0  -45.0  0.0")
            close = page.get_by_role("button", name="Close the preview")
            close.press("Enter")
            expect(close).to_have_count(0)
            expect(button_of(page)).to_be_focused()
            site.call(mine.until(lambda: not is_ghost(mine, "left")))
            site.call(other.idle())
            assert not any(name.startswith("/taught/") for name in other.nodes)


def test_what_the_opened_list_points_at_is_shown_before_it_is_taken(browser: Browser, site: TeachSite) -> None:
    """Escape goes back to what is written, and then closes the preview."""
    with editing(browser, site, "turn") as page:
        shown = open_preview(page, "aside")
        target = page.get_by_role("combobox", name="target", exact=True)
        target.focus()
        for name in ("ahead", "aside", "ahead"):
            target.press("ArrowDown")
            preview_of(page, name)
        target.press("Escape")
        preview_of(page, "aside")
        expect(page.locator("[data-unsaved]")).to_have_count(0)
        shown.get_by_role("button", name="Close the preview").focus()
        page.keyboard.press("Escape")
        expect(page.get_by_label("Preview of aside")).to_have_count(0)


def test_a_field_offers_the_names_that_the_cell_has(browser: Browser, site: TeachSite) -> None:
    """Those that the check knows: the robots for an arm, to be chosen by the keyboard."""
    with editing(browser, site, "turn") as page:
        robot = page.get_by_role("combobox", name="robot", exact=True)
        robot.focus()
        robot.press("ArrowDown")
        expect(page.get_by_role("listbox", name="Choices for robot").get_by_role("option")).to_have_text(
            [re.compile("^left"), re.compile("^right")]
        )
        robot.press("ArrowDown")
        robot.press("Enter")
        expect(robot).to_have_value("right")


def test_what_an_arm_cannot_do_is_said_in_words(browser: Browser, site: TeachSite) -> None:
    """Too far away for the arm that the behavior has by default; of more joints than another arm has."""
    with editing(browser, site, "over") as page:
        shown = open_preview(page, "far_away")
        expect(shown.get_by_role("combobox", name="Arm that is shown")).to_have_value("left")
        expect(shown.get_by_role("status")).to_contain_text(re.compile("reach|follow|outside", re.IGNORECASE))
    with editing(browser, site, "swing") as page:
        shown = open_preview(page, "swing")
        arm = shown.get_by_role("combobox", name="Arm that is shown")
        expect(arm).to_have_value("right")
        expect(shown.get_by_role("status")).to_contain_text("the entry has 7 joints")
        arm.select_option("left")
        expect(shown.get_by_role("status")).to_have_text("left is shown at swing")
        expect(shown).to_contain_text(re.compile(r"Motion[01]\.\d\d s, 0\.\d\d m of the tool"))


def test_where_there_is_nothing_to_show_the_button_says_why(browser: Browser, site: TeachSite) -> None:
    """Which the run alone knows, and of a name that no entry has."""
    with editing(browser, site, "asked") as page:
        expect(button_of(page)).to_have_attribute("title", "Not possible: which entry it is, only the run knows")
    with editing(browser, site, "turn") as page:
        target = page.get_by_role("combobox", name="target", exact=True)
        target.fill("nowhere")
        target.press("Enter")
        expect(button_of(page)).to_have_attribute("title", "Not possible: there is no joints entry nowhere")
        button_of(page).press("Enter")
        expect(page.get_by_role("alert")).to_contain_text("there is no joints entry nowhere")
        expect(page.get_by_role("button", name="Close the preview")).to_have_count(0)


def test_an_entry_of_the_library_is_shown_with_the_arm_that_is_chosen(browser: Browser, site: TeachSite) -> None:
    """The choice stays from one entry to the next; leaving the page takes the ghost away."""
    with editing(browser, site, "turn") as page:
        library = page.get_by_role("region", name="Library")
        library.get_by_role("button", name="Entries").click()
        library.get_by_role("button", name="Show aside (joints) in 3D").press("Enter")
        arm = preview_of(page, "aside").get_by_role("combobox", name="Arm that is shown")
        expect(arm).to_have_value("left")
        arm.select_option("right")
        library.get_by_role("button", name="Show far_away (pose) in 3D").press("Enter")
        expect(preview_of(page, "far_away").get_by_role("combobox")).to_have_value("right")
        preview_of(page, "far_away").get_by_role("combobox").select_option("left")
        library.get_by_role("button", name="Show ahead (joints) in 3D").press("Enter")
        preview_of(page, "ahead")
        with seeing(site, name_of(page)) as mine:
            site.call(mine.until(lambda: is_ghost(mine, "left")))
            page.get_by_role("link", name="Teach").first.click()
            site.call(mine.until(lambda: not is_ghost(mine, "left")))


async def look(site: TeachSite, page: str) -> None:
    """Look at an entry, and be lost without a word."""
    async with (
        site.socket(VIEWER, page=page) as socket,
        served_view(site.running, page, role=VIEWER) as view,
    ):
        await socket.send('{"k": "look", "arm": "left", "kind": "joints", "name": "aside"}')
        await view.until(lambda: is_ghost(view, "left"))
        socket.transport.abort()
        await view.until(lambda: not is_ghost(view, "left"))


def test_a_ghost_goes_with_the_connection_that_asked_for_it(site: TeachSite) -> None:
    """Also a viewer may look."""
    site.call(look(site, "lost1"))


@pytest.mark.parametrize("name", ["../x", "A", "a" * 41, "%00"])
def test_what_no_page_calls_itself_is_refused(site: TeachSite, name: str) -> None:
    """Before the connection opens."""

    async def connect() -> int:
        with pytest.raises(websockets.InvalidStatus) as refused:
            await site.socket(page=name)
        return refused.value.response.status_code

    assert site.call(connect()) == 403


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [nightly(LAPTOP), PHONE], ids=["laptop", "phone"])
def test_the_preview_is_accessible(browser: Browser, site: TeachSite, scheme: Scheme, size: Size) -> None:
    """Beside the form; on a phone as a sheet as wide as the screen, which Escape closes."""
    with editing(browser, site, "turn", scheme=scheme, size=size) as page:
        shown = open_preview(page, "aside")
        expect(shown.get_by_role("status").first).to_have_text("left is shown at aside")
        require_accessible(page, f"the preview, {scheme}", part="[aria-label='Preview of aside']")
        if size == PHONE:
            box = shown.bounding_box()
            assert box is not None
            assert (box["x"], box["width"]) == (0, PHONE[0])
            page.keyboard.press("Escape")
            expect(shown).to_have_count(0)
            expect(button_of(page)).to_be_focused()


def test_a_server_without_a_3d_view_says_so(browser: Browser, shop: Workshop) -> None:
    """The button stays in its place."""
    text = (shop.project / NAP_ID).read_text(encoding="utf-8")
    given = "robot: left, target: {entry: home}"
    moved = text.replace("flow.Wait, with: {duration_s: 3000}", f"motion.MoveJoints, with: {{{given}}}")
    (shop.project / NAP_ID).write_text(moved, encoding="utf-8")
    with opened_page(browser, shop.running, f"/edit/{NAP_ID}#root/only") as page:
        expect(button_of(page)).to_have_attribute("title", "Not possible: this server has no 3D view")
