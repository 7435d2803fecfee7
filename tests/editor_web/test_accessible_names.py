"""On every page of the address line no two controls have one role and name, unless named groups tell them apart."""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Generator
from itertools import count
from unittest.mock import patch

import pytest
from playwright.sync_api import Browser, Page, expect

from engine.bus import SkillBus
from engine.project import cell_runner
from engine.runtime.run_options import RunOptions
from engine.skills.entries import WriteEntry
from tests.editor_web.accessible_names import controls_of, require_unique_names
from tests.editor_web.browsing import opened_page, require_accessible
from tests.editor_web.demonstrating import furnish, teach
from tests.editor_web.editing import card, idle
from tests.editor_web.fake_plant import FakePlant
from tests.editor_web.test_entry_preview import REACH, REACH_ID
from tests.editor_web.test_timeline_page import SORT, SORT_ID
from tests.editor_web.workshop import SHIFT_ID, Workshop

LIFT_ID = "behaviors/lift.yaml"
_BRANCH = """
              machine:
                initial: grasp
                states:
                  grasp:
                    machine:
                      initial: hold
                      states:
                        hold:
                          state: flow.Wait
                          with: {duration_s: 0}
                          autonomy: {done: high}
                          transitions: {done: over}
                    transitions: {over: over}
"""
LIFT = f"""
flexcell: 1
name: lift
description: Two branches whose nodes have the same names.
parameters:
  dwell: {{type: number, default: 3000, minimum: 0, maximum: 9000, unit: s, description: How long the last one waits}}
userdata: {{value: 0}}
outcomes: [good]
success: [good]
root:
  machine:
    initial: both
    states:
      both:
        concurrency:
          states:
            left: {_BRANCH}
            right: {_BRANCH}
          conditions:
            - {{finished: {{left: over, right: over}}}}
        transitions: {{finished: rest}}
      rest: {{state: flow.Wait, with: {{duration_s: "${{dwell}}"}}, transitions: {{done: good}}}}
"""
ASKS = RunOptions(autonomy="low", demand_operator=True)


class Named:
    """A server with devices on its bus, entries and runs: two failed ones of an earlier server, three active ones."""

    def __init__(self, shop: Workshop, past: tuple[str, str]) -> None:
        self.shop, self.past = shop, past
        self.lifts = [shop.start(LIFT_ID, supervision=ASKS) for _ in range(2)]
        self.paused = shop.start(SHIFT_ID, supervision=RunOptions(start_paused=True))


class StartTimes:
    """Each run starts in another second: by that its name tells it from others."""

    def __init__(self) -> None:
        self._starts = count(time.time() - 100.0)

    def time(self) -> float:
        return next(self._starts)


def furnish_all(bus: SkillBus) -> None:
    """A plant, and an arm that can be taught."""
    FakePlant().furnish(bus)
    furnish(bus)


@pytest.fixture(scope="module")
def named(tmp_path_factory: pytest.TempPathFactory, loopback: str) -> Generator[Named]:
    """One server for all pages."""
    project = tmp_path_factory.mktemp("named")
    (project / "behaviors").mkdir()
    for behavior_id, text in ((LIFT_ID, LIFT), (REACH_ID, REACH), (SORT_ID, SORT)):
        (project / behavior_id).write_text(text, encoding="utf-8")
    starts = StartTimes()
    with patch.object(cell_runner, "time", starts):
        with Workshop(host=loopback, project=project) as before:
            first, second = (before.start(SORT_ID), before.start(SORT_ID))
            for run in (first, second):
                before.call(before.session.wait(run))
        with Workshop(host=loopback, project=project, furnish=furnish_all, cell_view=True) as shop:
            close = teach(shop)
            also = WriteEntry(kind="joints", name="bin", value={"joints": (0.0, 0.2)})
            shop.call(shop.session.cell.bus.call(also, to="store"))
            yield Named(shop, (first, second))
            close()


def open_tab(page: Page, name: str) -> None:
    """Open a tab, whose name may have a count behind it."""
    page.get_by_role("tab", name=re.compile(f"^{name}")).click()
    expect(page.get_by_role("tabpanel", name=re.compile(f"^{name}"))).to_be_visible()


