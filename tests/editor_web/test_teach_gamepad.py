"""A gamepad at the page for teaching: its buttons are triggers, its sticks jog while a deadman button is held."""

from __future__ import annotations

import re
from collections.abc import Generator

import numpy as np
import pytest
from playwright.sync_api import Browser, Page, expect

from engine.skills.teaching import Callback, Trigger, TriggerType
from tests.editor_web.browsing import switch
from tests.editor_web.teach_page import DEADMAN, SHIFT, SOUTH, START, Gamepads, tab, teaching
from tests.editor_web.teach_site import TeachSite, fastest

UP = (0.0, -1.0, 0.0, 0.0)


def trigger(button: str, callback: Callback, kind: TriggerType) -> Trigger:
    topic = f"/buttons/gamepad/{button}"
    return Trigger(trig_name=button, robot_ns="left", trig_topic=topic, trig_type=kind, trig_callback=callback)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[TeachSite]:
    """An arm in physics, in real time; two buttons of a gamepad are triggers."""
    triggers = (trigger("south", "joint_save", "rising_edge"), trigger("start", "joint_dmp_save", "hold"))
    with TeachSite(host=loopback, project=tmp_path_factory.mktemp("taught"), triggers=triggers) as opened:
        yield opened


def jogging_with(page: Page) -> Gamepads:
    """Turn the gamepad on for jogging, and hold one."""
    pads = Gamepads(page)
    move = page.get_by_role("tabpanel", name="Move")
    switch(move.get_by_role("switch", name="Jog with a gamepad"))
    expect(move.get_by_text("No gamepad is seen")).to_be_visible()
    pads.hold()
    expect(move.get_by_text("As long as L1 is held")).to_be_visible()
    pads.looked_at()
    return pads


def test_the_buttons_of_a_gamepad_are_triggers(browser: Browser, site: TeachSite) -> None:
    """Whichever gamepad it is; a recording ends when the gamepad that holds it is gone."""
    site.call(site.go_home())
    with teaching(browser, site, quiet=False) as page:
        pads = Gamepads(page)
        buttons = tab(page, "Buttons")
        switch(buttons.get_by_role("switch"))
        pads.hold(index=1)
        pads.hold(SOUTH)
        said = page.get_by_role("status", name="Messages of the Helping Hand")
        expect(said).to_have_text(re.compile("capture [0-9]+ of left: joints"))
        number = int(said.inner_text().split()[1])
        expect(buttons.get_by_role("status", name="Gamepad")).to_have_text("gamepad/south")
        pads.looked_at()
        pads.hold(START)
        expect(said).to_have_text("left is being recorded")
        pads.looked_at()
        expect(buttons.get_by_role("status", name="Gamepad")).to_have_text("gamepad/start")
        site.call(site.turn(0.2))
        pads.unplug()
        expect(said).to_have_text(f"capture {number + 1} of left: dmp")
        expect(buttons.get_by_role("status", name="Gamepad")).to_contain_text("Press a button of a gamepad")
        pads.hold(SHIFT, index=1)
        expect(buttons.get_by_role("alert")).to_contain_text("no trigger listens to buttons/gamepad/right_1")


def test_a_stick_jogs_only_while_the_deadman_button_is_held(browser: Browser, site: TeachSite) -> None:
    """Released, with the stick still held: the arm comes to rest."""
    site.call(site.go_home())
    with teaching(browser, site) as page:
        told_s = site.call(site.hear_jogs())
        pads = jogging_with(page)
        began = np.array(site.joints().position_rad)
        pads.hold(axes=UP)
        pads.looked_at()
        assert not told_s
        pads.hold(DEADMAN)
        pads.looked_at()
        assert not told_s
        pads.hold(DEADMAN, axes=UP)
        site.call(site.moved(began, by_rad=0.05))
        expect(page.get_by_role("status", name="State of left").first).to_have_text("jogging")
        pads.hold(axes=UP)
        moving = site.call(site.last_moving())
        assert moving.time_s - told_s[-1] < 0.3
        expect(page.get_by_role("status", name="State of left").first).to_have_text("idle")


def test_a_gamepad_that_is_gone_stops_the_arm_and_starts_nothing_when_it_is_back(
    browser: Browser, site: TeachSite
) -> None:
    """Nor does one that is held while the page comes back to the front: the button is pressed anew."""
    site.call(site.go_home())
    with teaching(browser, site) as page:
        told_s = site.call(site.hear_jogs())
        pads = jogging_with(page)
        leaving = (
            pads.unplug,
            lambda: page.evaluate("dispatchEvent(new Event('blur'))"),
            lambda: page.evaluate("dispatchEvent(new Event('pointerup'))"),
        )
        for leave in leaving:
            pads.hold()
            pads.looked_at()
            pads.hold(DEADMAN, axes=(0.0, 1.0, 0.0, 0.0))
            site.call(site.seen(lambda state: fastest(state) > 0.05))
            leave()
            moving = site.call(site.last_moving())
            assert moving.time_s - told_s[-1] < 0.3
            count = len(told_s)
            pads.hold(DEADMAN, axes=UP)
            pads.looked_at()
            assert len(told_s) == count
        site.call(site.let_go())


def test_the_sticks_turn_joints_too(browser: Browser, site: TeachSite) -> None:
    """With the other shoulder button the last three."""
    site.call(site.go_home())
    with teaching(browser, site) as page:
        pads = jogging_with(page)
        page.get_by_role("tabpanel", name="Move").get_by_text("Joints", exact=True).click()
        pads.looked_at()
        before = site.joints().position_rad
        pads.hold(DEADMAN, SHIFT, axes=(0.0, 0.0, -1.0, 0.0))
        site.call(site.seen(lambda state: state.position_rad[6] > before[6] + 0.05))
        pads.hold()
        after = site.call(site.rested()).position_rad
        assert np.allclose(after[:6], before[:6], atol=5e-3)
