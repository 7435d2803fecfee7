"""The tab of the skill bus in a real browser, against a real session."""

from __future__ import annotations

import re
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from engine.bus import SkillBus
from engine.messages import JointState
from tests.editor_web.browsing import PHONE, Scheme, Size, opened_page, require_accessible
from tests.editor_web.fake_plant import FakePlant
from tests.editor_web.workshop import SHIFT_ID, Workshop

WIDE: Size = (1920, 1080)
OF_BUS = re.compile("^The .+ of the bus$")


@pytest.fixture
def plant() -> FakePlant:
    """The devices on the bus."""
    return FakePlant()


@pytest.fixture
def shop(tmp_path: Path, loopback: str, plant: FakePlant) -> Generator[Workshop]:
    """A served session with them."""
    with Workshop(host=loopback, project=tmp_path, furnish=plant.furnish) as opened:
        yield opened


@contextmanager
def at_bus(
    browser: Browser,
    shop: Workshop,
    *,
    kind: str = "Topics",
    size: Size = WIDE,
    scheme: Scheme = "light",
) -> Generator[Page]:
    """The page of a behavior with its bus in front."""
    path = f"/behaviors/{SHIFT_ID}"
    # The browser reports refused requests as errors.
    with opened_page(browser, shop.running, path, size=size, scheme=scheme, quiet=False) as page:
        page.get_by_role("tab", name="Bus").click()
        chooser = page.get_by_label("Part of the bus")
        expect(chooser).to_be_visible()
        if page.get_by_role("combobox", name="Part of the bus").count():
            chooser.select_option(label=kind)
        else:
            chooser.get_by_text(kind, exact=True).click()
        yield page


def entry(page: Page, name: str) -> Locator:
    """A row of the list."""
    return entries(page).and_(page.get_by_role("button", name=name))


def entries(page: Page) -> Locator:
    """All rows of the list."""
    return page.get_by_role("navigation", name=OF_BUS).get_by_role("button")


def test_a_topic_is_shown_live_with_its_type_rate_and_age(browser: Browser, shop: Workshop, plant: FakePlant) -> None:
    """What changes is seen; where nothing came, that is said."""
    with at_bus(browser, shop) as page:
        row = entry(page, "joint_state")
        expect(row).to_contain_text("JointState")
        expect(entry(page, "lamp")).to_contain_text("never")
        row.click()
        detail = page.get_by_role("region", name="plant/joint_state")
        expect(detail).to_contain_text("Measured joint state of one robot")
        tree = page.get_by_role("list", name="Latest message of plant/joint_state")
        expect(tree).to_contain_text("[0, 0.5]")
        shop.on_loop(lambda: plant.publish(2.0))
        expect(tree).to_contain_text("[0.9093, -0.32682]")
        for _ in range(20):
            shop.on_loop(lambda: plant.publish(3.0))
        expect(row).to_contain_text("Hz")
        page.get_by_label("Find on the bus").fill("gripper state")
        expect(entries(page)).to_have_count(1)
        page.get_by_label("Find on the bus").fill("no such thing")
        expect(page.get_by_text("Nothing matches")).to_be_visible()


def test_a_goal_is_cancelled_when_its_page_is_left(browser: Browser, shop: Workshop, plant: FakePlant) -> None:
    """Closing the browser must not leave a robot moving."""
    with at_bus(browser, shop, kind="Actions") as page:
        entry(page, "travel").click()
        page.get_by_role("button", name="Send goal").click()
        expect(page.get_by_role("status", name="Course of the request")).to_contain_text("Active")
    shop.call(ended(shop.session.cell.bus))
    assert [goal.cancel_requested for goal in plant.goals] == [True]


async def ended(bus: SkillBus) -> None:
    """Wait until no goal is under way."""
    for goal in bus.goals():
        await goal.result()


def test_a_parameter_is_set_and_a_topic_that_takes_commands_published_on(
    browser: Browser, shop: Workshop, plant: FakePlant
) -> None:
    """Limits hold in the form already."""
    with at_bus(browser, shop, kind="Parameters") as page:
        entry(page, "stiffness").click()
        field = page.get_by_role("form", name="Set plant/stiffness").get_by_role("textbox")
        expect(field).to_have_value("300")
        field.fill("1200")
        page.get_by_role("button", name="Set", exact=True).click()
        expect(page.get_by_text("Must be 0 – 900")).to_be_visible()
        field.fill("450")
        page.get_by_role("button", name="Set", exact=True).click()
        expect(page.get_by_role("list", name="Value of plant/stiffness")).to_contain_text("450")
        page.get_by_label("Part of the bus").get_by_text("Topics", exact=True).click()
        entry(page, "lamp").click()
        page.get_by_label("brightness").fill("0.5")
        page.get_by_role("button", name="Publish").click()
        expect(page.get_by_role("region", name="plant/lamp")).to_contain_text("0.5")
    assert [each.brightness for each in plant.lamp] == [0.5]


def test_three_hundred_entries_stay_fast(browser: Browser, shop: Workshop) -> None:
    """What is found among all of them is drawn with little work."""
    bus = shop.session.cell.bus

    def fill() -> None:
        for number in range(300):
            bus.topic(f"hall/cell{number % 20}/sensor{number}", JointState)

    shop.on_loop(fill)
    with at_bus(browser, shop) as page:
        expect(entries(page)).to_have_count(305)
        session: Any = page.context.new_cdp_session(page)
        send = session.send
        # What the page itself works, whatever else the machine does.
        send("Performance.enable", {"timeDomain": "threadTicks"})
        before_s = worked_s(send)
        page.evaluate(
            """() => new Promise((done) => {
                const find = document.querySelector('input[aria-label="Find on the bus"]')
                const write = Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set
                write.call(find, 'sensor29')
                find.dispatchEvent(new Event('input', { bubbles: true }))
                requestAnimationFrame(() => setTimeout(done))
            })"""
        )
        spent_s = worked_s(send) - before_s
        expect(entries(page)).to_have_count(11)
        assert spent_s < 0.4


def worked_s(send: Any) -> float:
    """How long the page has worked since its begin."""
    found: list[dict[str, Any]] = send("Performance.getMetrics")["metrics"]
    return next(each["value"] for each in found if each["name"] == "TaskDuration")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_bus_is_accessible(browser: Browser, shop: Workshop, scheme: Scheme) -> None:
    """Every kind, in both themes."""
    with at_bus(browser, shop, scheme=scheme) as page:
        entry(page, "joint_state").click()
        expect(page.get_by_role("list", name="Latest message of plant/joint_state")).to_be_visible()
        require_accessible(page, "topics", part="section[aria-label=Bus]")
        page.get_by_label("Part of the bus").get_by_text("Actions", exact=True).click()
        entry(page, "travel").click()
        expect(page.get_by_role("form", name="Request to plant/travel")).to_be_visible()
        require_accessible(page, "actions", part="section[aria-label=Bus]")


def test_on_a_phone_the_list_gives_way_to_what_is_chosen(browser: Browser, shop: Workshop) -> None:
    """And there is a way back."""
    with at_bus(browser, shop, kind="Actions", size=PHONE) as page:
        entry(page, "travel").click()
        expect(page.get_by_role("button", name="Send goal")).to_be_visible()
        expect(page.get_by_role("navigation", name=OF_BUS)).to_be_hidden()
        page.get_by_role("button", name="Back to the list").click()
        expect(entry(page, "travel")).to_be_visible()
