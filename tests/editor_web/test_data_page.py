"""Userdata and the progress of goals in a real browser, against a real session."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path
from typing import ClassVar

import pytest
from playwright.sync_api import Browser, Page, expect

from engine.event import UserdataWritten
from engine.messages import Pose
from engine.state import Context, Outcome, State
from tests.editor_web.browsing import PHONE, Scheme, Size, opened_page, require_accessible
from tests.editor_web.fake_plant import FakePlant, Travel, TravelProgress
from tests.editor_web.workshop import Workshop

LAPTOP: Size = (1280, 800)
TRIP_ID = "behaviors/trip.yaml"
TRIP = """
flexcell: 1
name: trip
userdata: {count: 0, found: [], pose: {xyz: [0.1, 0.2, 0.3], frame: world}}
outcomes: [good]
success: [good]
root:
  machine:
    initial: look
    states:
      look:
        machine:
          initial: note
          userdata: {local: draft}
          states:
            note: {state: flow.SetValue, with: {value: "a long note"}, out: {value: local}, transitions: {done: ended}}
        transitions: {ended: count}
      count: {state: flow.SetValue, with: {value: "${count + 1}"}, out: {value: count}, transitions: {done: travel}}
      travel: {state: test.Travel, transitions: {done: good}}
"""


class TravelState(State, frozen=True, kw_only=True):
    """Travel with the plant."""

    state_name: ClassVar[str] = "test.Travel"
    outcomes: ClassVar[tuple[str, ...]] = ("done",)
    success: ClassVar[tuple[str, ...]] = ("done",)

    async def run(self, ctx: Context) -> Outcome:
        """Send the goal and wait for its end."""
        await ctx.perform(Travel(target=Pose(xyz=(0.4, 0.0, 0.3))), to="plant")
        return Outcome("done")


@pytest.fixture
def plant() -> FakePlant:
    """The devices on the bus."""
    return FakePlant()


@pytest.fixture
def shop(tmp_path: Path, loopback: str, plant: FakePlant) -> Generator[Workshop]:
    """A served session with them and a behavior that travels."""
    states = {TravelState.state_name: TravelState}
    with Workshop(host=loopback, project=tmp_path, furnish=plant.furnish, states=states) as opened:
        (tmp_path / TRIP_ID).write_text(TRIP, encoding="utf-8")
        yield opened


def open_data(page: Page) -> None:
    """Bring the data in front."""
    page.get_by_role("tab", name="Data", exact=True).click()


def test_the_progress_of_a_goal_is_on_its_node_and_in_its_card(
    browser: Browser, shop: Workshop, plant: FakePlant
) -> None:
    """While it is under way, as its feedback tells it."""
    with opened_page(browser, shop.running, f"/behaviors/{TRIP_ID}", size=LAPTOP) as page:
        page.get_by_role("button", name="Start").click()
        node = page.locator(".react-flow__node[data-id='root/travel']")
        bar = node.get_by_role("progressbar", name="Progress of plant/travel")
        expect(bar).to_have_attribute("aria-valuenow", "25")
        shop.on_loop(lambda: plant.goals[0].feedback(TravelProgress(progress=0.8)))
        expect(bar).to_have_attribute("aria-valuenow", "80")
        expect(node).to_contain_text("80 %")
        node.click()
        card = page.get_by_role("region", name="Node root/travel")
        expect(card.get_by_role("progressbar")).to_have_attribute("aria-valuenow", "80")
        shop.on_loop(plant.arrive.set)
        expect(page.get_by_role("progressbar", name="Progress of plant/travel")).to_have_count(0)
        expect(node.locator("[data-node]")).to_have_attribute("data-status", "done")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_data_is_accessible(browser: Browser, shop: Workshop, scheme: Scheme) -> None:
    """With values, and with a node under way."""
    with opened_page(browser, shop.running, f"/behaviors/{TRIP_ID}", size=LAPTOP, scheme=scheme) as page:
        open_data(page)
        page.get_by_role("button", name="Start").click()
        expect(page.get_by_role("region", name="Behavior")).to_contain_text("root/count")
        expect(page.get_by_role("progressbar", name="Progress of plant/travel")).to_be_visible()
        require_accessible(page, "data", part="section[aria-label=Data]")
        require_accessible(page, "goal", part="[data-graph]")


def test_a_value_is_changed_while_the_run_is_paused(browser: Browser, shop: Workshop) -> None:
    """By keyboard; the run has it, and it is said that no node wrote it."""
    run = shop.start(TRIP_ID)
    with opened_page(browser, shop.running, f"/behaviors/{TRIP_ID}", size=LAPTOP) as page:
        open_data(page)
        change = page.get_by_role("button", name="Change count")
        expect(change).to_have_attribute("aria-disabled", "true")
        page.get_by_role("button", name="Pause", exact=True).click()
        expect(change).to_have_attribute("aria-disabled", "false")
        change.press("Enter")
        page.get_by_label("New value of count").fill("[41]")
        require_accessible(page, "a value being changed", part="section[aria-label=Data]")
        page.keyboard.press("Enter")
        expect(page.get_by_role("region", name="Behavior")).to_contain_text("set by a person")
        written = [each for each in shop.events(run) if isinstance(each, UserdataWritten)]
        assert (written[-1].key, written[-1].value) == ("count", [41])


def test_the_data_on_a_phone(browser: Browser, shop: Workshop) -> None:
    """Writers stand below their values."""
    shop.start(TRIP_ID)
    with opened_page(browser, shop.running, f"/behaviors/{TRIP_ID}", size=PHONE) as page:
        open_data(page)
        expect(page.get_by_role("region", name="Behavior")).to_contain_text("root/count")
