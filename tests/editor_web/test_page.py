"""The page in a real browser: what an operator does, reads and hears."""

from __future__ import annotations

import base64
import re
from collections.abc import Callable, Generator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Locator, Page, expect

from tests.editor_web.accessible_names import require_unique_names
from tests.editor_web.browsing import DESK, Scheme, Size, opened_page, require_accessible, require_fit
from tests.editor_web.fake_behaviors import SINGLE, TRANSFER
from tests.editor_web.limits import GUARD_MS
from tests.editor_web.site import Site
from tests.tiers import nightly

# Longer than any test: what is active stays so.
LASTING_S = 3600.0
BRIGHTEST = """async (png) => {
    const picture = await createImageBitmap(new Blob([Uint8Array.from(atob(png), (each) => each.charCodeAt(0))]))
    const drawn = new OffscreenCanvas(picture.width, picture.height).getContext('2d')
    drawn.drawImage(picture, 0, 0)
    return drawn.getImageData(1, 1, picture.width - 2, picture.height - 2).data.reduce(
        (most, value, at) => (at % 4 === 3 ? most : Math.max(most, value)), 0)
}"""
"""Of a picture, without its rim: the greatest value of a colour."""
Visit = Callable[..., AbstractContextManager[Page]]


@pytest.fixture
def site(tmp_path: Path, loopback: str) -> Generator[Site]:
    """A server without a 3D view: software rendering takes seconds, and has its own test."""
    with Site(host=loopback, folder=tmp_path) as running:
        yield running


@pytest.fixture
def visit(browser: Browser, site: Site) -> Visit:
    """Log in and open an address: `with visit("/") as page`; console errors fail the test."""

    @contextmanager
    def opened(path: str = "/", *, quiet: bool = True, size: Size = DESK, scheme: Scheme = "light") -> Generator[Page]:
        with opened_page(browser, site.running, path, quiet=quiet, size=size, scheme=scheme) as page:
            expect(page.get_by_role("link", name="two_arm_transfer").first).to_be_visible()
            yield page

    return opened


def address(behavior: str) -> str:
    """Path of a behavior's page."""
    return f"/behaviors/{behavior}"


def node(page: Page, path: str) -> Locator:
    """A node of the graph."""
    return page.locator(f".react-flow__node[data-id='{path}'] [data-node]")


def test_an_operator_runs_a_behavior_and_sees_both_arms_at_work(visit: Visit, site: Site) -> None:
    """Log in, pick, fill the form, start, two branches lit at once, stop."""
    site.backend.step_s = LASTING_S
    with visit() as page:
        page.get_by_role("link", name="two_arm_transfer").click()
        page.get_by_label("Speed").fill("0.3")
        page.get_by_role("button", name="Start").click()
        for arm in ("left", "right"):
            expect(node(page, f"root/approach/{arm}")).to_have_attribute("data-status", "active")
        expect(page.locator('[data-node="leaf"][data-status="active"]')).to_have_count(2)
        expect(page.get_by_role("button", name="Start")).to_be_disabled()
        site.call(site.backend.end_step())
        for arm in ("left", "right"):
            expect(node(page, f"root/pick/{arm}/descend")).to_have_attribute("data-status", "active")
        expect(node(page, "root/approach/left")).to_contain_text("reached")
        expect(page.locator("[data-course][data-taken]")).to_have_count(1)
        page.get_by_role("button", name="Stop this run").click()
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Stopped")
        expect(page.get_by_role("log")).to_contain_text("stop requested: stopped in the dashboard")
        expect(page.locator('[data-node="leaf"][data-status="active"]')).to_have_count(0)
    started = site.backend.events("run-001")[0]
    assert getattr(started, "parameters", None) == {
        "speed": 0.3,
        "lift_m": 0.12,
        "cycles": 1,
        "order": "together",
        "verify": True,
    }


