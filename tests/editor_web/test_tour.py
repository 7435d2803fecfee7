"""The tour, done to its end in a real browser: a behavior of two states is built and run, step by step."""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from editor_web.security.authentication import VIEWER
from engine.document import load_behavior
from tests.editor_web.browsing import PHONE, Scheme, Size, opened_page, require_accessible, require_fit
from tests.editor_web.editing import LAPTOP, card, drag, idle, pill, port
from tests.editor_web.workshop import Workshop
from tests.tiers import nightly

MADE = "behaviors/first_steps.yaml"


def tour(page: Page) -> Locator:
    """The card of the tour."""
    return page.get_by_role("region", name="Tour")


def at_step(page: Page, title: str) -> None:
    """The tour is at the step of this title."""
    expect(tour(page).get_by_role("heading")).to_have_text(title)


def require_ring_around(page: Page, target: Locator) -> None:
    """The ring lies around the real thing, and the card not on it."""
    expect(page.locator("[data-tour=ring]")).to_be_visible()
    page.wait_for_function(
        """(target) => {
            const [ring, card] = ['ring', 'card'].map((each) => document.querySelector(`[data-tour=${each}]`))
            if (!ring || !card) return false
            const [r, c, t] = [ring, card, target].map((each) => each.getBoundingClientRect())
            const isAround = r.left <= t.left && r.top <= t.top && r.right >= t.right && r.bottom >= t.bottom
            const isBeside = c.left >= t.right || c.right <= t.left || c.top >= t.bottom || c.bottom <= t.top
            return isAround && r.width < t.width + 20 && isBeside
        }""",
        arg=target.element_handle(),
    )


def require_two_states(shop: Workshop) -> None:
    """What the tour makes is a behavior like any other."""
    states = load_behavior(shop.project / MADE).root.children
    assert [(node.state, dict(node.transitions)) for node in states.values()] == [
        ("flow.Wait", {"done": "log"}),
        ("flow.Log", {"done": "finished"}),
    ]


@pytest.mark.nightly
def test_the_whole_tour_by_mouse(browser: Browser, shop: Workshop) -> None:
    """Each step waits for what is really done; nobody is asked to press Next."""
    with opened_page(browser, shop.running, size=LAPTOP) as page:
        page.get_by_role("region", name="First steps").get_by_role("button", name="Tour").click()
        at_step(page, "Make a behavior")
        new = page.get_by_role("button", name="New", exact=True)
        require_ring_around(page, new)
        new.click()
        at_step(page, "Give it a name")
        page.get_by_label("Name", exact=True).fill("first_steps")
        page.get_by_role("button", name="Create").click()
        at_step(page, "Add a first state")
        wait = page.get_by_role("button", name="Add flow.Wait")
        require_ring_around(page, wait)
        wait.drag_to(page.locator("[data-canvas]"), target_position={"x": 200, "y": 300})
        at_step(page, "Say how long it waits")
        field = page.get_by_role("combobox", name="duration_s")
        require_ring_around(page, field)
        field.fill("0.3")
        field.press("Tab")
        at_step(page, "Add a second state")
        page.get_by_role("button", name="Add flow.Log").click()
        at_step(page, "Say what it writes")
        page.get_by_role("combobox", name="message").fill("hello")
        page.get_by_role("combobox", name="message").press("Tab")
        at_step(page, "Lead the outcomes on")
        # Beside what the step is about, the card is not on what is dragged.
        require_ring_around(page, page.locator("[data-canvas] [data-outcome][data-loose]"))
        drag(page, port(page, "root/log", "done"), pill(page, "root", "finished"))
        at_step(page, "Check, save, and go to the run page")
        page.get_by_role("button", name="Run", exact=True).click()
        at_step(page, "Start it")
        require_two_states(shop)
        page.get_by_role("button", name="Start", exact=True).click()
        at_step(page, "You have built a behavior and run it")
        expect(page.get_by_role("log")).to_contain_text("hello")
        tour(page).get_by_role("button", name="Finish").click()
        expect(tour(page)).to_have_count(0)
        page.get_by_role("link", name="flexcell").click()
        expect(page.get_by_role("button", name="Tour")).to_be_visible()
        expect(page.get_by_role("region", name="First steps")).to_have_count(0)