def home(page: Page, _: Named) -> None:
    expect(page.get_by_role("region", name="Table of the latest runs").get_by_role("link")).to_have_count(3)
    require_unique_names(page, "home")


def run(page: Page, _: Named) -> None:
    """Each layout, with a node selected whose two breakpoints are set, and each tab."""
    expect(page.get_by_role("region", name="The run asks").get_by_role("listitem")).to_have_count(2)
    require_unique_names(page, "to operate")
    page.locator(".react-flow__node[data-id='root/rest'] [data-node]").click()
    for set_points, label in enumerate(("Pause before its entry", "Pause after its outcome"), start=1):
        page.get_by_role("switch", name=label).press("Space")
        expect(page.get_by_role("combobox", name="Only if")).to_have_count(set_points)
    require_unique_names(page, "a node with two breakpoints")
    page.get_by_text("Debug", exact=True).click()
    for name in ("Breakpoints", "Outline", "Plots", "Data", "Bus", "Timeline"):
        open_tab(page, name)
        require_unique_names(page, f"to debug, {name}")
    page.get_by_text("3D only", exact=True).click()
    require_unique_names(page, "3D only")


def bus(page: Page, _: Named) -> None:
    """A message of nested values, unfolded, and the form of an action."""
    page.get_by_role("tab", name="Bus").click()
    topics = page.get_by_role("navigation", name="The topics of the bus")
    topics.get_by_role("region", name="left", exact=True).get_by_role("button", name=re.compile("^status ")).click()
    message = page.get_by_role("list", name="Latest message of left/status")
    for part in ("settings", "wrench"):
        expect(message.get_by_role("list", name=part)).to_be_visible()
    require_unique_names(page, "a message")
    page.get_by_role("combobox", name="Part of the bus").select_option("actions")
    page.get_by_role("navigation", name="The actions of the bus").get_by_role("button").first.click()
    require_unique_names(page, "an action")


def editor(page: Page, _: Named) -> None:
    """A container and a state selected, the library open at the entries, the behavior, the problems."""
    expect(page.locator(".react-flow[data-in-place] .react-flow__node").first).to_be_visible()
    idle(page)
    page.get_by_role("region", name="Library").get_by_role("button", name="Entries").click()
    expect(page.get_by_role("button", name="Add bin (pose)")).to_be_visible()
    card(page, "root/both").locator("[data-head]").click()
    expect(page.get_by_role("region", name="Ends with")).to_be_visible()
    require_unique_names(page, "a container")
    card(page, "root/both/left/grasp/hold").click()
    expect(page.get_by_role("region", name="Parameters").get_by_role("combobox")).to_be_visible()
    require_unique_names(page, "a state")
    # The tools of a selected node may lie over another one.
    page.keyboard.press("Escape")
    card(page, "root/rest").click()
    page.keyboard.press("Delete")
    expect(page.locator("[data-problem-count]")).to_contain_text("error")
    idle(page)
    for name in ("Problems", "Behavior"):
        open_tab(page, name)
        require_unique_names(page, name)


def entry_field(page: Page, _: Named) -> None:
    """A state whose target is one of the entries, and its menu."""
    expect(page.get_by_role("combobox", name="target", exact=True)).to_be_visible()
    idle(page)
    require_unique_names(page, "a state with a target")


def active_runs(page: Page, _: Named) -> None:
    """Two of one behavior, which ask the same."""
    expect(page.get_by_role("button", name="Agree: done")).to_have_count(4)
    require_unique_names(page, "active runs")


def past_runs(page: Page, _: Named) -> None:
    expect(page.get_by_role("list", name="Past runs").get_by_role("link")).to_have_count(5)
    require_unique_names(page, "past runs")


def past_run(page: Page, _: Named) -> None:
    """How it failed, and each tab."""
    expect(page.get_by_role("region", name="How the run failed")).to_contain_text("division by zero")
    require_unique_names(page, "Failure")
    for name in ("Timeline", "Log", "Data", "Outline"):
        open_tab(page, name)
        require_unique_names(page, name)


