"""Building on the canvas in a real browser: adding, wiring, grouping, copying, moving, trees, going in and out."""

from __future__ import annotations

import pytest
from playwright.sync_api import Browser, Page, expect

from engine.document import Behavior, load_behavior
from tests.editor_web.editing import at_editor, card, drag, file_text, idle, pill, port, save
from tests.editor_web.workshop import NAP_ID, SHIFT_ID, Workshop
from tests.tiers import nightly

TREE_ID = "behaviors/tries.yaml"
TREE = """
flexcell: 1
name: tries
outcomes: [success, failure]
success: [success]
root:
  tree:
    selector:
      - sequence:
          - {state: flow.Wait, name: short, with: {duration_s: 0.1}}
          - {state: flow.Wait, name: long, with: {duration_s: 0.2}}
      - {state: flow.Log, with: {message: nothing helped}}
"""


def saved(page: Page, shop: Workshop, behavior_id: str = SHIFT_ID) -> Behavior:
    """Save, and read what is on disk."""
    idle(page)
    save(page)
    return load_behavior(shop.project / behavior_id)


def transitions(behavior: Behavior, name: str) -> dict[str, str]:
    """Where a child of the root leads."""
    return dict(behavior.root.children[name].transitions)


def on_edge(page: Page, arrow: str, share: float) -> tuple[float, float]:
    """A point on an arrow, on the screen."""
    line = page.locator(f".react-flow__edge[data-id='{arrow}'] [data-line]")
    expect(line).to_have_count(1)
    idle(page)
    at = line.evaluate(
        """(path, share) => {
            const point = path.getPointAtLength(path.getTotalLength() * share).matrixTransform(path.getScreenCTM())
            return [point.x, point.y]
        }""",
        share,
    )
    return at[0], at[1]


def edge(page: Page, arrow: str) -> None:
    """Choose an arrow by a click on it, beside its plus."""
    page.mouse.click(*on_edge(page, arrow, 0.3))
    expect(page.get_by_role("tab", name="Arrow")).to_be_visible()


def test_outcomes_are_led_elsewhere_by_dragging_from_port_to_node_and_outcome(browser: Browser, shop: Workshop) -> None:
    """A port that is connected already is drawn anew."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        drag(page, port(page, "root/set", "done"), card(page, "root/rest"))
        idle(page)
        expect(page.locator(".react-flow__edge[data-id='root|set|done']")).to_have_accessible_name(
            "done of set leads to rest"
        )
        drag(page, port(page, "root/first", "b"), pill(page, "root", "good"))
        behavior = saved(page, shop)
    assert transitions(behavior, "set") == {"done": "rest"}
    assert transitions(behavior, "first") == {"a": "set", "b": "good", "c": "bad"}


def test_an_arrow_dropped_in_the_open_asks_what_comes_there(browser: Browser, shop: Workshop) -> None:
    """A new state, connected."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        drag(page, port(page, "root/first", "c"), page.locator("[data-canvas]"), at=(690, 40))
        expect(page.get_by_role("dialog", name="first: c leads to")).to_be_visible()
        page.keyboard.type("log")
        page.keyboard.press("Enter")
        expect(card(page, "root/log")).to_be_visible()
        behavior = saved(page, shop)
    assert transitions(behavior, "first")["c"] == "log"
    assert behavior.root.children["log"].state == "flow.Log"


