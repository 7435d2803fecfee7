"""What happens in the editor while an edit is on its way to the server, or does not get there."""

from __future__ import annotations

from playwright.sync_api import Browser, Page, Route, expect

from tests.editor_web.browsing import until
from tests.editor_web.editing import at_editor, card, idle
from tests.editor_web.workshop import SHIFT_ID, Workshop


def test_the_first_change_is_taken_back_before_the_server_has_answered(browser: Browser, shop: Workshop) -> None:
    """The key is pressed as soon as one sees what one has done, which may be sooner than the answer."""
    held: list[Route] = []
    with at_editor(browser, shop, SHIFT_ID) as page:
        nodes = page.locator(".react-flow__node")
        before = nodes.count()
        # Playwright keeps handlers by attributes that a method of a list does not take.
        page.route("**/edits", lambda route: held.append(route))  # noqa: PLW0108
        card(page, "root/set").click()
        with page.expect_request("**/edits"):
            page.keyboard.press("Control+d")
        page.keyboard.press("Control+z")
        until(page, lambda: bool(held))
        with page.expect_response("**/edits"):
            held[0].continue_()
        expect(page.get_by_role("button", name="Redo")).to_be_enabled()
        idle(page)
        expect(nodes).to_have_count(before)
        expect(page.locator("[data-unsaved]")).to_have_count(0)


def test_a_node_whose_move_does_not_reach_the_server_goes_back_to_its_place(browser: Browser, shop: Workshop) -> None:
    """What is seen is what is in the document."""
    with at_editor(browser, shop, SHIFT_ID, quiet=False) as page:
        before: str = card(page, "root/set").evaluate("(node) => getComputedStyle(node).transform")
        there = card(page, "root/set").bounding_box()
        assert there is not None
        page.route("**/edits", lambda route: route.abort())
        page.mouse.move(there["x"] + 60, there["y"] + 12)
        page.mouse.down()
        page.mouse.move(there["x"] + 160, there["y"] + 72, steps=6)
        page.mouse.up()
        expect(page.locator("[data-notice='refused']")).to_contain_text("Move")
        expect(card(page, "root/set")).to_have_css("transform", before)


def first_held(page: Page) -> list[Route]:
    """From now on the first edit is held, and stands here once it was sent; those after it pass."""
    held: list[Route] = []

    def hold(route: Route) -> None:
        if held:
            route.continue_()
        else:
            held.append(route)

    page.route("**/edits", hold)
    return held


def test_what_is_declared_while_another_change_is_on_its_way_is_declared_as_well(
    browser: Browser, shop: Workshop
) -> None:
    """Keys are sent all together: those of before, and those that come in between."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.get_by_role("tab", name="Behavior").click()
        held = first_held(page)
        for name in ("first_key", "second_key"):
            page.get_by_label("New key", exact=True).fill(name)
            page.get_by_role("button", name="Add: New key").click()
            until(page, lambda: bool(held))
        held[0].continue_()
        expect(page.get_by_label("Value of second_key")).to_be_visible()
        expect(page.get_by_label("Value of first_key")).to_be_visible()