def test_a_reload_in_mid_run_shows_what_is_running(visit: Visit, site: Site) -> None:
    """Nodes, times and log come back at once."""
    site.backend.step_s = LASTING_S
    site.call(site.backend.start(TRANSFER.id, parameters={}, seed=1))
    with visit(address(TRANSFER.id)) as page:
        for is_reloaded in (False, True):
            if is_reloaded:
                page.reload()
            expect(page.locator('[data-node="leaf"][data-status="active"]')).to_have_count(2)
            expect(page.get_by_role("status", name="State of the run")).to_have_text("Running")
            expect(page.get_by_role("log")).to_contain_text("run started")


def test_a_restarted_server_is_found_again(visit: Visit, site: Site) -> None:
    """The page says so meanwhile, and goes on by itself."""
    site.backend.step_s = LASTING_S
    with visit(address(TRANSFER.id), quiet=False) as page:
        page.get_by_label("Speed").fill("0.7")
        expect(page.locator("[data-connection]")).to_have_text("Live")
        site.down()
        expect(page.get_by_role("alert")).to_contain_text("The server does not answer")
        site.up()
        expect(page.locator("[data-connection]")).to_have_text("Live")
        expect(page.get_by_role("alert")).to_have_count(0)
        expect(page.get_by_label("Speed")).to_have_value("0.7")
        page.get_by_role("button", name="Start", exact=True).click()
        expect(page.locator('[data-node="leaf"][data-status="active"]')).to_have_count(2)


def test_a_failure_is_marked_and_its_causes_unfold(visit: Visit, site: Site) -> None:
    """From what was measured on."""
    site.backend.step_s = 0.05
    with visit(address(SINGLE.id)) as page:
        page.get_by_label("Part").fill("hca_1")
        page.get_by_role("button", name="Start").click()
        expect(node(page, "root/grasp")).to_have_attribute("data-status", "failed")
        expect(node(page, "root/grasp").locator("[data-exit][data-taken]")).to_have_text("failed")
        expect(page.get_by_role("status", name="State of the run")).to_have_text("Failed")
        page.get_by_role("log").get_by_role("button", name="3 causes").last.click()
        expect(page.get_by_role("list", name="Causes").get_by_role("listitem").first).to_contain_text(
            "no contact on either pad"
        )


def test_the_outline_is_worked_by_keys_and_tells_the_state(visit: Visit, site: Site) -> None:
    """The way in for keyboard and screen reader."""
    site.backend.step_s = LASTING_S
    site.call(site.backend.start(TRANSFER.id, parameters={}, seed=1))
    with visit(address(TRANSFER.id)) as page:
        page.get_by_role("tab", name="Outline").click()
        tree = page.get_by_role("tree", name="Outline of the behavior")
        tree.get_by_role("treeitem").first.focus()
        for key in ("ArrowRight", "ArrowRight", "Enter"):
            page.keyboard.press(key)
        expect(tree.get_by_role("treeitem", selected=True)).to_have_accessible_name("left motion.MoveJoints active")
        expect(page.get_by_label("Path of the selection")).to_have_text("rootapproachleft")
        expect(page.locator("[data-node][data-selected]")).to_contain_text("motion.MoveJoints")
        page.keyboard.press("ArrowLeft")
        page.keyboard.press("ArrowLeft")
        expect(tree.get_by_role("treeitem", name="approach")).to_have_attribute("aria-expanded", "false")


