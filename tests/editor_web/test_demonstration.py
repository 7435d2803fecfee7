"""Taught entries become a behavior: over HTTP, and in a real browser by the dialog of the editor's library."""

from __future__ import annotations

from collections.abc import Generator
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, Page, expect

from engine.check import check_file
from engine.document import load_behavior
from engine.registry import load_states
from tests.editor_web.browsing import PHONE, Scheme, require_accessible
from tests.editor_web.demonstrating import furnish, teach
from tests.editor_web.editing import LAPTOP, at_editor, card
from tests.editor_web.limits import GUARD_S
from tests.editor_web.workshop import SHIFT_ID, Workshop

MADE = "behaviors/gear_to_bin.yaml"
STEPS = [
    {"kind": "joints", "name": "home"},
    {"kind": "pose", "name": "above_tray"},
    {"kind": "pose", "name": "tray_pick"},
    {"kind": "gripper", "name": "around_gear"},
    {"kind": "pose", "name": "bin"},
    {"kind": "action", "name": "open"},
]
WORDS = ["Move to home", "Pick gear at tray_pick", "Place gear at bin"]


@pytest.fixture
def taught(tmp_path: Path, loopback: str) -> Generator[Workshop]:
    """A workshop in which somebody has taught."""
    with Workshop(host=loopback, project=tmp_path, furnish=furnish) as shop:
        close = teach(shop)
        yield shop
        close()


def asked(shop: Workshop, body: dict[str, Any], *, token: str = "") -> httpx.Response:
    """What the route answers."""
    headers = {"Authorization": f"Bearer {token or shop.access.operator}"}
    with httpx.Client(base_url=shop.running.url, headers=headers, trust_env=False, timeout=GUARD_S) as http:
        return http.post("/api/v1/teach/proposal", json=body)


def test_a_proposal_says_what_it_will_do_and_is_written_only_where_an_id_is_given(taught: Workshop) -> None:
    """Roles and the part are decided by order, places, and what the gripper did."""
    answer = asked(taught, {"steps": STEPS}).json()
    decided = [(step["name"], step["role"], step["part"]) for step in answer["steps"]]
    assert decided == [
        ("home", "via", None),
        ("above_tray", "approach", None),
        ("tray_pick", "grasp", "gear"),
        ("around_gear", "close", ""),
        ("bin", "release", None),
        ("open", "open", None),
    ]
    assert (answer["words"], answer["remarks"], answer["findings"]) == (WORDS, [], [])
    assert (answer["arms"], sorted(answer["parts"]), answer["tool"]) == (["arm"], ["gear", "lid"], "gripper")
    assert not (taught.project / "behaviors" / "from_demonstration.yaml").exists()
    made = asked(taught, {"steps": STEPS, "id": MADE, "options": {"speed": 0.2}})
    assert (made.status_code, made.json()["id"]) == (200, MADE)
    behavior = load_behavior(taught.project / MADE)
    assert (behavior.document.parameters["speed"].default, behavior.document.parameters["width_m"].default) == (
        0.2,
        0.032,
    )
    assert check_file(taught.project / MADE, load_states()) == ()
    again = asked(taught, {"steps": STEPS, "id": MADE})
    assert (again.status_code, again.json()["message"]) == (422, "there is a document with this id")


@pytest.mark.parametrize(
    ("body", "status", "says"),
    [
        ({"steps": []}, 422, "of length >= 1"),
        ({"steps": [{"kind": "joints", "name": "hme"}]}, 422, "there is no joints entry called hme"),
        ({"steps": [{"kind": "action", "name": "wave"}]}, 422, "there is no action 'wave'"),
        ({"steps": [{"kind": "action", "name": "open"}]}, 422, "no step moves the arm"),
        ({"steps": [{"kind": "joints", "name": "home", "role": "follow"}]}, 422, "joints home cannot be `follow`"),
        ({"steps": STEPS, "options": {"arm": "left"}}, 422, "there is no arm left"),
        ({"steps": STEPS, "id": "../../etc/x.yaml"}, 404, "this is not the id of a document"),
        ({"steps": STEPS, "id": "behaviors/x.json"}, 422, "matching regex"),
        ({"steps": STEPS, "options": {"speed": 2}}, 422, "<= 1"),
    ],
)
def test_what_makes_no_sense_is_refused_in_words(
    taught: Workshop, body: dict[str, Any], status: int, says: str
) -> None:
    """And nothing is written."""
    answer = asked(taught, body)
    assert answer.status_code == status
    assert says in answer.json()["message"]


