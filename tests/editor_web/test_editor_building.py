"""A behavior is built from nothing in a real browser, by mouse and by keyboard only, checked, saved and run."""

from __future__ import annotations

from playwright.sync_api import Browser, Page, expect

from engine.document import load_behavior
from tests.editor_web.browsing import opened_page
from tests.editor_web.editing import LAPTOP, at_editor, card, drag, file_text, idle, pill, port, save
from tests.editor_web.workshop import SHIFT_ID, Workshop

MADE = "behaviors/two_steps.yaml"


def require_run_finishes(page: Page) -> None:
    """The run page is there; start, and see the behavior finish."""
    expect(page.locator('[data-node="leaf"]').first).to_be_visible()
    page.get_by_role("button", name="Start", exact=True).click()
    expect(page.get_by_role("status", name="State of the run")).to_have_text("Succeeded")


def require_two_steps(shop: Workshop) -> None:
    """What was built is what was meant."""
    behavior = load_behavior(shop.project / MADE)
    states = behavior.root.children
    assert {name: node.state for name, node in states.items()} == {"wait": "flow.Wait", "log": "flow.Log"}
    assert states["wait"].parameters == {"duration_s": 0.05}
    assert states["log"].parameters == {"message": "done waiting"}
    assert [dict(node.transitions) for node in states.values()] == [{"done": "log"}, {"done": "finished"}]
    assert behavior.root.machine is not None
    assert behavior.root.machine.initial == "wait"


def test_two_states_are_built_from_nothing_by_mouse_checked_saved_and_run(browser: Browser, shop: Workshop) -> None:
    """New, drag two states in, fill their forms, wire them, run."""
    with opened_page(browser, shop.running, "/", size=LAPTOP) as page:
        page.get_by_role("button", name="New", exact=True).click()
        page.get_by_label("Name", exact=True).fill("two_steps")
        page.get_by_role("button", name="Create").click()
        canvas = page.locator("[data-canvas]")
        expect(pill(page, "root", "finished")).to_be_visible()
        page.get_by_role("button", name="Add flow.Wait").drag_to(canvas, target_position={"x": 200, "y": 300})
        expect(card(page, "root/wait")).to_be_visible()
        page.get_by_role("combobox", name="duration_s").fill("0.05")
        page.get_by_role("combobox", name="duration_s").press("Tab")
        page.get_by_role("button", name="Add flow.Log").drag_to(canvas, target_position={"x": 600, "y": 100})
        expect(card(page, "root/log")).to_be_visible()
        page.get_by_role("combobox", name="message").fill("done waiting")
        page.get_by_role("combobox", name="message").press("Tab")
        expect(page.locator("[data-outcome][data-loose]")).to_have_count(1)
        drag(page, port(page, "root/log", "done"), pill(page, "root", "finished"))
        expect(page.locator("[data-outcome][data-loose]")).to_have_count(0)
        expect(page.locator("[data-problem-count]")).not_to_contain_text("error")
        page.get_by_role("button", name="Run", exact=True).click()
        expect(page.get_by_role("button", name="Start", exact=True)).to_be_visible()
        require_two_steps(shop)
        require_run_finishes(page)


def test_two_states_are_built_from_nothing_by_keyboard_only(browser: Browser, shop: Workshop) -> None:
    """Not one press of the mouse."""
    with opened_page(browser, shop.running, "/", size=LAPTOP) as page:
        keys = page.keyboard
        page.get_by_role("button", name="New", exact=True).focus()
        keys.press("Enter")
        keys.type("two_steps")
        keys.press("Enter")
        expect(pill(page, "root", "finished")).to_be_visible()
        keys.press("a")
        keys.type("wait")
        keys.press("Enter")
        expect(card(page, "root/wait")).to_be_focused()
        keys.press("Enter")
        expect(page.get_by_role("combobox", name="duration_s")).to_be_focused()
        keys.type("0.05")
        keys.press("Enter")
        expect(page.locator("[data-field][data-problem]")).to_have_count(0)
        card(page, "root/wait").focus()
        keys.press("a")
        keys.type("flow.log")
        keys.press("Enter")
        expect(card(page, "root/log")).to_be_focused()
        keys.press("Enter")
        expect(page.get_by_role("combobox", name="message")).to_be_focused()
        keys.type("done waiting")
        keys.press("Enter")
        idle(page)
        card(page, "root/log").focus()
        keys.press("c")
        expect(page.get_by_placeholder("Which outcome …")).to_be_focused()
        keys.press("Enter")
        expect(page.get_by_placeholder("Which outcome …")).to_have_count(0)
        expect(page.locator("dialog[open]").get_by_role("combobox")).to_be_focused()
        keys.type("finished")
        keys.press("Enter")
        expect(page.locator("[data-outcome][data-loose]")).to_have_count(0)
        idle(page)
        keys.press("ArrowLeft")
        expect(card(page, "root/wait")).to_be_focused()
        keys.press("Control+Enter")
        expect(page.get_by_role("button", name="Start", exact=True)).to_be_visible()
        require_two_steps(shop)
        page.get_by_role("button", name="Start", exact=True).press("Enter")
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Succeeded")