def test_containers_are_collapsed_by_hand_and_by_what_is_active(visit: Visit, site: Site) -> None:
    """One box stands for what is inside: it tells what is active there."""
    site.backend.step_s = LASTING_S
    site.call(site.backend.start(TRANSFER.id, parameters={}, seed=1))
    with visit(address(TRANSFER.id)) as page:
        active = page.locator("[data-node=leaf][data-status=active]")
        expect(active).to_have_count(2)
        page.get_by_role("button", name="Collapse approach").click()
        expect(active).to_have_count(1)
        expect(active).to_contain_text("left, right")
        page.get_by_role("button", name="Expand approach").click()
        expect(active).to_have_count(2)
        page.get_by_role("button", name="Collapse what is not active").click()
        folded = page.get_by_role("button", name=re.compile("^Expand (?!all)"))
        expect(folded).to_have_count(4)
        page.get_by_role("button", name="Expand all").click()
        expect(folded).to_have_count(0)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_every_page_is_accessible(visit: Visit, site: Site, scheme: Scheme) -> None:
    """axe-core finds nothing on any page, idle, running, failed, and while logging in."""
    site.backend.step_s = LASTING_S
    with visit("/", scheme=scheme) as page:
        require_accessible(page, "home without runs")
    site.call(site.backend.start(TRANSFER.id, parameters={}, seed=1))
    with visit("/", scheme=scheme) as page:
        require_accessible(page, "home")
        page.get_by_role("link", name="two_arm_transfer").first.click()
        expect(page.locator('[data-node="leaf"][data-status="active"]')).to_have_count(2)
        require_accessible(page, "running")
        require_unique_names(page, "running")
        page.get_by_role("tab", name="Outline").click()
        page.get_by_role("treeitem").nth(2).click()
        require_accessible(page, "outline")
        page.get_by_role("link", name="palletise").click()
        expect(page.locator("[data-finding]")).to_be_visible()
        expect(page.get_by_role("button", name="Start")).to_be_disabled()
        require_accessible(page, "broken")
        page.set_viewport_size({"width": 390, "height": 844})
        require_accessible(page, "small")
    with visit("/workcell/robots/left/gripper", scheme=scheme) as page:
        tree = page.get_by_role("tree", name="Items of the cell")
        expect(tree.get_by_role("treeitem", selected=True)).to_contain_text("gripper")
        require_accessible(page, "cell")
        require_unique_names(page, "cell")
    # The browser itself reports the refusal.
    with visit("/", scheme=scheme, quiet=False) as page:
        page.goto(f"{site.running.url}login?t=wrong")
        require_accessible(page, "login")


@pytest.mark.parametrize(("width", "height"), [(390, 844), nightly(820, 1180), nightly(1366, 768), (3840, 2160)])
def test_it_fits_every_screen(visit: Visit, width: int, height: int) -> None:
    """Nothing to scroll sideways, the start button in view, the graph drawn large enough to see."""
    with visit(address(TRANSFER.id), size=(width, height)) as page:
        expect(page.get_by_role("button", name="Start")).to_be_in_viewport()
        require_fit(page, width, height)
        if width < 992:
            page.get_by_role("tab", name="Graph").click()
        expect(page.locator('[data-node="leaf"]').first).to_be_visible()


def test_the_cell_is_drawn_in_three_dimensions(visit: Visit, tmp_path: Path, loopback: str, browser: Browser) -> None:
    """Through our own server; viser's own panel is out of sight."""
    folder = tmp_path / "cell"
    folder.mkdir()
    with Site(host=loopback, folder=folder, cell_view=True) as site:
        context = browser.new_context(locale="en-US", viewport={"width": 900, "height": 600})
        page = context.new_page()
        page.goto(site.running.new_login_url())
        cell = page.frame_locator("iframe[title='3D view of the cell']")
        drawn = cell.locator("canvas[data-engine]")
        expect(drawn).to_be_visible(timeout=GUARD_MS)
        expect(drawn).not_to_have_attribute("width", "0")
        panels = cell.locator("[data-testid=floating-panel], .mantine-Paper-root").filter(visible=True)
        expect(panels).to_have_count(0)
        context.close()


def test_the_view_is_dark_in_the_dark_theme_before_it_has_loaded(
    tmp_path: Path, loopback: str, browser: Browser
) -> None:
    """What is seen through a document that says nothing yet, as the loading one does."""
    folder = tmp_path / "cell"
    folder.mkdir()
    with (
        Site(host=loopback, folder=folder, cell_view=True) as site,
        opened_page(browser, site.running, "/teach", scheme="dark") as page,
    ):
        page.context.route("**/cell/**", lambda route: route.fulfill(body="<html></html>", content_type="text/html"))
        page.goto(site.running.url)
        frame = page.get_by_title("3D view of the cell")
        expect(frame).to_be_visible()
        expect(page.frame_locator("[title='3D view of the cell']").locator("body")).to_be_attached()
        brightest: int = page.evaluate(BRIGHTEST, base64.b64encode(frame.screenshot()).decode())
    assert brightest < 64