def comparison(page: Page, _: Named) -> None:
    """Each tab; both runs went the same path."""
    expect(page.get_by_role("button", name="root/approach, visit 1")).to_be_visible()
    for name in ("Visit", "Durations", "Settings", "Curves", "3D"):
        open_tab(page, name)
        require_unique_names(page, name)
    expect(page.get_by_role("slider", name="Time since the start of the visit")).to_be_visible()
    require_accessible(page, "two runs in one 3D view")


def side_by_side(page: Page, _: Named) -> None:
    """Two runs of one behavior."""
    expect(page.get_by_role("button", name="Agree: done")).to_have_count(4)
    require_unique_names(page, "side by side")


def trend(page: Page, _: Named) -> None:
    expect(page.get_by_role("list", name="Last runs").get_by_role("link")).to_have_count(2)
    require_unique_names(page, "trend")


def sweeps(page: Page, _: Named) -> None:
    """The form of a new one, with two factors."""
    page.get_by_role("button", name="New sweep").press("Enter")
    page.get_by_role("combobox", name="Behavior").select_option(LIFT_ID)
    for _factor in range(2):
        page.get_by_role("button", name="Add a factor").press("Enter")
    require_unique_names(page, "a new sweep")


def keys(page: Page, _: Named) -> None:
    page.get_by_role("region", name="Run control").get_by_role("button", name="Keys").press("Enter")
    expect(page.get_by_role("dialog", name="Keyboard")).to_be_visible()
    require_unique_names(page, "keys")


Look = Callable[[Page, Named], None]


@pytest.mark.parametrize(
    ("address", "look"),
    [
        ("/", home),
        ("/runs/{lift}?layout=operate", run),
        ("/behaviors/" + SHIFT_ID + "?layout=debug", bus),
        ("/edit/" + LIFT_ID, editor),
        ("/edit/" + REACH_ID + "#root/turn", entry_field),
        ("/runs", active_runs),
        ("/past", past_runs),
        ("/runs/{past}?layout=operate", past_run),
        ("/compare/{past}/{other_past}#root/approach@1", comparison),
        ("/beside/{lift}/{other_lift}", side_by_side),
        ("/trends/sort", trend),
        ("/sweeps", sweeps),
        ("/behaviors/" + SHIFT_ID, keys),
    ],
    ids=lambda value: value.__name__ if callable(value) else "",
)
def test_no_two_controls_of_a_page_have_one_name(browser: Browser, named: Named, address: str, look: Look) -> None:
    """In each of its states that shows other controls."""
    (past, other_past), (lift, other_lift) = named.past, named.lifts
    at = address.format(past=past, other_past=other_past, lift=lift, other_lift=other_lift)
    with opened_page(browser, named.shop.running, "/login", quiet=False) as page:
        # A picture of the cell takes seconds without a graphics card, and its controls are not of the page.
        page.route("**/cell/*/**", lambda route: route.fulfill(body="<title>cell</title>", content_type="text/html"))
        page.goto(named.shop.running.url.rstrip("/") + at)
        look(page, named)


def test_controls_of_one_name_in_no_groups_of_their_own_are_reported(browser: Browser) -> None:
    """Groups without a name do not, nor what is hidden; the text of a row does."""
    page = browser.new_page()
    page.set_content("<ul><li><button>Delete</button></li><li><button>Delete</button></li></ul>")
    with pytest.raises(AssertionError, match="2 x button 'Delete'"):
        require_unique_names(page, "a list")
    page.set_content(
        "<ul><li aria-label='home'><button>Delete</button></li><li aria-label='bin'><button>Delete</button></li></ul>"
        "<table><tr><th>Arm</th><th>Entry</th></tr><tr><td>left</td><td><button>Delete</button></td></tr>"
        "<tr><td>right</td><td><button>Delete</button></td></tr></table><button hidden>Delete</button>"
    )
    require_unique_names(page, "a list and a table")
    assert len(list(controls_of(page))) == 4