def test_a_state_is_inserted_on_an_arrow_by_its_plus_and_by_dropping(browser: Browser, shop: Workshop) -> None:
    """What was connected stays connected, through it."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.mouse.move(*on_edge(page, "root|first|a", 0.5))
        page.mouse.click(*on_edge(page, "root|first|a", 0.5))
        expect(page.get_by_role("dialog", name="Insert after first: a")).to_be_visible()
        page.keyboard.type("flow.log")
        page.keyboard.press("Enter")
        expect(card(page, "root/log")).to_be_visible()
        idle(page)
        page.keyboard.press("f")
        idle(page)
        canvas = page.locator("[data-canvas]").bounding_box()
        assert canvas is not None
        x, y = on_edge(page, "root|log|done", 0.5)
        page.get_by_role("button", name="Add flow.Wait").drag_to(
            page.locator("[data-canvas]"), target_position={"x": x - canvas["x"], "y": y - canvas["y"]}
        )
        expect(card(page, "root/wait")).to_be_visible()
        behavior = saved(page, shop)
    assert [transitions(behavior, name)[out] for name, out in (("first", "a"), ("log", "done"), ("wait", "done"))] == [
        "log",
        "wait",
        "set",
    ]


def test_an_arrow_is_deleted_and_its_end_drawn_elsewhere(browser: Browser, shop: Workshop) -> None:
    """Chosen by a click; its head taken to another node."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        edge(page, "root|set|done")
        page.keyboard.press("Delete")
        expect(port(page, "root/set", "done").locator("..")).to_have_attribute("data-loose", "true")
        behavior_text = file_text(shop, SHIFT_ID)
        page.keyboard.press("Control+z")
        expect(page.locator(".react-flow__edge[data-id='root|set|done']")).to_have_count(1)
        head = page.locator(".react-flow__edge[data-id='root|first|a'] .react-flow__edgeupdater-target")
        drag(page, head, card(page, "root/rest"))
        behavior = saved(page, shop)
    assert file_text(shop, SHIFT_ID) != behavior_text
    assert transitions(behavior, "first")["a"] == "rest"


def test_several_are_chosen_by_a_box_grouped_and_ungrouped(browser: Browser, shop: Workshop) -> None:
    """What leads out of the group are its outcomes; ungrouped, the file is as before."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        first, second = card(page, "root/first").bounding_box(), card(page, "root/set").bounding_box()
        assert first is not None
        assert second is not None
        page.get_by_role("button", name="Drag a box to choose").click()
        page.mouse.move(first["x"] - 12, first["y"] - 14)
        page.mouse.down()
        page.mouse.move(second["x"] + second["width"] + 8, first["y"] + first["height"] - 30, steps=8)
        page.mouse.up()
        expect(page.locator("[data-card][data-selected]")).to_have_count(2)
        page.keyboard.press("Control+g")
        expect(card(page, "root/group")).to_be_visible()
        grouped = saved(page, shop)
        page.keyboard.press("Control+Shift+g")
        expect(card(page, "root/group")).to_have_count(0)
        expect(card(page, "root/first")).to_be_visible()
        idle(page)
        save(page)
        again = load_behavior(shop.project / SHIFT_ID)
    assert set(grouped.root.children["group"].children) == {"first", "set"}
    assert set(grouped.root.children) == {"group", "both", "rest"}
    assert set(again.root.children) == {"first", "set", "both", "rest"}
    assert transitions(again, "set") == {"done": "both"}


def test_nodes_are_copied_within_and_into_another_behavior(browser: Browser, shop: Workshop) -> None:
    """As text, so that it can go anywhere."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.context.grant_permissions(["clipboard-read", "clipboard-write"])
        card(page, "root/both").locator("[data-head]").click()
        page.keyboard.press("Control+c")
        expect(page.get_by_text("Copied both")).to_be_visible()
        assert "concurrency:" in page.evaluate("() => navigator.clipboard.readText()")
        page.keyboard.press("Control+v")
        expect(card(page, "root/both_2")).to_be_visible()
        behavior = saved(page, shop)
        assert set(behavior.root.children["both_2"].children) == {"left", "right"}
        page.goto(f"{shop.running.url}edit/{NAP_ID}")
        expect(card(page, "root/only")).to_be_visible()
        card(page, "root/only").click()
        page.keyboard.press("Control+v")
        expect(card(page, "root/both")).to_be_visible()
        other = saved(page, shop, NAP_ID)
    assert set(other.root.children) == {"only", "both"}