def test_a_viewer_makes_no_behavior(taught: Workshop) -> None:
    """Only operators change anything."""
    assert asked(taught, {"steps": STEPS, "id": MADE}, token=taught.access.viewer).status_code == 403
    assert not (taught.project / MADE).exists()


def opened_dialog(page: Page) -> None:
    """Open the dialog from the library."""
    page.get_by_role("button", name="From demonstration").click()
    expect(page.get_by_role("button", name="Add joints home")).to_be_visible()


def choose_all(page: Page) -> None:
    """All steps by their buttons."""
    for name in ("joints home", "pose above_tray", "pose tray_pick", "gripper around_gear", "pose bin"):
        page.get_by_role("button", name=f"Add {name}").click()
    page.get_by_role("button", name="Open gripper").click()


def test_entries_are_chosen_in_their_order_and_the_behavior_opens_in_the_editor(
    browser: Browser, taught: Workshop
) -> None:
    """Guesses are shown and can be changed; what it will do is told in words."""
    with at_editor(browser, taught, SHIFT_ID) as page:
        opened_dialog(page)
        choose_all(page)
        preview = page.get_by_role("region", name="Resulting steps")
        expect(preview.get_by_role("listitem")).to_have_text(WORDS)
        expect(page.get_by_label("What tray_pick is for")).to_have_value("grasp")
        expect(page.get_by_label("Grasped part")).to_have_value("gear")
        page.get_by_label("What above_tray is for").select_option("via")
        expect(preview.get_by_role("listitem")).to_have_text(["Move to home", "Move to above_tray", *WORDS[1:]])
        page.get_by_label("Grasped part").select_option("lid")
        expect(preview.get_by_role("listitem").nth(2)).to_have_text("Pick lid at tray_pick")
        page.get_by_role("listitem", name="Step 2: above_tray").get_by_role("button", name="Remove").click()
        page.get_by_role("listitem", name="Step 1: home").get_by_role("button", name="Later").click()
        expect(page.get_by_role("listitem", name="Step 2: home")).to_be_visible()
        page.get_by_role("listitem", name="Step 2: home").get_by_role("button", name="Earlier").click()
        expect(preview.get_by_role("listitem")).to_have_text(
            ["Move to home", "Pick lid at tray_pick", "Place lid at bin"]
        )
        page.get_by_role("button", name="Create and open").click()
        expect(page.get_by_role("alert")).to_have_text("It needs a name")
        page.get_by_label("Name", exact=True).fill("gear_to_bin")
        page.get_by_role("button", name="Create and open").click()
        expect(card(page, "root/pick_lid")).to_be_visible()
        expect(page).to_have_url(f"{taught.running.url.rstrip('/')}/edit/{MADE}")
    assert load_behavior(taught.project / MADE).root.children.keys() == {"to_home", "pick_lid", "place_lid_at_bin"}


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_dialog_is_accessible(browser: Browser, taught: Workshop, scheme: Scheme) -> None:
    """With steps and a remark, on a laptop."""
    with at_editor(browser, taught, SHIFT_ID, size=LAPTOP, scheme=scheme) as page:
        opened_dialog(page)
        page.get_by_role("button", name="Add pose tray_pick").click()
        page.get_by_role("button", name="Close gripper").click()
        expect(page.get_by_role("region", name="Resulting steps").get_by_role("note")).to_have_count(2)
        require_accessible(page, f"dialog, {scheme}", part="dialog")


def test_on_a_phone_the_dialog_is_as_wide_as_the_page(browser: Browser, taught: Workshop) -> None:
    with at_editor(browser, taught, SHIFT_ID, size=PHONE) as page:
        page.get_by_role("tab", name="Library").click()
        opened_dialog(page)
        choose_all(page)
        expect(page.get_by_role("region", name="Resulting steps").get_by_role("listitem")).to_have_text(WORDS)
        page.wait_for_function(
            "() => document.querySelector('dialog').scrollWidth <= document.querySelector('dialog').clientWidth"
        )