def test_the_editor_is_reached_from_the_page_of_a_behavior_at_its_chosen_node(browser: Browser, shop: Workshop) -> None:
    """And what is chosen there is chosen here."""
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}", size=LAPTOP) as page:
        page.locator(".react-flow__node[data-id='root/both/left']").click()
        page.get_by_role("button", name="Edit", exact=True).click()
        expect(card(page, "root/both/left").locator("[data-card]")).to_have_attribute("data-selected", "true")


def test_a_running_draft_is_refused_while_it_has_errors(browser: Browser, shop: Workshop) -> None:
    """The problems come forward instead."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        card(page, "root/set").click()
        page.keyboard.press("Delete")
        expect(page.locator("[data-problem-count]")).to_contain_text("error")
        before = file_text(shop, SHIFT_ID)
        page.keyboard.press("Control+Enter")
        expect(page.get_by_role("alert")).to_contain_text("Run: there")
        expect(page.get_by_role("list", name="Problems")).to_be_visible()
        page.keyboard.press("Control+z")
        expect(page.locator("[data-problem-count]")).to_have_text("No problems")
        save(page)
        assert file_text(shop, SHIFT_ID) == before


def test_a_tree_and_a_concurrency_begin_from_nothing_too(browser: Browser, shop: Workshop) -> None:
    """What is added goes where it can; the rules are proposed."""
    with opened_page(browser, shop.running, "/", size=LAPTOP) as page:
        page.get_by_role("button", name="New", exact=True).click()
        page.get_by_label("Name", exact=True).fill("tries")
        page.get_by_label("Begins as").select_option("sequence")
        page.get_by_role("button", name="Create").click()
        expect(card(page, "root/sequence")).to_be_visible()
        for path in ("root/sequence/wait", "root/sequence/wait_2"):
            page.keyboard.press("a")
            page.keyboard.type("flow.wait")
            page.keyboard.press("Enter")
            expect(card(page, path)).to_be_focused()
        page.goto(shop.running.url)
        page.get_by_role("button", name="New", exact=True).click()
        page.get_by_label("Name", exact=True).fill("both")
        page.get_by_label("Begins as").select_option("concurrency")
        page.get_by_role("button", name="Create").click()
        expect(page.get_by_text("Nothing here yet.")).to_be_visible()
        for path in ("root/log", "root/log_2"):
            page.keyboard.press("a")
            page.keyboard.type("flow.log")
            page.keyboard.press("Enter")
            expect(card(page, path)).to_be_focused()
        page.keyboard.press("Escape")
        page.get_by_role("button", name="Add a rule").click()
        expect(page.locator("[data-card='rules']")).to_contain_text("finishedlog = done and log_2 = done")


def test_a_branching_is_built_by_keyboard_in_its_roles(browser: Browser, shop: Workshop) -> None:
    """What is added takes the next role, which its card shows."""
    with opened_page(browser, shop.running, "/", size=LAPTOP) as page:
        page.get_by_role("button", name="New", exact=True).click()
        page.get_by_label("Name", exact=True).fill("choice")
        page.get_by_label("Begins as").select_option("sequence")
        page.get_by_role("button", name="Create").click()
        expect(card(page, "root/sequence")).to_be_visible()
        inside = "root/sequence/if_then_else"
        for typed, path in (
            ("if, then", inside),
            ("flow.wait", f"{inside}/wait"),
            ("flow.log", f"{inside}/log"),
            ("flow.log", f"{inside}/log_2"),
        ):
            page.keyboard.press("a")
            page.keyboard.type(typed)
            page.keyboard.press("Enter")
            expect(card(page, path)).to_be_focused()
        expect(card(page, f"{inside}/log_2").locator("[data-role]")).to_have_text("else")
