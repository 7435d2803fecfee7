"""Several runs, interrupted runs and the arms of the cell, in a real browser."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Browser, expect

from engine.event import StopRequested
from engine.runtime.run_options import RunOptions
from tests.editor_web.browsing import opened_page, require_accessible, switch
from tests.editor_web.workshop import NAP, NAP_ID, Workshop
from tests.engine.cli.process import entered, run_id_in, started, until


def test_several_runs_go_on_side_by_side(browser: Browser, shop: Workshop) -> None:
    """Each with its own truth; the one behavior cannot be started twice, another one can."""
    nap = shop.start(NAP_ID)
    shift = shop.start(supervision=RunOptions(start_paused=True))
    with opened_page(browser, shop.running, f"/runs/{nap}") as page:
        runs = page.get_by_role("navigation", name="Runs")
        expect(runs.get_by_role("link")).to_have_count(2)
        expect(runs).to_contain_text("Paused")
        expect(page.locator("h1")).to_have_text("nap")
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Running")
        expect(page.get_by_role("button", name="Start")).to_be_disabled()
        page.get_by_role("button", name="Pause", exact=True).click()
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Paused")
        runs.get_by_role("link", name="shift").click()
        expect(page.get_by_role("list", name="Nodes that wait")).to_contain_text("root before its entry: paused")
        expect(page.get_by_role("link", name="+ 1 other")).to_be_visible()
        page.get_by_role("button", name="Stop this run").click()
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Stopped")
        expect(page.get_by_text("Another run is active")).to_be_visible()
        page.get_by_role("button", name="Start").click()
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Running")
        expect(runs.get_by_role("link")).to_have_count(3)
    statuses = {run.id: run.status for run in shop.session.runs()}
    assert (statuses[nap], statuses[shift]) == ("running", "stopped")


def test_an_interrupted_run_asks_and_goes_on(browser: Browser, tmp_path: Path, loopback: str) -> None:
    """Why it asks, each state with its ways, and what was in mid-work is taken as the operator says."""
    (tmp_path / "behaviors").mkdir()
    (tmp_path / NAP_ID).write_text(NAP, encoding="utf-8")
    with started("run", tmp_path / NAP_ID, "-q", cwd=tmp_path) as process:
        until(process, tmp_path, entered("root/only"))
    run = run_id_in(tmp_path)
    with Workshop(host=loopback, project=tmp_path) as shop, opened_page(browser, shop.running, quiet=False) as page:
        found = page.get_by_role("listitem", name="Interrupted run of nap")
        expect(found).to_contain_text("its engine ended in the middle of it")
        found.get_by_role("button", name="Resume").click()
        expect(found).to_contain_text("nobody knows whether they had their effect")
        go_on = found.get_by_role("button", name="Go on with these answers")
        expect(go_on).to_be_disabled()
        require_accessible(page, "an interrupted run")
        question = found.get_by_role("radiogroup", name="root/only")
        expect(question.get_by_role("radio")).to_have_count(2)
        switch(question.get_by_label("It ended with done"))
        go_on.click()
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Succeeded: good")
        expect(page.get_by_role("log")).to_contain_text("resumed after event")
        page.get_by_role("link", name="flexcell").click()
        expect(page.get_by_role("heading", name="Interrupted runs")).to_have_count(0)
        assert shop.session.run(run).outcome == "good"


def test_an_arm_stands_in_full_below_the_view_of_the_cell(browser: Browser, shop: Workshop) -> None:
    with opened_page(browser, shop.running) as page:
        arms = page.get_by_role("list", name="Arms")
        expect(arms.get_by_role("listitem", name="Arm left")).to_be_visible()
        hidden_px: int = arms.evaluate("(list) => list.scrollHeight - list.clientHeight")
    assert hidden_px <= 1


def test_the_cell_is_stopped_with_everything_in_it(browser: Browser, shop: Workshop) -> None:
    """All runs, from the page of the cell."""
    runs = (shop.start(), shop.start(NAP_ID))
    with opened_page(browser, shop.running) as page:
        stop = page.get_by_role("button", name="Stop the cell")
        expect(stop).to_have_attribute("title", re.compile("This is no emergency stop"))
        stop.click()
        expect(page.get_by_role("status", name="State of the stop")).to_contain_text("All arms at rest")
        expect(page.get_by_role("table").locator("span[data-status]", has_text="stopped")).to_have_count(2)
    for run in runs:
        reasons = [event.reason for event in shop.events(run) if isinstance(event, StopRequested)]
        assert reasons == ["the cell was stopped in the dashboard"]