def test_the_whole_tour_by_keyboard(browser: Browser, shop: Workshop) -> None:
    """Opened, followed and finished without the mouse; the card says the keys."""
    with opened_page(browser, shop.running, size=LAPTOP) as page:
        keys = page.keyboard
        page.get_by_role("region", name="First steps").get_by_role("button", name="Tour").press("Enter")
        at_step(page, "Make a behavior")
        expect(tour(page)).to_be_focused()
        show = tour(page).get_by_role("button", name="Show me")
        show.press("Enter")
        expect(page.get_by_role("button", name="New", exact=True)).to_be_focused()
        keys.press("Enter")
        at_step(page, "Give it a name")
        expect(page.get_by_label("Name", exact=True)).to_be_focused()
        keys.type("first_steps")
        keys.press("Enter")
        at_step(page, "Add a first state")
        idle(page)
        keys.press("a")
        keys.type("wait")
        keys.press("Enter")
        at_step(page, "Say how long it waits")
        expect(card(page, "root/wait")).to_be_focused()
        keys.press("Enter")
        expect(page.get_by_role("combobox", name="duration_s")).to_be_focused()
        keys.type("0.3")
        keys.press("Enter")
        at_step(page, "Add a second state")
        card(page, "root/wait").focus()
        keys.press("a")
        keys.type("flow.log")
        keys.press("Enter")
        at_step(page, "Say what it writes")
        expect(card(page, "root/log")).to_be_focused()
        show.press("Enter")
        expect(page.get_by_role("combobox", name="message")).to_be_focused()
        keys.type("hello")
        keys.press("Enter")
        at_step(page, "Lead the outcomes on")
        card(page, "root/log").focus()
        keys.press("c")
        expect(page.get_by_placeholder("Which outcome …")).to_be_focused()
        keys.press("Enter")
        expect(page.get_by_placeholder("Which outcome …")).to_have_count(0)
        keys.type("finished")
        keys.press("Enter")
        at_step(page, "Check, save, and go to the run page")
        keys.press("Control+Enter")
        at_step(page, "Start it")
        require_two_states(shop)
        # It is disabled until the page knows the file as it was saved, and takes no focus before.
        expect(page.get_by_role("button", name="Start", exact=True)).to_be_enabled()
        show.press("Enter")
        expect(page.get_by_role("button", name="Start", exact=True)).to_be_focused()
        keys.press("Enter")
        at_step(page, "You have built a behavior and run it")
        tour(page).get_by_role("button", name="Finish").press("Enter")
        expect(tour(page)).to_have_count(0)


def test_the_tour_is_left_and_gone_on_with(browser: Browser, shop: Workshop) -> None:
    """By its cross, by a reload, from another page, from the sheet of keys; or begun anew."""
    with opened_page(browser, shop.running, size=LAPTOP) as page:
        page.get_by_role("button", name="Not now").click()
        page.get_by_role("button", name="Tour").click()
        page.get_by_role("button", name="New", exact=True).click()
        page.get_by_label("Name", exact=True).fill("first_steps")
        page.get_by_role("button", name="Create").click()
        at_step(page, "Add a first state")
        page.reload()
        at_step(page, "Add a first state")
        page.get_by_role("link", name="flexcell").click()
        expect(tour(page)).to_contain_text("This is done with first_steps.yaml, which is not on the page now.")
        tour(page).get_by_role("button", name="Leave the tour").click()
        expect(tour(page)).to_have_count(0)
        page.get_by_role("button", name="Go on with the tour").click()
        tour(page).get_by_role("button", name="Go there").click()
        expect(pill(page, "root", "finished")).to_be_visible()
        tour(page).get_by_role("button", name="Leave the tour").click()
        page.get_by_role("button", name="Keys").click()
        page.get_by_role("dialog").get_by_role("button", name="Go on with the tour").click()
        at_step(page, "Add a first state")
        tour(page).get_by_role("button", name="Restart").click()
        page.get_by_role("link", name="flexcell").click()
        at_step(page, "Make a behavior")


def test_a_viewer_is_not_invited_to_what_he_may_not_do(browser: Browser, shop: Workshop) -> None:
    """He can make nothing and run nothing."""
    login = shop.running.new_login_url(VIEWER)
    with opened_page(browser, shop.running, login=login) as page:
        expect(page.get_by_role("heading", name="Latest runs")).to_be_visible()
        expect(page.get_by_text("No runs yet").first).to_be_visible()
        expect(page.get_by_role("button", name="Tour")).to_have_count(0)


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [nightly(LAPTOP), PHONE])
def test_the_tour_is_accessible_and_fits(browser: Browser, shop: Workshop, size: Size, scheme: Scheme) -> None:
    """Invitation, card, card in a dialog; on a phone it begins at the menu."""
    with opened_page(browser, shop.running, size=size, scheme=scheme) as page:
        expect(page.get_by_role("region", name="First steps")).to_be_visible()
        require_accessible(page, f"invitation, {scheme} {size}")
        page.get_by_role("region", name="First steps").get_by_role("button", name="Tour").click()
        at_step(page, "Make a behavior")
        if size == PHONE:
            require_ring_around(page, page.get_by_role("button", name="Open the menu"))
            page.get_by_role("button", name="Open the menu").click()
        require_ring_around(page, page.get_by_role("button", name="New", exact=True))
        require_accessible(page, f"first step, {scheme} {size}")
        page.get_by_role("button", name="New", exact=True).click()
        at_step(page, "Give it a name")
        expect(tour(page)).to_be_in_viewport(ratio=1)
        require_accessible(page, f"in a dialog, {scheme} {size}")
        require_fit(page, size[0])
