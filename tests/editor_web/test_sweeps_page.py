"""In a real browser: a sweep is made from the page and watched to its end, and a failing run of it is opened."""

from __future__ import annotations

import re
from pathlib import Path

from playwright.sync_api import Browser, expect

from engine.registry import load_states
from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import PHONE, opened_page, require_accessible, require_fit
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.workshop import Workshop
from tests.engine.sweep.luck_project import LuckProject


def test_a_sweep_is_made_watched_and_a_failing_run_of_it_opened(
    browser: Browser, tmp_path: Path, loopback: str
) -> None:
    """By the keyboard where that is more than a press of a button; nothing that axe-core finds, in both themes."""
    project = LuckProject(tmp_path)
    with Workshop(host=loopback, project=tmp_path, states=load_states(tmp_path)) as shop:
        (tmp_path / "behaviors" / "luck.yaml").write_bytes(project.behavior.read_bytes())
        with opened_page(browser, shop.running, "/sweeps") as page:
            page.get_by_role("button", name="New sweep").press("Enter")
            page.get_by_role("combobox", name="Behavior").select_option("behaviors/luck.yaml")
            page.get_by_role("textbox", name="Runs", exact=True).fill("12")
            page.get_by_role("button", name="Add a factor").press("Enter")
            option = page.locator("datalist option[value='parameters.luck']")
            expect(option).to_be_attached(timeout=GUARD_MS)
            page.get_by_label("What is varied", exact=True).fill("parameters.luck")
            expect(page.get_by_label("Greatest value of parameters.luck")).to_have_value("1")
            require_accessible(page, "the form of a sweep")
            page.get_by_role("button", name="Create and start").press("Enter")
            expect(page.get_by_role("heading", name="luck", exact=True)).to_be_visible(timeout=GUARD_MS)
            expect(page.get_by_role("progressbar", name="12 of 12 runs are done")).to_be_visible(timeout=GUARD_MS)
            curve = page.get_by_role("img", name="Success rate after each of 12 runs")
            expect(curve).to_be_visible(timeout=GUARD_MS)
            points = page.get_by_role("listbox", name="Runs by parameters.luck and duration")
            points.press("End")
            points.press("Enter")
            chosen = page.get_by_role("region", name=re.compile(r"^Run \d+$"))
            expect(chosen).to_contain_text("missed")
            require_accessible(page, "a sweep with a chosen run")
            require_unique_names(page, "a sweep with a chosen run")
            page.set_viewport_size({"width": PHONE[0], "height": PHONE[1]})
            require_fit(page, PHONE[0])
            page.reload()
            page.get_by_role("button", name="Open with graph, timeline and 3D").press("Enter")
            expect(page.get_by_text("executed again: the same")).to_be_visible(timeout=GUARD_MS)
            expect(page.get_by_text("read-only")).to_be_visible()
            page.get_by_role("link", name=" of luck").press("Enter")
            expect(chosen).to_contain_text("missed")