def test_a_node_that_is_dragged_stays_where_it_was_put(browser: Browser, shop: Workshop) -> None:
    """Positions are kept beside the meaning; laying out forgets them."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        meaning = load_behavior(shop.project / SHIFT_ID).meaning
        start = card(page, "root/rest").bounding_box()
        assert start is not None
        drag(page, card(page, "root/rest").locator("[data-head]"), page.locator("[data-canvas]"), at=(560, 120))
        idle(page)
        behavior = saved(page, shop)
        assert set(behavior.document.view) == {f"root/{name}" for name in ("first", "set", "both", "rest")}
        assert behavior.meaning == meaning
        there = card(page, "root/rest").bounding_box()
        assert there is not None
        assert abs(there["y"] - start["y"]) > 50
        page.reload()
        expect(card(page, "root/rest")).to_be_visible()
        idle(page)
        page.keyboard.press("l")
        idle(page)
        assert saved(page, shop).document.view == {}


def test_a_node_dragged_into_a_container_belongs_to_it(browser: Browser, shop: Workshop) -> None:
    """And the keyboard moves the children of a container in their order."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        drag(page, card(page, "root/set").locator("[data-head]"), card(page, "root/both").locator("[data-head]"))
        expect(card(page, "root/both/set")).to_be_visible()
        expect(card(page, "root/set")).to_have_count(0)
        idle(page)
        card(page, "root/both/set").click()
        page.keyboard.press("Alt+ArrowUp")
        idle(page)
        save(page)
        assert list(load_behavior(shop.project / SHIFT_ID).root.children["both"].children) == ["left", "set", "right"]


def test_a_tree_is_drawn_as_one_and_grows_under_its_branches(browser: Browser, shop: Workshop) -> None:
    """Children below their parent, in order; a new one is the last of its branch; Alt+arrows change the order."""
    (shop.project / TREE_ID).write_text(TREE, encoding="utf-8")
    with at_editor(browser, shop, TREE_ID) as page:
        boxes = [
            card(page, f"root/selector/{path}").bounding_box()
            for path in ("sequence", "sequence/short", "sequence/long", "Log")
        ]
        tops = [box["y"] for box in boxes if box is not None]
        lefts = [box["x"] for box in boxes if box is not None]
        assert tops[0] < tops[1] == tops[2]
        assert lefts[1] < lefts[2] < lefts[3]
        card(page, "root/selector/sequence").click()
        page.keyboard.press("a")
        page.keyboard.type("flow.decide")
        page.keyboard.press("Enter")
        expect(card(page, "root/selector/sequence/decide")).to_be_visible()
        page.keyboard.press("Alt+ArrowLeft")
        idle(page)
        save(page)
        text = file_text(shop, TREE_ID)
    assert text.index("flow.Decide") < text.index("name: long")
    assert text.index("flow.Decide") > text.index("name: short")


def test_one_goes_into_containers_and_out_again_by_mouse_and_keyboard(browser: Browser, shop: Workshop) -> None:
    """Enter, Escape, arrows, the breadcrumb, and open or close in place."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        crumb = page.get_by_label("Shown container")
        crumbs = crumb.get_by_role("button")
        card(page, "root/both").locator("[data-head]").click()
        page.keyboard.press("o")
        expect(card(page, "root/both/left")).to_have_count(0)
        expect(card(page, "root/both")).to_have_accessible_name(
            "Concurrency both, 2 nodes inside; finished to rest, odd to bad"
        )
        page.keyboard.press("Enter")
        expect(crumbs).to_have_text(["shift", "both"])
        expect(card(page, "root/both/left")).to_be_focused()
        page.keyboard.press("ArrowDown")
        expect(card(page, "root/both/right")).to_be_focused()
        expect(page.get_by_role("region", name="Rules")).to_have_count(0)
        page.keyboard.press("Escape")
        expect(crumbs).to_have_text(["shift"])
        expect(card(page, "root/both")).to_be_focused()
        card(page, "root/both").dblclick()
        expect(crumbs).to_have_text(["shift", "both"])
        crumb.get_by_role("button", name="shift").click()
        expect(card(page, "root/both").locator("[data-card]")).to_have_attribute("data-selected", "true")


def test_a_rule_preempts_some_branches_while_the_others_go_on(browser: Browser, shop: Workshop) -> None:
    """Then it has no outcome; the table and the canvas name whom it preempts."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        card(page, "root/both").locator("[data-head]").click()
        some = page.get_by_role("region", name="Rules").locator("details").nth(1)
        expect(some.locator("summary")).to_have_text("all")
        some.locator("summary").click()
        some.get_by_label("right", exact=True).click()
        expect(some.locator("summary")).to_have_text("right")
        expect(page.get_by_label("Outcome of rule 2")).to_have_count(0)
        expect(card(page, "root/both").locator("[data-rules]")).to_contain_text("preempt right")
        idle(page)
        save(page)
        node = load_behavior(shop.project / SHIFT_ID).root.children["both"]
    assert node.concurrency is not None
    second = node.concurrency.rules[1]
    assert (second.outcome, second.preempt, dict(second.when)) == ("", ("right",), {"left": "b"})


