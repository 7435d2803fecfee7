"""The bar of a run in a real browser, against a real session: pause, steps, autonomy, hot change, refusals, keys."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from engine.event import GateReached, OperatorChanged, OperatorCommanded
from engine.runtime.run_options import RunOptions
from tests.editor_web.browsing import PHONE, Scheme, Size, opened_page, require_accessible, require_fit, switch
from tests.editor_web.workshop import SHIFT, SHIFT_ID, Workshop
from tests.tiers import nightly

LAPTOP: Size = (1280, 800)
# WCAG 2.2, 2.5.8: the least size of a target.
TARGET_PX = 24


@contextmanager
def at_shift(
    browser: Browser,
    shop: Workshop,
    *,
    size: Size = LAPTOP,
    scheme: Scheme = "light",
    quiet: bool = True,
) -> Generator[Page]:
    """The page of the behavior `shift`."""
    path = f"/behaviors/{SHIFT_ID}"
    with opened_page(browser, shop.running, path, size=size, scheme=scheme, quiet=quiet) as page:
        expect(node(page, "root/first")).to_be_visible()
        yield page


def node(page: Page, path: str) -> Locator:
    """A node of the graph."""
    return page.locator(f".react-flow__node[data-id='{path}'] [data-node]")


def command(page: Page, name: str) -> Locator:
    """A button by its whole name."""
    return page.get_by_role("button", name=name, exact=True)


def require_apart(page: Page, left: str, right: str) -> None:
    """Two buttons beside one another are each as wide as a target must be, and neither is over the other."""
    first, second = command(page, left).bounding_box(), command(page, right).bounding_box()
    assert first is not None
    assert second is not None
    assert first["x"] + first["width"] <= second["x"]
    assert min(first["width"], second["width"]) >= TARGET_PX


def run_state(page: Page) -> Locator:
    """How the run stands, in words."""
    return page.get_by_role("status", name="State of the run")


def commands_of(shop: Workshop, run: str) -> list[str]:
    """What was commanded, in order."""
    return [event.command for event in shop.events(run) if isinstance(event, OperatorCommanded)]


def test_a_run_is_paused_stepped_and_resumed(browser: Browser, shop: Workshop) -> None:
    """Begun paused from the form; where it waits is marked on the graph and said in words."""
    with at_shift(browser, shop) as page:
        page.get_by_role("button", name="Operation").click()
        switch(page.get_by_label("Begin paused"))
        page.get_by_role("button", name="Start").click()
        expect(run_state(page)).to_have_text("Paused")
        expect(command(page, "Resume")).to_be_enabled()
        waits = page.get_by_role("list", name="Nodes that wait")
        expect(waits).to_have_text("root before its entry: paused")
        command(page, "Step into").click()
        expect(waits).to_have_text("root/first before its entry: paused")
        expect(node(page, "root/first").locator('[data-mark="waits"]')).to_be_visible()
        expect(node(page, "root/first")).to_contain_text("paused")
        command(page, "Step over").click()
        expect(waits).to_have_text("root/set before its entry: paused")
        command(page, "Step over").click()
        expect(waits).to_have_text("root/both before its entry: paused")
        command(page, "Step into").click()
        expect(waits).to_contain_text("root/both/left before its entry: paused")
        command(page, "Step out").click()
        expect(waits).to_have_text("root/both/right before its entry: paused")
        command(page, "Step out").click()
        expect(waits).to_have_text("root/both with finished: paused")
        command(page, "Resume").click()
        expect(node(page, "root/rest")).to_have_attribute("data-status", "active")
        expect(run_state(page)).to_have_text("Running")
        command(page, "Pause").click()
        expect(run_state(page)).to_have_text("Paused")
        page.get_by_role("button", name="Stop this run").click()
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Stopped")
        expect(command(page, "Pause")).to_be_disabled()
    (run,) = shop.session.runs()
    expected = ["step", "step", "step", "step", "step", "step", "resume", "pause"]
    assert commands_of(shop, run.id)[-len(expected) :] == expected


def test_a_run_is_stepped_back_by_button_and_by_key(browser: Browser, shop: Workshop) -> None:
    """The graph shows what was taken back as not entered; what cannot be undone is refused with the reason."""
    run = shop.start(supervision=RunOptions(start_paused=True))
    with at_shift(browser, shop, quiet=False) as page:
        waits = page.get_by_role("list", name="Nodes that wait")
        for path in ("root/first", "root/set", "root/both"):
            command(page, "Step over" if path != "root/first" else "Step into").click()
            expect(waits).to_have_text(f"{path} before its entry: paused")
        expect(node(page, "root/set")).to_have_attribute("data-status", "done")
        command(page, "Step back").click()
        expect(waits).to_have_text("root/set before its entry: paused")
        expect(node(page, "root/set")).to_have_attribute("data-status", "idle")
        page.keyboard.press("z")
        expect(page.get_by_role("alert")).to_contain_text("test.Give does not declare how to undo what it did")
        expect(waits).to_have_text("root/set before its entry: paused")
    assert commands_of(shop, run)[-1] == "step_back"


def test_the_file_as_it_is_now_takes_over_with_a_report(browser: Browser, shop: Workshop) -> None:
    """And where that is impossible, the reasons; the graph shows the new version."""
    shop.start(supervision=RunOptions(start_paused=True))
    file = shop.project / SHIFT_ID
    with at_shift(browser, shop, quiet=False) as page:
        expect(run_state(page)).to_have_text("Paused")
        file.write_text(
            SHIFT.replace("value: 1}", "value: 2}").replace("set: {", "put: {").replace("a: set", "a: put"),
            encoding="utf-8",
        )
        command(page, "Apply changes").click()
        report = page.get_by_role("dialog")
        expect(report).to_contain_text("root/put is added")
        expect(report).to_contain_text("root/set is removed")
        expect(report).to_contain_text("root/first has changed transitions")
        page.get_by_role("button", name="Understood").click()
        expect(node(page, "root/put")).to_be_visible()
        expect(node(page, "root/set")).to_have_count(0)
        file.write_text(
            SHIFT.replace("  machine:", "  priority:").replace("    initial: first\n", ""), encoding="utf-8"
        )
        command(page, "Apply changes").click()
        expect(page.get_by_role("alert")).to_contain_text("Apply the current file was refused")


def test_what_runs_is_given_up_for_the_file_by_a_button_of_its_own(browser: Browser, shop: Workshop) -> None:
    """The plain one says what stands against it; the report of the other one names what was entered anew."""
    slow = SHIFT.replace("default: 0.0", "default: 100.0")
    file = shop.project / SHIFT_ID
    file.write_text(slow, encoding="utf-8")
    shop.start()
    with at_shift(browser, shop, quiet=False) as page:
        expect(node(page, "root/first")).to_have_attribute("data-status", "active")
        command(page, "Pause").click()
        expect(run_state(page)).to_have_text("Paused")
        other = "{state: flow.Wait, with: {duration_s: 0}, transitions: {done: set}}"
        given = '{state: test.Give, with: {after_s: "${dwell}"}, transitions: {a: set, b: bad, c: bad}}'
        assert given in slow
        file.write_text(slow.replace(given, other), encoding="utf-8")
        command(page, "Apply changes").click()
        expect(page.get_by_role("alert")).to_contain_text("root/first is active as test.Give and becomes flow.Wait")
        command(page, "Apply changes and preempt").click()
        expect(page.get_by_role("dialog")).to_contain_text("root/first is preempted and entered anew")
        page.get_by_role("button", name="Understood").click()
        command(page, "Resume").click()
        expect(node(page, "root/rest")).to_have_attribute("data-status", "active")


def test_single_keys_are_commands_and_can_be_switched_off(browser: Browser, shop: Workshop) -> None:
    """A sheet lists them; nothing happens while somebody writes."""
    run = shop.start(supervision=RunOptions(start_paused=True))
    with at_shift(browser, shop) as page:
        expect(run_state(page)).to_have_text("Paused")
        page.get_by_role("searchbox").or_(page.get_by_label("Find in the log")).first.fill("pp")
        assert shop.on_loop(lambda: shop.session.control(run).view().paused)
        page.locator("h1").click()
        page.keyboard.press("i")
        expect(page.get_by_role("list", name="Nodes that wait")).to_contain_text("root/first")
        page.keyboard.press("g")
        expect(page.get_by_role("region", name="Node root/first")).to_be_visible()
        page.keyboard.press("b")
        expect(page.get_by_role("button", name="Breakpoint before root/first")).to_have_attribute(
            "aria-pressed", "true"
        )
        page.keyboard.press("l")
        expect(page.get_by_role("button", name="Unlock", exact=True)).to_be_visible()
        page.keyboard.press("f")
        expect(page.get_by_role("group", name="Force an outcome").get_by_role("button").first).to_be_focused()
        page.keyboard.press("a")
        expect(page.get_by_role("alert")).to_contain_text("Answer was refused: the run asks nothing")
        page.keyboard.press("?")
        sheet = page.get_by_role("dialog", name="Keyboard")
        expect(sheet).to_contain_text("Pause, or resume a paused run")
        switch(sheet.get_by_label("Single keys are commands"), on=False)
        sheet.get_by_role("button", name="Close", exact=True).click()
        expect(sheet).to_have_count(0)
        before = len(shop.events(run))
        page.keyboard.press("p")
        command(page, "Keys").click()
        switch(page.get_by_label("Single keys are commands"))
        page.keyboard.press("Escape")
        expect(page.get_by_role("dialog")).to_have_count(0)
        assert len(shop.events(run)) == before
        page.keyboard.press("p")
        expect(run_state(page)).not_to_have_text("Paused")
        page.keyboard.press("Shift+S")
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Stopped")


def test_a_second_browser_and_a_reload_show_the_same(browser: Browser, shop: Workshop) -> None:
    """What one page commands, the other shows; an operating page is one again after its reload."""
    run = shop.start(supervision=RunOptions(start_paused=True, autonomy="low"))
    with at_shift(browser, shop) as first, at_shift(browser, shop) as second:
        command(first, "Take control").click()
        expect(command(first, "Take control")).to_have_attribute("aria-pressed", "true")
        expect(
            first.get_by_text("You operate this run. If this page is lost, 5 s later the run is paused.")
        ).to_be_visible()
        expect(second.get_by_text("Another page or console operates this run.")).to_be_visible()
        command(first, "Step into").click()
        expect(second.get_by_role("list", name="Nodes that wait")).to_contain_text("root/first")
        first.reload()
        expect(command(first, "Take control")).to_have_attribute("aria-pressed", "true")
        expect(first.get_by_role("list", name="Nodes that wait")).to_contain_text("root/first")
        expect(second.get_by_text("Another page or console operates this run.")).to_be_visible()
        command(second, "Resume").click()
        expect(first.get_by_role("status", name="State of the run")).to_have_text("Waiting for answer")
        expect(first.get_by_role("region", name="The run asks")).to_be_visible()
        command(first, "Take control").click()
        expect(first.get_by_text("This run has no operator: it asks nothing.")).to_be_visible()
    changes = [event.status for event in shop.events(run) if isinstance(event, OperatorChanged)]
    assert changes == ["attached", "lost", "attached", "detached"]


def test_a_lost_page_is_an_operator_lost(browser: Browser, shop: Workshop) -> None:
    """The other page reads it, and what the policy did."""
    shop.start(supervision=RunOptions(start_paused=True, loss_policy="stop", loss_timeout_s=0.2))
    with at_shift(browser, shop) as watching:
        with at_shift(browser, shop) as page:
            command(page, "Take control").click()
            expect(page.get_by_text("If this page is lost, 0.2 s later the run is stopped.")).to_be_visible()
        expect(watching.get_by_role("log")).to_contain_text("operator lost")
        expect(watching.get_by_role("status", name="State of the run")).to_have_text("Stopped")
        expect(watching.get_by_role("log")).to_contain_text("stop requested: the operator was lost")


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [nightly(LAPTOP), PHONE])
def test_an_operated_run_is_accessible_and_fits(browser: Browser, shop: Workshop, size: Size, scheme: Scheme) -> None:
    """With everything open that can be; nothing to scroll sideways."""
    run = shop.start(supervision=RunOptions(autonomy="off", demand_operator=True))
    shop.on_loop(lambda: shop.arm.become("reflex", error="external torque of joint 4 above 20 N m"))
    with opened_page(browser, shop.running, f"/behaviors/{SHIFT_ID}", size=size, scheme=scheme) as page:
        expect(page.get_by_role("region", name="The run asks")).to_be_visible()
        require_fit(page, *size)
        require_apart(page, "Stop this run", "Stop the cell")
        if size == PHONE:
            page.get_by_role("tab", name="Graph").click()
        node(page, "root/rest").click()
        expect(page.get_by_role("region", name="Node root/rest")).to_be_visible()
        page.get_by_label("Pause before its entry").click()
        expect(page.get_by_role("combobox", name="Only if")).to_be_visible()
        command(page, "Step into").click(force=True)
        require_accessible(page, f"a node and a refusal, {scheme} {size}")
        page.get_by_role("tab", name="Breakpoints").click()
        require_accessible(page, f"breakpoints, {scheme} {size}")
        command(page, "Keys").click()
        expect(page.get_by_role("dialog")).to_be_visible()
        require_accessible(page, f"keys, {scheme} {size}")
    assert any(isinstance(event, GateReached) for event in shop.events(run))
