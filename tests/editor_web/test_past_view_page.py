"""In a real browser the 3D view goes along with the timeline, and says that it shows the past."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Browser, expect

from engine.bus import SkillBus
from engine.messages import FramePoses, SceneDescription
from tests.editor_web.browsing import opened_page, require_accessible
from tests.editor_web.fake_scene import frames_at, new_scene
from tests.editor_web.workshop import Workshop

ID = "behaviors/short.yaml"
SHORT = """
flexcell: 1
name: short
outcomes: [good, bad]
success: [good]
root:
  machine:
    initial: first
    states:
      first: {state: test.Give, with: {after_s: 0.4}, transitions: {a: second, b: bad, c: bad}}
      second: {state: test.Give, with: {after_s: 0.4}, transitions: {a: good, b: bad, c: bad}}
"""


def furnish(bus: SkillBus) -> None:
    """A cell of boxes that stands still."""
    bus.topic("cell/scene", SceneDescription).publish(new_scene())
    bus.topic("cell/frames", FramePoses).publish(frames_at(1.0))


def test_the_view_shows_the_moment_of_the_timeline_until_one_goes_back(
    browser: Browser, tmp_path: Path, loopback: str
) -> None:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / ID).write_text(SHORT, encoding="utf-8")
    with Workshop(host=loopback, project=tmp_path, furnish=furnish, cell_view=True) as shop:
        run = shop.start(ID)
        shop.call(shop.session.wait(run))
        with opened_page(browser, shop.running, f"/runs/{run}?layout=debug", quiet=False, size=(1100, 700)) as page:
            page.get_by_role("tab", name="Timeline").press("Enter")
            moment = page.get_by_role("slider", name="Moment of the run")
            mark = page.locator("[data-mark=past]")
            expect(mark).to_have_count(0)
            moment.press("ArrowLeft")
            expect(mark).to_contain_text(f"of {run}")
            expect(page.locator("[data-shows]")).to_have_attribute("data-shows", "past")
            require_accessible(page, "the mark of the past", part="[data-shows]")
            page.get_by_role("button", name="Back to live").press("Enter")
            expect(mark).to_have_count(0)
            expect(page.locator("[data-shows]")).to_have_attribute("data-shows", "present")