def test_conduct_data_and_the_document_itself_are_edited_in_forms(browser: Browser, shop: Workshop) -> None:
    """Timeout, retry, autonomy, `${…}` with completion, a new parameter."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.get_by_role("tab", name="Behavior").click()
        new = page.get_by_role("textbox", name="New parameter")
        new.fill("greeting")
        new.press("Enter")
        page.get_by_label("Type of greeting").select_option("string")
        box = page.get_by_role("combobox", name="Default of greeting")
        box.fill("hello")
        box.press("Enter")
        idle(page)
        card(page, "root/set").click()
        page.get_by_role("button", name="Write value as an expression").click()
        value = page.get_by_role("combobox", name="value", exact=True)
        value.fill("${gre")
        expect(page.get_by_role("option", name="greeting")).to_be_visible()
        value.press("Enter")
        expect(value).to_have_value("${greeting}")
        value.press("Enter")
        page.get_by_label("Autonomy of done").select_option("low")
        page.get_by_role("button", name="Guard, timeout, retry").click()
        timeout = page.get_by_role("combobox", name="Timeout", exact=True)
        timeout.fill("30 s")
        timeout.press("Enter")
        expect(page.get_by_label("Timeout target")).to_have_value("bad")
        behavior = saved(page, shop)
    node = behavior.root.children["set"]
    assert node.parameters == {"value": "${greeting}"}
    assert dict(node.autonomy) == {"done": "low"}
    assert node.timeout is not None
    assert (node.timeout.after_s, node.timeout.to) == (30.0, "bad")
    assert behavior.parameters["greeting"].default == "hello"


def test_every_command_is_in_the_palette_and_every_node_can_be_gone_to(browser: Browser, shop: Workshop) -> None:
    """Ctrl+K; and the sheet of keys."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        page.keyboard.press("Control+k")
        page.keyboard.type("right")
        page.keyboard.press("Enter")
        expect(card(page, "root/both/right").locator("[data-card]")).to_have_attribute("data-selected", "true")
        page.keyboard.press("Control+k")
        page.keyboard.type("duplicate")
        page.keyboard.press("Enter")
        expect(card(page, "root/both/right_2")).to_be_visible()
        page.keyboard.press("?")
        expect(page.get_by_role("dialog", name="Keyboard")).to_contain_text("Ctrl+Shift+Z")


PLACES = """() => JSON.stringify(
    [...document.querySelectorAll('.react-flow__node')].map((each) => {
        const { x, y, width } = each.getBoundingClientRect()
        return [each.dataset.id, x, y, width]
    }))"""
# Where the nodes are when the canvas says for the first time that it is busy no more.
WATCH = f"""() => {{
    const canvas = document.querySelector('[data-canvas]')
    window.wasBusy = false
    new MutationObserver(() => {{
        if (canvas.ariaBusy === 'true') window.wasBusy = true
        else window.rested ??= ({PLACES})()
    }}).observe(canvas, {{ attributeFilter: ['aria-busy'] }})
}}"""


@pytest.mark.parametrize("keys", [("-", "f"), nightly(("Control+d",)), nightly(("Enter",))])
def test_the_canvas_is_busy_until_all_that_is_on_it_rests(
    browser: Browser, shop: Workshop, keys: tuple[str, ...]
) -> None:
    """While all of it is brought into view, after an edit, and on the way into a container."""
    with at_editor(browser, shop, SHIFT_ID) as page:
        card(page, "root/both").locator("[data-head]").click()
        for key in keys[:-1]:
            page.keyboard.press(key)
            idle(page)
        page.evaluate(WATCH)
        page.keyboard.press(keys[-1])
        page.wait_for_function("() => window.wasBusy && window.rested")
        # As many frames as the longest animation could take.
        page.evaluate(
            """() => new Promise((done) => {
                let left = 30
                const look = () => (--left ? requestAnimationFrame(look) : done())
                look()
            })"""
        )
        assert page.evaluate("() => window.rested") == page.evaluate(PLACES)
