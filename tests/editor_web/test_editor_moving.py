"""What is seen while something is dragged on the canvas of the editor, before it is let go."""

from __future__ import annotations

from playwright.sync_api import Browser, Locator, Page

from tests.editor_web.editing import at_editor, card, idle
from tests.editor_web.workshop import Workshop

NESTED_ID = "behaviors/nested.yaml"
NESTED = """
flexcell: 1
name: nested
outcomes: [good]
success: [good]
root:
  machine:
    initial: first
    states:
      first: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: around}}
      around:
        machine:
          initial: a
          states:
            a: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: b}}
            b: {state: flow.Wait, with: {duration_s: 1}, transitions: {done: over}}
        transitions: {over: good}
"""
BY = (60, 90)


def corner(part: Locator) -> tuple[float, float]:
    """Where something is on the screen."""
    box = part.bounding_box()
    assert box is not None
    return box["x"], box["y"]


def own_place(page: Page, path: str) -> tuple[str, str]:
    """Where React Flow has placed a node, and by how much its drawing is shifted."""
    style: list[str] = page.locator(f".react-flow__node[data-id='{path}']").evaluate(
        "(node) => [node.style.transform, node.style.translate]"
    )
    return style[0], style[1]


def line(page: Page, arrow: str) -> Locator:
    """An arrow."""
    return page.locator(f".react-flow__edge[data-id='{arrow}'] [data-line]")


def test_what_is_in_a_dragged_container_comes_along_and_its_arrows_keep_their_course(
    browser: Browser, shop: Workshop
) -> None:
    (shop.project / NESTED_ID).write_text(NESTED, encoding="utf-8")
    with at_editor(browser, shop, NESTED_ID) as page:
        inside = (card(page, "root/around/a"), line(page, "root/around|a|done"))
        into = line(page, "root|first|done")
        before = [corner(part) for part in inside]
        frame, placed = corner(card(page, "root/around")), own_place(page, "root/around/a")
        courses = [arrow.get_attribute("d") for arrow in (inside[1], into)]
        x, y = corner(card(page, "root/around").locator("[data-head]"))
        page.mouse.move(x + 40, y + 12)
        page.mouse.down()
        page.mouse.move(x + 40 + BY[0], y + 12 + BY[1], steps=6)
        page.wait_for_function(
            "(to) => document.querySelector(\"[data-id='root/around/a']\").getBoundingClientRect().y > to",
            arg=before[0][1] + 40,
        )
        after = [corner(part) for part in inside]
        moved = [(there[0] - here[0], there[1] - here[1]) for here, there in zip(before, after, strict=True)]
        assert all(abs(moved[0][axis] - moved[1][axis]) < 3 for axis in (0, 1))
        assert inside[1].get_attribute("d") == courses[0]
        # Its contents are shifted as one; nothing in it is placed anew with each frame.
        dragged = corner(card(page, "root/around"))
        assert all(abs(dragged[axis] - frame[axis] - moved[0][axis]) < 3 for axis in (0, 1))
        assert own_place(page, "root/around/a")[0] == placed[0]
        assert placed[1] == ""
        # The one from outside is drawn anew from port to port.
        assert into.get_attribute("d") != courses[1]
        page.mouse.up()
        idle(page)
        assert inside[1].get_attribute("d") is not None
        assert own_place(page, "root/around/a")[1] == ""
        rested = [corner(part) for part in (card(page, "root/around"), inside[0])]
        assert all(abs(rested[1][axis] - rested[0][axis] - before[0][axis] + frame[axis]) < 3 for axis in (0, 1))
